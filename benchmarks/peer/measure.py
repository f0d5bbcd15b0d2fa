"""The contact temperature of one touch beside what a peer simulates: Genesis World's TemperatureGrid sensor.

The peer's figures were measured by this project with Genesis World 1.4.5 (8 x 8 x 1 grid, dt 10 ms, float32) and are
quoted, not measured again: how far the temperature of its touched cells was from the exact contact temperature. Its
cells are 10 mm deep, so their mean is set against a surface; the fair figures are those of a 1 x 1 x 10 grid, the mean
over the first millimetre. Ours is thermal.press with the fingertip as a SensorStack of one layer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import quad
from scipy.special import erfc

from thermograsp import thermal
from thermograsp.thermal import Layer, Material, SensorStack

PUBLISHED_BY = (
    "this project, measured with Genesis World 1.4.5 (TemperatureGrid, 8 x 8 x 1, dt 10 ms, float32)"
)
TIMES = (0.1, 1.0, 5.0)
TIP = SensorStack("tip", (Layer("tip", 0.010, 0.37, 1100.0, 3500.0),), 0.016, 0, 1e-3)
WARM, COLD = 36.0, 24.0
PERFECT = 1e6
"""W/(m2 K), for a contact without resistance, which the peer has: it holds back less than .02 K from 0.1 s on."""
WOOD_EFFUSIVITY = 449.0
"""W s^0.5/(m2 K), of the peer's wood; the other plates are those of thermal.materials()."""
PEER = {
    "wood": (2.96, 0.49, -4.75),
    "plastic": (3.55, 0.92, -4.44),
    "glass": (5.84, 1.08, -4.11),
    "stainless_steel": (9.47, 3.74, -0.70),
    "aluminium": (10.43, 4.63, 0.25),
}
"""K above the exact contact temperature at TIMES."""
PEER_FIRST_MILLIMETRE = {"wood": 35.31, "glass": 34.46, "aluminium": 33.95}
"""degC at 5 s on a 1 x 1 x 10 grid."""
PEER_HEAT = {"aluminium": 10e3}
"""J/m2 lost by the tip in 5 s on that grid."""


@dataclass(frozen=True, slots=True)
class Touch:
    """One plate. Temperatures in degC, at TIMES where there are three. exact: two half-spaces. column: ours, a plate of
    the tip's section 0.5 m deep, to be compared with exact. slab: ours, 40 x 40 x 10 mm. soft: the same with a contact
    of 1e4 W/(m2 K). peer: quoted. first_millimetre: exact mean at 5 s. heat: J/m2 lost by the tip in 5 s, exact and
    ours (column)."""

    plate: str
    exact: float
    column: tuple[float, ...]
    slab: tuple[float, ...]
    soft: tuple[float, ...]
    peer: tuple[float, ...]
    first_millimetre: float
    heat: tuple[float, float]


def touches() -> list[Touch]:
    """All plates of the peer's table."""
    return [_touch(name) for name in PEER]


def plate_material(name: str) -> Material:
    """The plate's material; wood with the peer's effusivity."""
    chosen = thermal.material(name)
    if name != "wood":
        return chosen
    return replace(chosen, specific_heat=WOOD_EFFUSIVITY**2 / (chosen.conductivity * chosen.density))


def _touch(name: str) -> Touch:
    material, tip = plate_material(name), TIP.layers[0]
    tip_effusivity = float(np.sqrt(tip.conductivity * tip.volumetric_heat_capacity))
    exact = (tip_effusivity * WARM + material.effusivity * COLD) / (tip_effusivity + material.effusivity)
    end = TIMES[-1]
    diffusivity = tip.conductivity / tip.volumetric_heat_capacity
    mean = quad(lambda x: erfc(x / (2 * np.sqrt(diffusivity * end))), 0, 1e-3)[0] / 1e-3
    lost = 2 * tip_effusivity * (WARM - exact) * np.sqrt(end / np.pi)
    column, heat = _surface(material, PERFECT, (TIP.width, TIP.width, 0.5))
    return Touch(
        plate=name,
        exact=exact,
        column=column,
        slab=_surface(material, PERFECT, (0.04, 0.04, 0.01))[0],
        soft=_surface(material, 1e4, (0.04, 0.04, 0.01))[0],
        peer=tuple(exact + off for off in PEER[name]),
        first_millimetre=WARM - (WARM - exact) * float(mean),
        heat=(float(lost), heat),
    )


def _surface(
    material: Material, conductance: float, size: tuple[float, float, float]
) -> tuple[tuple[float, ...], float]:
    """Mean temperature degC of the tip's face at TIMES, and the J/m2 that the tip has lost at the last of them."""
    press = thermal.press(
        material,
        sensor=TIP,
        conductance=conductance,
        area=TIP.face_area,
        object_size=size,
        sensor_temperature=WARM,
        object_temperature=COLD,
        seconds=TIMES[-1],
        dt=TIMES[0],
        rung="semi_analytic",
    )
    at = [round(time / TIMES[0]) for time in TIMES]
    lost = -float(press.stored_heat[at[-1], 0]) / TIP.face_area
    # heat that the thermostat gave back through 10 mm in 5 s is below 1e-6 of it
    return tuple(float(press.sensor_surface[i]) for i in at), lost
