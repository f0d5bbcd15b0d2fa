"""The paper's formulas and the statements that come with them (sections 1 to 3.1), each computed."""

from __future__ import annotations

import numpy as np
from scipy import special

from thermograsp import thermal
from thermograsp.reports.paper.claim import Finding, graded
from thermograsp.reports.paper.measures import sensor_effusivity
from thermograsp.reports.paper.runs import PaperRuns
from thermograsp.reports.paper.sweeps import (
    MATERIALS,
    MODES,
    SENSOR_TEMPERATURE,
    SMOOTH,
)
from thermograsp.thermal.numerics import invert
from thermograsp.thermal.rungs import drop_o_mode

_GAMMAS = (-0.9, -0.3, 0.5, 0.95)
_FOURIER = np.array([0.03, 0.2, 1.0, 4.0])
_TERMS = np.arange(60)
_FIRST = 0.1  # s, "at the first moment"; heat takes 2 s to cross the element


def printed_equation_1(fourier: np.ndarray, gamma: float) -> np.ndarray:
    """Drop per kelvin as eq. (1) is printed, at alpha t / L^2 (n,). No solution; here to be shown wrong."""
    series = np.sum((-gamma) ** _TERMS * special.erfc((_TERMS + 0.5) / np.sqrt(fourier[:, None])), axis=-1)
    return 1 - ((1 - gamma) * special.erfc(-0.5 / np.sqrt(fourier)) + gamma * (1 + gamma) * series)


def printed_equation_2(fourier: np.ndarray, gamma: float) -> np.ndarray:
    """Drop per kelvin as eq. (2) is printed, with a true erfc, at alpha t / L^2 (n,)."""
    root = np.sqrt(fourier[:, None])
    return (
        (1 - gamma)
        / 2
        * np.sum(
            (-gamma) ** _TERMS * (special.erfc(_TERMS / root) - special.erfc((_TERMS + 1) / root)), axis=-1
        )
    )


def exact_drop(mode: str, fourier: np.ndarray, gamma: float) -> np.ndarray:
    """Drop per kelvin over one layer on a half-space, from the heat equation by numerical Laplace inversion."""
    ratio = (1 - gamma) / (1 + gamma)

    def transform(s: np.ndarray) -> np.ndarray:
        q = np.sqrt(s)
        if mode == "T":
            return np.tanh(q) / (np.tanh(q) + 1 / ratio) / s
        return (1 - 1 / (np.cosh(q) + ratio * np.sinh(q))) / s

    return invert(transform, fourier)


def equation_2(_: PaperRuns) -> Finding:
    worst = max(
        float(np.max(np.abs(printed_equation_2(_FOURIER, g) - exact_drop("T", _FOURIER, g)))) for g in _GAMMAS
    )
    return Finding(
        "It solves the heat equation: against the inverted Laplace transform at gamma -0.9 to 0.95 and alpha t/L2 "
        f"0.03 to 4 it is off by at most {worst:.1e} of the first difference.",
        graded(worst < 1e-9),
        {"largest_error": worst},
    )


def equation_1(_: PaperRuns) -> Finding:
    printed = max(
        float(np.max(np.abs(printed_equation_1(_FOURIER, g) - exact_drop("O", _FOURIER, g)))) for g in _GAMMAS
    )
    solution = max(
        float(np.max(np.abs(drop_o_mode(_FOURIER, g) - exact_drop("O", _FOURIER, g)))) for g in _GAMMAS
    )
    start = float(printed_equation_1(np.array([1e-9]), -0.9)[0])
    return Finding(
        f"It is no solution: at the touch it gives 1 - 2 (1 - gamma), for gamma -0.9 {start:.2f}, where the drop "
        f"must be the whole difference, and later it is off by up to {printed:.2f} of it. The solution is T_d = dT "
        f"(1 - (1 + gamma) sum (-gamma)^n erfc((2n + 1) L/(2 sqrt(alpha t)))), off by {solution:.1e}.",
        graded(printed < 1e-9),
        {"printed_error": printed, "right_error": solution, "printed_at_touch": start},
    )


def erfc(_: PaperRuns) -> Finding:
    """With the printed factor erfc(oo) is not 0, so the n-th term of no series would vanish early."""
    far = 1 - 2 / np.pi * np.sqrt(np.pi) / 2
    return Finding(
        f"Misprint: that tends to {far:.3f} instead of 0 for large u; the factor is 2/sqrt(pi).",
        "fails",
        {"printed_far_out": float(far)},
    )


def large_voltage(runs: PaperRuns) -> Finding:
    seebeck = thermal.sensor("seed").seebeck
    peaks = seebeck * runs.smooth["T"].drop.max(axis=1)
    steps = seebeck / thermal.ADS1115.resolution
    return Finding(
        f"Peaks of {peaks.min() * 1e3:.2f} mV (cotton) to {peaks.max() * 1e3:.1f} mV (aluminium) in T mode; 1 K is "
        f"{steps:.0f} steps of a common 16-bit converter, without an amplifier.",
        graded(steps > 10),
        {"peak_voltages_V": peaks.tolist(), "converter_steps_per_K": float(steps)},
    )


