"""A heated stack's properties from recorded touches, by least squares, with intervals from drawing runs again.

Residuals are the drops of every touch, and those of each label's mean curve with a weight of their own: touches differ
by what no record says (how the pad settled), and that leaves the mean alone. Intervals: runs are drawn again with
replacement, and the linearised problem is solved for each draw (one Gauss-Newton step).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from thermograsp.errors import InvalidValueError, SimulationError

from ..stack import HeatedStack
from .predicting import Touched, predict
from .recordings import Recordings, drops_of

_EVERY = 6  # samples: neighbours say the same
_SCALE = 0.1  # K, of a touch's drop
_MEAN_WEIGHT = 3.0
_DRAWS = 2000
_STEP = 1e-3  # of a logarithm, for differences
_CONTACT = ("conductance", "preload", "exponent", "gap")


@dataclass(frozen=True, slots=True)
class Free:
    """A property to fit: "contact.NAME", "backing.capacity", or "LAYER.resistance" (m2 K/W) or "LAYER.capacity"
    (J/(m2 K)) of a layer; its limits."""

    name: str
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Fitted:
    """value, and the 95 % interval of drawing runs again. at_limit: whether it ended at one of its limits."""

    value: float
    low: float
    high: float
    at_limit: bool


@dataclass(frozen=True, slots=True)
class StackFit:
    """A stack fitted to recorded touches. stack: with the fitted properties. values: by name."""

    stack: HeatedStack
    values: Mapping[str, Fitted]


def value_of(stack: HeatedStack, name: str) -> float:
    """A property by the names of Free."""
    where, _, what = name.rpartition(".")
    if where == "contact" and what in _CONTACT:
        return getattr(stack.contact, what)
    if where == "backing" and what == "capacity":
        return stack.backing.capacity
    layer = stack.layers[_layer(stack, where)]
    if what == "resistance":
        return layer.thickness / layer.conductivity
    if what == "capacity":
        return layer.thickness * layer.volumetric_heat_capacity
    raise InvalidValueError(f"a layer has a resistance and a capacity, not {what!r}")


def with_value(stack: HeatedStack, name: str, value: float) -> HeatedStack:
    """The stack with that property; a layer keeps its thickness and density."""
    where, _, what = name.rpartition(".")
    if where == "contact":
        return replace(stack, contact=replace(stack.contact, **{what: value}))
    if where == "backing":
        return replace(stack, backing=replace(stack.backing, **{what: value}))
    index = _layer(stack, where)
    layers = list(stack.layers)
    layer = layers[index]
    if what == "resistance":
        layers[index] = replace(layer, conductivity=layer.thickness / value)
    else:
        layers[index] = replace(layer, specific_heat=value / layer.thickness / layer.density)
    return replace(stack, layers=tuple(layers))


def fit_stack(
    recordings: Recordings,
    start: HeatedStack,
    touched: Mapping[str, Touched],
    free: Sequence[Free],
    rng: np.random.Generator,
) -> StackFit:
    """Fits `free` on all touches of the recordings, from `start`. Raises InvalidValueError for names and limits that
    make no sense, SimulationError where no optimum is found."""
    for one in free:
        if not 0 < one.low < one.high:
            raise InvalidValueError(
                f"{one.name}: limits must be 0 < low < high, got {one.low!r}, {one.high!r}"
            )
    low, high = (np.log([getattr(one, side) for one in free]) for side in ("low", "high"))
    first = np.clip(np.log([max(value_of(start, one.name), one.low) for one in free]), low, high)

    def with_all(x: np.ndarray) -> HeatedStack:
        stack = start
        for one, value in zip(free, np.exp(x), strict=True):
            stack = with_value(stack, one.name, float(value))
        return stack

    def errors(x: np.ndarray) -> np.ndarray:
        curves = predict(recordings, with_all(x), touched).curves
        return (recordings.drops - drops_of(recordings, curves))[:, ::_EVERY] / _SCALE

    weigh = _weigher(recordings)
    inside = np.clip(first, low + 1e-6, high - 1e-6)
    found = least_squares(
        lambda x: weigh(errors(x), recordings.run),
        inside,
        bounds=(low, high),
        x_scale="jac",
        diff_step=_STEP,
        max_nfev=60,
    )
    if not found.success:
        raise SimulationError(f"no optimum within 60 evaluations: {found.message}")
    x = found.x
    at_limit = (x - low < 1e-3) | (high - x < 1e-3)
    drawn = _draws(recordings, errors, x, np.flatnonzero(~at_limit), weigh, rng)
    drawn = np.clip(drawn, low, high)
    ends = np.quantile(drawn, (0.025, 0.975), axis=0)
    best, (lowest, highest) = np.exp(x), np.exp(ends)
    values = {
        one.name: Fitted(float(best[i]), float(lowest[i]), float(highest[i]), bool(at_limit[i]))
        for i, one in enumerate(free)
    }
    return StackFit(with_all(x), values)


def _weigher(recordings: Recordings) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Residuals of touches (B, q) of runs (B,), each run as often as it is drawn, and of their means by label."""

    def weigh(errors: np.ndarray, drawn: np.ndarray) -> np.ndarray:
        rows, means = [], []
        counts = {int(r): int(np.sum(drawn == r)) for r in np.unique(drawn)}
        recorded = {int(r): int(np.sum(recordings.run == r)) for r in np.unique(recordings.run)}
        share = np.array([counts.get(int(r), 0) / recorded[int(r)] for r in recordings.run])
        for label in recordings.labels:
            chosen = recordings.label == label
            weights = share[chosen]
            rows.append((np.sqrt(weights)[:, None] * errors[chosen]).ravel())
            total = weights.sum()
            if total:
                means.append(_MEAN_WEIGHT * np.sqrt(total) * (weights @ errors[chosen] / total))
        return np.concatenate((*rows, *means))

    return weigh


def _draws(
    recordings: Recordings,
    errors: Callable[[np.ndarray], np.ndarray],
    x: np.ndarray,
    moving: np.ndarray,
    weigh: Callable[[np.ndarray, np.ndarray], np.ndarray],
    rng: np.random.Generator,
) -> np.ndarray:
    """(draws, parameters): optima of drawn runs, linearised about x; those at a limit stay."""
    base = errors(x)
    slopes = []
    for i in moving:
        moved = x.copy()
        moved[i] += _STEP
        slopes.append((errors(moved) - base) / _STEP)
    runs = np.unique(recordings.run)
    drawn = np.repeat(x[None], _DRAWS, axis=0)
    rows = {int(r): recordings.run[recordings.run == r] for r in runs}
    for k in range(_DRAWS):
        chosen = rng.choice(runs, len(runs))
        again = np.concatenate([rows[int(r)] for r in chosen])
        matrix = np.stack([weigh(slope, again) for slope in slopes], axis=1)
        step = np.linalg.lstsq(matrix, -weigh(base, again), rcond=None)[0]
        drawn[k, moving] += step
    return drawn


def _layer(stack: HeatedStack, name: str) -> int:
    names = [layer.name for layer in stack.layers]
    if name not in names:
        raise InvalidValueError(f"stack {stack.name!r} has no layer {name!r}; it has {', '.join(names)}")
    return names.index(name)
