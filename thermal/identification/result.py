"""What an identification says, and how sure it is of it.

M: materials, F: fingertips.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from math import erf, log, sqrt

import numpy as np

from .effusivity import EffusivityPosterior
from .evidence import Evidence, Explained
from .setup import TouchSetup

ANY_DIFFERENCE = (0.0, 30.0)
"""K, prior under which the temperatures are asked whether they were close, whatever the setup holds for likely."""

_SURE = 0.9  # of one material
_CLOSEST = (
    120.0  # times the noise of a sample in K: nearer temperatures leave less than half of ten materials right
)
_RATHER = log(1000.0)  # one explanation than another


class Verdict(StrEnum):
    """What a curve allows to say."""

    MATERIAL = "material"
    """One material has at least 90 %."""
    SEVERAL = "several"
    """Several materials remain."""
    TOO_CLOSE = "too_close"
    """Object and finger were too close in temperature to tell."""
    NO_TOUCH = "no_touch"
    """The voltage shows no touch: there was none, or object and finger had the same temperature."""
    NOT_LISTED = "not_listed"
    """An object of the effusivity found would explain the curve, but none of the materials does."""
    UNEXPLAINED = "unexplained"
    """No homogeneous object in a steady contact explains the curve."""


@dataclass(frozen=True, slots=True)
class Identification:
    """Posterior of one touch. verdict: what it allows to say, message: the same for people.

    materials: (M,) names. probability: (M,), sums to 1. effusivity: posterior over objects of any material, with
    median and interval(level). difference: K, sensor less object at the touch, mean and standard deviation.
    conductance: W/(m2 K), most probable one with the most probable material. touch: (F,) s, NaN where none was found.
    noise: V rms of a sample, as it was found. samples: how many counted.
    """

    verdict: Verdict
    message: str
    materials: tuple[str, ...]
    probability: np.ndarray
    effusivity: EffusivityPosterior
    difference: tuple[float, float]
    conductance: float
    touch: tuple[float, ...]
    noise: float
    samples: int

    @property
    def best(self) -> str:
        """The most probable material."""
        return self.materials[int(np.argmax(self.probability))]

    def likely(self, level: float = _SURE) -> tuple[str, ...]:
        """The fewest materials that hold probability `level` together, most probable first."""
        order = np.argsort(-self.probability, kind="stable")
        count = int(np.searchsorted(np.cumsum(self.probability[order]), level)) + 1
        return tuple(self.materials[i] for i in order[:count])


def judge(
    setup: TouchSetup,
    names: tuple[str, ...],
    probability: np.ndarray,
    objects: EffusivityPosterior,
    touches: tuple[float, ...],
    evidence: Evidence | None = None,
    listed: Explained | None = None,
    free: Explained | None = None,
) -> Identification:
    """The identification of these posteriors. listed: of the materials under the setup's prior; free: under
    ANY_DIFFERENCE. Without evidence there was no touch."""
    conductance, noise, samples = float("nan"), setup.noise, 0
    verdict = Verdict.NO_TOUCH
    if evidence is not None and listed is not None and free is not None:
        conductance = float(1 / listed.resistance[int(np.argmax(probability))])
        noise, samples = evidence.noise * setup.element.seebeck, evidence.samples
        verdict = _verdict(evidence, probability, objects, listed, free)
    result = Identification(
        verdict, "", names, probability, objects, objects.difference, conductance, touches, noise, samples
    )
    return replace(result, message=_message(result))


def _verdict(
    evidence: Evidence,
    probability: np.ndarray,
    objects: EffusivityPosterior,
    listed: Explained,
    free: Explained,
) -> Verdict:
    if _close(free, _CLOSEST * evidence.noise) > 0.5:
        return Verdict.TOO_CLOSE
    numbers = len(evidence.data)
    if min(objects.misfit, float(listed.misfit.min())) > numbers + 6 * sqrt(2 * numbers) + 10:
        return Verdict.UNEXPLAINED
    top = float(listed.log_evidence.max())
    any_listed = top + log(np.exp(listed.log_evidence - top).mean())
    if objects.log_evidence - any_listed > _RATHER:
        return Verdict.NOT_LISTED
    return Verdict.MATERIAL if probability.max() >= _SURE else Verdict.SEVERAL


def _close(free: Explained, least: float) -> float:
    """Probability that the temperatures differ by less than `least` K."""
    weights = np.exp(free.log_evidence - free.log_evidence.max())
    total = 0.0
    for weight, mean, variance in zip(weights, free.difference, free.difference_variance, strict=True):
        width = sqrt(2 * float(variance))
        total += weight * (erf((least - mean) / width) + erf((least + mean) / width)) / 2
    return float(total / weights.sum())


def _message(result: Identification) -> str:
    share = f"{result.best.replace('_', ' ')} ({100 * result.probability.max():.0f} %)"
    low, high = result.effusivity.interval()
    object_ = (
        f"its effusivity is {result.effusivity.median:.0f} W s^0.5/(m2 K), with 90 % probability between {low:.0f} and "
        f"{high:.0f}"
    )
    mean, deviation = result.difference
    several = result.likely()
    names = ", ".join(one.replace("_", " ") for one in several[:6]) + (" ..." if len(several) > 6 else "")
    return {
        Verdict.MATERIAL: f"it is {share}; {object_}",
        Verdict.SEVERAL: f"it is one of {len(several)} materials: {names}; {object_}",
        Verdict.TOO_CLOSE: "object and finger were too close in temperature to tell what the object is made of; "
        "heat or cool one of them by some kelvin",
        Verdict.NO_TOUCH: "the voltage shows no touch: there was none, or object and finger had the same temperature",
        Verdict.NOT_LISTED: f"it is none of the materials, of which {share} is the nearest; {object_}",
        Verdict.UNEXPLAINED: f"no object in a steady contact explains the curve; the nearest material is {share}; "
        f"check the object's size, the temperatures (found {mean:.1f} K apart) and that the contact lasted",
    }[result.verdict]
