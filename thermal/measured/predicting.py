"""Predictions of recorded touches, and the rules by which what belongs to a touch is taken from its record.

- Force: as recorded, but 0 before its last reading of NO_FORCE or less before the touch; where none is as low, all of
  it.
- State before the touch: the heated sensor's first value, and its rise over the first _RISE s.
- Sample's temperature: the passive sensor's mean in _SETTLED s, where both have met the same air; or given; or one
  free number for all touches of a label, the one whose mean curve fits best, below what the passive sensor has seen.

B: touches, n: samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermograsp.errors import InvalidValueError, SimulationError, finite, unknown_name

from ..matter import Material, materials
from ..stack import HeatedStack, Sample, Touches, touch_curves
from .recordings import NO_FORCE, Recordings, drops_of

COLDEST = -20.0
"""°C, of a freezer: the lowest that a free temperature may be."""
_RISE = 0.4  # s
_SETTLED = (-0.6, -0.3)  # s
_TWO = (0.0, 25.0)  # °C of the sample: readings are linear in it, so two give any

Temperature = float | Literal["passive", "free"]


@dataclass(frozen=True, slots=True)
class Touched:
    """What stands behind a label. temperature: °C, "passive" for the passive sensor's, "free" for the best one."""

    sample: Sample
    temperature: Temperature = "passive"


@dataclass(frozen=True, slots=True)
class Predictions:
    """Predicted recordings of touches. curves: (B, n) °C of the heated sensor as it would be recorded. temperature:
    (B,) °C that each sample was given. free: the temperature found for each label that had a free one."""

    curves: np.ndarray
    temperature: np.ndarray
    free: Mapping[str, float]


def touched_as(text: str) -> tuple[str, Touched]:
    """Of "LABEL=MATERIAL", "LABEL=MATERIAL@passive", "LABEL=MATERIAL@free" or "LABEL=MATERIAL@DEGC"; a MATERIAL of the
    table. Raises InvalidValueError and UnknownNameError."""
    label, _, what = text.partition("=")
    name, _, where = what.partition("@")
    if not label or not name:
        raise InvalidValueError(f"give LABEL=MATERIAL or LABEL=MATERIAL@TEMPERATURE, got {text!r}")
    temperature: Temperature = "passive"
    if where in ("passive", "free"):
        temperature = where
    elif where:
        try:
            temperature = finite("temperature (°C)", float(where))
        except ValueError:
            raise InvalidValueError(f"{text!r}: a temperature is passive, free or a number of °C") from None
    return label, Touched(_sample(name), temperature)


def known_labels(labels: list[str], given: Mapping[str, Touched]) -> dict[str, Touched]:
    """What stands behind each label: what is given, else the shipped file's meaning, else the material of that name.
    Raises UnknownNameError for others, and for given ones that are no labels."""
    for label in given:
        if label not in labels:
            raise unknown_name("label", label, labels)
    found = {}
    for label in labels:
        if label in given:
            found[label] = given[label]
        elif label in _SHIPPED:
            found[label] = touched_as(f"{label}={_SHIPPED[label]}")[1]
        else:
            found[label] = Touched(_sample(label))
    return found


_SHIPPED = {"metal": "aluminium", "wood": "wood", "cold_wood": "wood@free"}
"""Which metal and which wood is not known: wood sets the scale of everything, and any metal is nearly isothermal."""


def predict(recordings: Recordings, stack: HeatedStack, touched: Mapping[str, Touched]) -> Predictions:
    """Every touch, by the rules. Raises SimulationError where a prediction is not finite."""
    curves = np.empty_like(recordings.heated)
    temperature, free = np.empty(len(curves)), {}
    for label in recordings.labels:
        chosen = recordings.label == label
        some, what = recordings.only(chosen), touched[label]
        if what.temperature == "free":
            cold, warm = (_curves(some, stack, what.sample, np.full(len(some.run), value)) for value in _TWO)
            slope = (warm - cold) / (_TWO[1] - _TWO[0])
            free[label] = best_temperature(some, cold, slope)
            temperature[chosen] = free[label]
            curves[chosen] = cold + slope * (free[label] - _TWO[0])
            continue
        by_sensor = what.temperature == "passive"
        temperature[chosen] = passive_temperature(some) if by_sensor else float(what.temperature)
        curves[chosen] = _curves(some, stack, what.sample, temperature[chosen])
    if not np.isfinite(curves).all():
        raise SimulationError("a prediction is not finite: look at the sensor's properties")
    return Predictions(curves, temperature, free)


def passive_temperature(recordings: Recordings) -> np.ndarray:
    """(B,) °C of the passive sensor just before the touch."""
    low, high = _SETTLED
    inside = (recordings.t >= low) & (recordings.t <= high)
    return recordings.passive[:, inside].mean(axis=1)


def warmest_allowed(recordings: Recordings) -> float:
    """°C that a sample cannot be above: what the passive sensor, which is still falling, ends at, on the mean."""
    return float(recordings.passive[:, -1].mean())


def best_temperature(recordings: Recordings, cold: np.ndarray, slope: np.ndarray) -> float:
    """°C at which the mean drop fits best, between COLDEST and warmest_allowed. cold: curves at _TWO[0]; slope: by the
    sample's temperature."""
    slope_drops = drops_of(recordings, slope).mean(axis=0)
    missing = (recordings.drops - drops_of(recordings, cold)).mean(axis=0)
    best = _TWO[0] + float(slope_drops @ missing) / float(slope_drops @ slope_drops)
    return float(np.clip(best, COLDEST, warmest_allowed(recordings)))


def force_of_contact(recordings: Recordings) -> np.ndarray:
    """(B, n) N by the rule above."""
    before = recordings.t <= 0
    low = (recordings.force <= NO_FORCE) & before
    last = np.where(low.any(axis=1), recordings.force.shape[1] - 1 - low[:, ::-1].argmax(axis=1), -1)
    return np.where(np.arange(len(before)) > last[:, None], np.maximum(recordings.force, 0.0), 0.0)


def as_touches(recordings: Recordings, temperature: np.ndarray) -> Touches:
    """What belongs to the touches of samples at temperature (B,) °C."""
    rise = int(np.searchsorted(recordings.t, recordings.t[0] + _RISE - 1e-9))
    span = recordings.t[rise] - recordings.t[0]
    return Touches(
        recordings.t,
        force_of_contact(recordings),
        recordings.heated[:, 0],
        (recordings.heated[:, rise] - recordings.heated[:, 0]) / span,
        temperature,
        passive_temperature(recordings),
    )


def _curves(
    recordings: Recordings, stack: HeatedStack, sample: Sample, temperature: np.ndarray
) -> np.ndarray:
    return touch_curves(stack, [sample], as_touches(recordings, temperature)).recorded


def _sample(name: str) -> Sample:
    table = materials()
    if name not in table:
        raise unknown_name("material", name, table)
    return sample_of(table[name])


def sample_of(material: Material) -> Sample:
    """A half-space of it."""
    return Sample(material.conductivity, material.density * material.specific_heat)
