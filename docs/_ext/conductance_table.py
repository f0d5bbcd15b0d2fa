"""The conductance of every material's contact with the sensor's face, as a table, from the contact law."""

from __future__ import annotations

from thermograsp.thermal import (
    LAPPED_ALUMINA,
    SKINS,
    Joint,
    Pad,
    Surface,
    contact_conductance,
    joint,
    materials,
)
from thermograsp.thermal.contact import covered_share

FORCES = (1.0, 10.0, 30.0)
"""N on the whole pad."""

FLATNESS = 10e-6  # m
SKIN = SKINS["filled_silicone"]
_PLASTIC_MOST, _ELASTIC_MOST = (
    0.02275,
    0.01137,
)  # shares of the face covered where the mean planes are 2 sigma apart


def conductance_table() -> str:
    """A row for each material, in the table's order."""
    columns = ["material", *(f"{force:g} N" for force in FORCES), "law holds to", "full contact from"]
    columns += ["10 N, at most full contact", "10 N, flat to 10 µm", "10 N, with a skin"]
    head = f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}\n"
    return head + "".join(_row(name) for name in materials())


def _row(name: str) -> str:
    face, area = Surface.of(materials()[name]), Pad().width ** 2
    plain = joint(LAPPED_ALUMINA, face)
    spots = float(covered_share(plain, 1.0)) / area  # per N
    known, full = _range(plain) / spots, 1 / spots
    conductances = [_conductance(plain, force / area) for force in FORCES]
    beyond = full < FORCES[-1]
    capped = _conductance(joint(LAPPED_ALUMINA, face, full_contact=True), 10 / area) if beyond else ""
    crowned = _conductance(joint(LAPPED_ALUMINA, face, flatness=FLATNESS), 10 / area)
    worn = joint(Surface.of(SKIN.made_of), face, full_contact=True)
    through = 1 / (SKIN.resistance + 1 / float(contact_conductance(worn, 10 / area)))
    ends = [_newton(known) if known < FORCES[-1] else "", _newton(full) if beyond else ""]
    return (
        "| "
        + " | ".join([name.replace("_", " "), *conductances, *ends, capped, crowned, _digits(through)])
        + " |\n"
    )


def _range(pair: Joint) -> float:
    """Share of the face up to which the law was fitted."""
    return _PLASTIC_MOST ** (1 - pair.elastic_share) * _ELASTIC_MOST**pair.elastic_share


def _conductance(pair: Joint, pressure: float) -> str:
    """W/(m2 K)."""
    return _digits(float(contact_conductance(pair, pressure)))


def _digits(value: float) -> str:
    """Three of them."""
    return f"{float(f'{value:.3g}'):.0f}"


def _newton(force: float) -> str:
    return f"{float(f'{force:.2g}'):g} N"
