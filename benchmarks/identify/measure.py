"""`thermograsp bench identify`: the identifier, the Bayes limit and learned classifiers on the same touches."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from thermograsp import thermal
from thermograsp.bench.identify.bayes_limit import exact_posterior
from thermograsp.bench.identify.rivals import recurrent_net, support_vectors
from thermograsp.bench.identify.touches import (
    SETUP,
    WINDOWS,
    Identified,
    Touches,
    draw,
    draw_objects,
    identify_all,
    pressed,
)
from thermograsp.errors import MissingDependencyError

ELEVEN = (
    "expanded_polystyrene",
    "cotton",
    "cardboard",
    "pine",
    "neoprene",
    "plastic",
    "glass",
    "ceramic",
    "stainless_steel",
    "aluminium",
    "copper",
)
"""Eleven everyday materials from foam to copper, beside the published result with eleven."""
ELEVEN_WINDOWS = (0.5, 1.5)
PUBLISHED = {0.5: 0.84, 1.5: 0.98}
"""SVM + PCA, 11 materials, varying initial conditions, a heated thermistor: Bhattacharjee T., Wade J. & Kemp C. C.,
Material Recognition from Heat Transfer given Varying Initial Conditions and Short-Duration Contact, RSS 2015."""

STEADY = replace(SETUP, conductance=(8e3, 1.25e4))
"""The same with contacts that repeat within 25 %: one finger, one force, flat samples, as on a test bench."""

Doing = Callable[[str], None]
"""Is called with what begins, as often as stages() says."""


def stages(windows: tuple[float, ...], net: bool = True) -> int:
    """How many `compare` has: curves, the contact times, support vectors, the net."""
    return 2 + len(windows) + net


@dataclass(frozen=True, slots=True)
class Accuracies:
    """Share of N touches whose material each method names, by contact time (W,); a method whose package is missing is
    left out. truth: (N,). found: by contact time, the identifier's answers. limit: by contact time (N, M)."""

    windows: tuple[float, ...]
    materials: tuple[str, ...]
    truth: np.ndarray
    found: dict[float, Identified]
    limit: dict[float, np.ndarray]
    share: dict[str, list[float]]

    def confusion(self, window: float) -> np.ndarray:
        """(M, M) share of the touches of each material (row) that were named each material (column)."""
        count = len(self.materials)
        named = self.found[window].probability.argmax(axis=1)
        table = np.zeros((count, count))
        np.add.at(table, (self.truth, named), 1.0)
        return table / table.sum(axis=1, keepdims=True)


@dataclass(frozen=True, slots=True)
class Coverage:
    """What intervals cover at one contact time: the share of fresh objects inside their 90 % interval, and the
    interval's width as a ratio of its ends: quantiles 10, 50, 90 %."""

    window: float
    held: float
    ratio: tuple[float, ...]


def compare(
    rng: np.random.Generator,
    setup: thermal.TouchSetup,
    materials: tuple[str, ...],
    windows: tuple[float, ...],
    tests: int,
    examples: int,
    doing: Doing,
    net: bool = True,
) -> tuple[Accuracies, list[str]]:
    """All methods on the same touches, and which packages were missing. examples: touches to learn from."""
    doing("curves")
    curves = np.array([pressed(setup, name) for name in materials])
    test, train = (draw(rng, setup, count, materials, curves) for count in (tests, examples))
    found, limit = {}, {}
    for window in windows:
        doing(f"identifying after {window:g} s")
        found[window] = identify_all(test, window, materials)
        limit[window] = exact_posterior(test, window, curves)
    share = {
        "limit": [_right(test, limit[window].argmax(axis=1)) for window in windows],
        "identify": [_right(test, found[window].probability.argmax(axis=1)) for window in windows],
    }
    missing: list[str] = []
    doing("support vectors")
    try:
        share["svm"] = [_right(test, support_vectors(train, test, window)) for window in windows]
    except MissingDependencyError as error:
        missing.append(str(error))
    if net:
        doing("recurrent net")
        try:
            named = recurrent_net(train, test, windows, len(materials), int(rng.integers(2**31)))
            share["net"] = [_right(test, named[window]) for window in windows]
        except MissingDependencyError as error:
            missing.append(str(error))
    return Accuracies(windows, materials, test.label, found, limit, share), missing


COVER_STAGES = 1 + len(WINDOWS)


def cover(rng: np.random.Generator, count: int, doing: Doing) -> list[Coverage]:
    """Fresh objects of any effusivity, and how often their intervals hold them."""
    doing("fresh objects")
    drawn = draw_objects(rng, SETUP, count)
    result = []
    for window in WINDOWS:
        doing(f"intervals after {window:g} s")
        low, high = identify_all(drawn, window, thermal.SEED_MATERIALS).interval.T
        held = float(np.mean((low <= drawn.effusivity) & (drawn.effusivity <= high)))
        result.append(Coverage(window, held, tuple(np.quantile(high / low, (0.1, 0.5, 0.9)).tolist())))
    return result


def _right(touches: Touches, named: np.ndarray) -> float:
    return float(np.mean(named == touches.label))