def first_flux_o(_: PaperRuns) -> Finding:
    return _first_flux("O", "element", "the objects have got", "largest_share_into_object")


def first_flux_t(_: PaperRuns) -> Finding:
    return _first_flux("T", "object", "the thermostat has given", "largest_share_from_thermostat")


def _first_flux(mode: thermal.Mode, touched: str, beyond: str, number: str) -> Finding:
    """touched: what the flux goes into. beyond: what has changed at the element's other end. number: its name."""
    shares, falling = zip(*(_first_heat(name, mode) for name in MATERIALS), strict=True)
    worst = max(shares)
    return Finding(
        f"The flux into the {touched} falls from the first moment on for {sum(falling)} of 10 materials; of the heat "
        f"of the first {_FIRST:g} s {beyond} at most {worst:.1e}.",
        graded(all(falling) and worst < 1e-3),
        {number: worst},
    )


def _first_heat(name: str, mode: thermal.Mode) -> tuple[float, bool]:
    """Heat of the first moments at the element's other end over that through the contact, and whether the flux through
    the contact only falls. One-dimensional: heat has had no time to spread."""
    press = thermal.press(name, mode=mode, conductance=SMOOTH, seconds=1.0, dt=_FIRST / 5, rung="layered")
    element, body = press.stored_heat[5]
    both = element + body  # T: what the thermostat gave; O: what came through the contact
    share = both / body if mode == "T" else body / both
    return abs(float(share)), bool((np.diff(press.heat_flow) <= 0).all())


def top_face_o(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["O"]
    dt_kelvin = SENSOR_TEMPERATURE - sweep.object_surface[:, 0]
    rise = (sweep.object_surface - sweep.object_surface[:, :1]) / dt_kelvin[:, None]
    half = [float(sweep.t[np.argmax(row >= 0.5)]) for row in rise]
    late = float(rise[:, np.searchsorted(sweep.t, 1.0)].min())
    return Finding(
        f"With a contact of {SMOOTH:g} W/(m2 K) half of the difference is made up within {max(half):.2f} s and at "
        f"least {100 * late:.0f} % within 1 s.",
        graded(late > 0.75),
        {"slowest_half_s": max(half), "least_share_at_1_s": late},
    )


def bottom_face_t(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["T"]
    at = int(np.searchsorted(sweep.t, 1.0))
    above = sweep.sensor_surface[:, at] - 24.0
    element = sensor_effusivity()
    return Finding(
        f"Only against good conductors. After 1 s it is {above[-1]:.1f} K above the object's first temperature for "
        f"aluminium, but {above[4]:.1f} K for glass and {above[0]:.1f} of 12 K for cotton: two bodies meet at a "
        f"mean of their temperatures weighted by effusivity (element: {element:.0f} W s^0.5/(m2 K)), not at the "
        "object's.",
        graded(above.max() < 3, above.min() < 3),
        {"above_object_K": above.tolist(), "element_effusivity": element},
    )


def field_moves(runs: PaperRuns) -> Finding:
    shares = {mode: np.array([s.share_in_object for s in runs.sections[mode]]) for mode in MODES}
    elements = {mode: np.array([s.share_in_element for s in runs.sections[mode]]) for mode in MODES}
    falls = all((np.diff(shares[mode]) < 0).all() and (np.diff(elements[mode]) > 0).all() for mode in MODES)
    o, t = shares["O"], shares["T"]
    return Finding(
        f"In the object lie, T mode, {100 * t[-1]:.0f} % of the 12 K for aluminium, {100 * t[4]:.0f} % for glass, "
        f"{100 * t[0]:.0f} % for cotton; O mode {100 * o[-1]:.0f}, {100 * o[4]:.0f} and {100 * o[0]:.0f} %. The "
        f"order of the ten is {'kept' if falls else 'not kept'} in both modes.",
        graded(falls),
        {f"share_in_object_{mode}": shares[mode].tolist() for mode in MODES}
        | {f"share_in_element_{mode}": elements[mode].tolist() for mode in MODES},
    )


def penetration(runs: PaperRuns) -> Finding:
    rises = np.array([s.back_rise for s in runs.sections["T"]])
    reached = [name for name, rise in zip(MATERIALS, rises, strict=True) if rise > 0.01]
    front = runs.sections["T"][-1].share_in_object * 12
    return Finding(
        f"At 4 s the middle of the far face has warmed by {rises[-1]:.2f} K for aluminium (the touched face by "
        f"{front:.2f} K), {rises[-2]:.2f} K for iron, {rises[-3]:.2f} K for stainless steel; above 0.01 K: "
        f"{', '.join(reached).replace('_', ' ')}. For the others it holds.",
        graded(not reached, len(reached) < 6),
        {"back_rise_K": rises.tolist()},
    )


FINDINGS = (
    equation_2,
    equation_1,
    erfc,
    large_voltage,
    first_flux_o,
    first_flux_t,
    top_face_o,
    bottom_face_t,
    field_moves,
    penetration,
)
"""One for each statement, named by its key."""
