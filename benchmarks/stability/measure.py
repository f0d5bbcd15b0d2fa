"""Where time steps of a contact fail: maps over the step (Fourier number) and the contact's stiffness.

Each scheme of bars.py runs for STEPS steps from the touch, and as many with a contact that bounces. What it does is
FINE, RINGS (the gap between the faces grows again or turns around, which heat cannot do), WRONG (some temperature
leaves the range of the initial ones by more than TOLERANCE, or, for a closed form, is off by more than that) or BLOWN
(ten times the range, or not a number).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from thermograsp.bench.stability import bars
from thermograsp.thermal.rungs import drop_t_mode

FINE, RINGS, WRONG, BLOWN = range(4)
NAMES = ("stable, in range", "rings", "leaves the range", "blows up")
TOLERANCE = 1e-3  # of the initial difference: .012 K of 12 K
STEPS = 400
FOURIER = (1e-2, 1e3)
BETA = (1e-3, 1e4)
TERMS = 10  # of the truncated series
SERIES_FOURIER = (1e-2, 1e4)
CONTRAST = (1e-4, 1.0)


@dataclass(frozen=True, slots=True)
class Line:
    """A theoretical limit y(x). name: what it is, written at the point `label`."""

    name: str
    x: np.ndarray
    y: np.ndarray
    label: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Map:
    """One scheme's map. x, y: ordinates of the pixels, (X,) and (Y,); kinds (Y, X) of FINE .. BLOWN. outside (Y, X):
    how far the range was left, over the initial difference. heat (Y, X): gained from nowhere, over the first bar's.
    note: why, in a few words. axes: names of x and y."""

    key: str
    title: str
    note: str
    x: np.ndarray
    y: np.ndarray
    kinds: np.ndarray
    outside: np.ndarray
    heat: np.ndarray
    lines: tuple[Line, ...]
    axes: tuple[str, str]

    def share(self, kind: int) -> float:
        """Share of the map that is of that kind."""
        return float(np.mean(self.kinds == kind))


def contact_rate(beta: np.ndarray) -> np.ndarray:
    """Largest rate of the conduction operator of two long bars, over diffusivity/dx^2.

    The mode that dies out away from the contact as (-r)^j has 1 + 1/r = PULL beta and rate 2 + r + 1/r, r <= 1; where
    the contact is too soft for it (PULL beta <= 2) the shortest wave of a bar has 4."""
    inside = np.maximum(bars.PULL * beta, 2.0) - 1
    return 2 + inside + 1 / inside


def classify(
    scheme: bars.Scheme, fourier: np.ndarray, beta: np.ndarray, bouncing: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Kinds, excursions and heat gained from nowhere (over the first bar's) (P,) at pairs fourier, beta (P,).

    The bars touch and stay together, which shows ringing, and once more as bouncing (steps, P) says."""
    rows = len(fourier)
    u = bars.first_temperatures(rows)
    grown, outside, heat = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    with np.errstate(all="ignore"):
        for closed in (np.ones_like(bouncing), bouncing):
            gap = np.ones(rows)
            for u in scheme(fourier, beta, closed):
                out = np.maximum(np.max(u, axis=1) - 1, -np.min(u, axis=1))
                outside = np.fmax(outside, np.where(np.isfinite(out), out, np.inf))
                if closed is bouncing:
                    continue
                now = u[:, bars.FIRST] - u[:, bars.SECOND]
                # a gap that has turned around, or grows again
                grown = np.fmax(grown, np.maximum(-now, np.abs(now) - gap))
                gap = np.abs(now)
            heat = np.fmax(heat, np.abs(u @ bars.WEIGHTS / bars.CELLS - 1))
    kinds = np.full(rows, FINE)
    kinds[grown > TOLERANCE] = RINGS
    kinds[outside > TOLERANCE] = WRONG
    kinds[~(outside < 10)] = BLOWN
    return kinds, outside, heat


def atlas(pixels: int, steps: int, seed: int, shown: Callable[[str], None]) -> list[Map]:
    """All maps, with so many pixels across. shown: called with what is being done."""
    x = np.geomspace(*FOURIER, pixels)
    y = np.geomspace(*BETA, max(3 * pixels // 4, 4))
    fourier, beta = (grid.ravel() for grid in np.meshgrid(x, y))
    bouncing = np.random.default_rng(seed).integers(0, 2, (steps, len(beta))).astype(bool)
    axes = ("Fourier number of a step, α dt/dx²", "stiffness of the contact, h dx/k")
    maps = []
    for key, title, note, scheme, lines in schemes():
        shown(title)
        kinds, outside, heat = classify(scheme, fourier, beta, bouncing)
        shape = (len(y), len(x))
        fields = (kinds.reshape(shape), outside.reshape(shape), heat.reshape(shape))
        maps.append(Map(key, title, note, x, y, *fields, lines, axes))
    shown("series")
    maps.insert(-3, series_map(pixels))
    return maps


def schemes() -> list[tuple[str, str, str, bars.Scheme, tuple[Line, ...]]]:
    """(key, title, note, scheme, theoretical limits)."""
    y, x = np.geomspace(*BETA, 400), np.geomspace(*FOURIER, 400)
    rate = contact_rate(y)
    lagged = bars.surface_admittance(2 / x)
    neumann = lagged / (1 / bars.LIGHT - 1)
    return [
        (
            "ftcs",
            "Explicit Euler (FTCS)",
            "stable below F = 1/2, and less\nwhere the contact is stiff",
            bars.ftcs,
            (
                Line("λF = 2", 2 / rate, y, (0.014, 0.2)),
                Line("F = 1/2", np.full(2, 0.5), np.array(BETA), (0.055, 2.2e-3)),
            ),
        ),
        (
            "crank_nicolson",
            "Crank-Nicolson",
            "never blows up, but stiff modes\nchange sign each step",
            bars.crank_nicolson,
            (Line("λF = 2", 2 / rate, y, (0.014, 0.2)),),
        ),
        (
            "sdirk2",
            "SDIRK2, L-stable, 2nd order",
            "its stability function\ngoes down to -0.207",
            bars.sdirk2,
            (Line("λF = 2.41", (1 + np.sqrt(2)) / rate, y, (0.014, 0.2)),),
        ),
        (
            "first_order_hold",
            "Flux linear over a step",
            "a trapezoidal rule in disguise:\nthe flux turns around",
            bars.first_order_hold,
            (Line("11βw = 1", x, bars.hold_limit(x), (0.014, 0.12)),),
        ),
        (
            "lagged_flux",
            "Staggered, last flux",
            "each body is implicit,\nthe contact is not",
            bars.lagged_flux,
            (Line("11β = Y", x, lagged / bars.PULL, (0.014, 0.12)),),
        ),
        (
            "dirichlet_neumann",
            "Staggered, Dirichlet-Neumann",
            "the sensor sees the object\nas it was a step ago",
            bars.dirichlet_neumann,
            (Line("9β = Y", x, neumann, (0.014, 0.12)),),
        ),
        (
            "backward_euler",
            "Backward Euler",
            "safe at any step,\nbut of first order",
            bars.backward_euler,
            (),
        ),
        (
            "ours_float32",
            "thermograsp in single precision",
            "float32: as safe, heat kept\nto single precision",
            partial(bars.package_step, single=True),
            (),
        ),
        (
            "ours",
            "thermograsp",
            "any step, any stiffness, within\n3e-6 of exact between changes",
            bars.package_step,
            (),
        ),
    ]


def series_map(pixels: int) -> Map:
    """The T-mode series of the closed form cut after TERMS terms, against its sum, over time and effusivity.

    gamma -> -1 is an object that conducts far better than the sensor. The terms cancel in pairs until their erfc
    reaches 1; then (1 - gamma)/2 |gamma|^n of each is lost."""
    from scipy.special import erfc

    x = np.geomspace(*SERIES_FOURIER, pixels)
    y = np.geomspace(*CONTRAST, max(3 * pixels // 4, 4))
    n = np.arange(TERMS)
    terms = erfc(n / np.sqrt(x)[:, None]) - erfc((n + 1) / np.sqrt(x)[:, None])
    errors = np.zeros((len(y), len(x)))
    for i, contrast in enumerate(y):
        gamma = -(1 - contrast)
        cut = (1 - gamma) / 2 * np.sum((-gamma) ** n * terms, axis=1)
        errors[i] = np.abs(cut - drop_t_mode(x, gamma))
    kinds = np.where(errors > TOLERANCE, WRONG, FINE)
    # the first term left out, at its largest: erfc(N/sqrt F) = tolerance where |gamma| is near 1
    fine = np.geomspace(*SERIES_FOURIER, 400)
    tail = erfc(TERMS / np.sqrt(fine))
    lost = tail > TOLERANCE
    least = 1 - (TOLERANCE / tail[lost]) ** (1 / TERMS)
    fine, least = fine[lost], np.append(CONTRAST[0], least[1:])  # from the edge of the map
    return Map(
        "series",
        f"Series of the paper, {TERMS} terms",
        "eq. (2): a good conductor and a\nlong touch take more of them",
        x,
        y,
        kinds,
        errors,
        np.zeros_like(errors),
        (Line(r"$|\gamma|^N$ erfc$(N/\sqrt{F})$" "\n= tolerance", fine, least, (0.013, 1.5e-3)),),
        ("Fourier number of the time, α t/L²", "1 - |γ|, object better than sensor"),
    )
