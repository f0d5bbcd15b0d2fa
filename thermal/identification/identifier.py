"""Which material an object is of, and its effusivity, from the voltage of a touch.

M: materials, n: samples, F: fingertips.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from operator import add

import numpy as np

from thermograsp.errors import InvalidValueError, finite

from ..matter import Material, materials
from ..matter import material as named_material
from .effusivity import effusivity_posterior, prior_posterior
from .evidence import (
    Evidence,
    Explained,
    ProjectedCurves,
    explain,
    gather,
    project,
    slow_deviations,
)
from .library import CurveLibrary, curve_library
from .onset import (
    FOUND_WITHIN,
    OPENING,
    SETTLED,
    find_touch,
    onset,
    smooth_curve,
)
from .result import ANY_DIFFERENCE, Identification, judge
from .setup import TouchSetup

_MOST_SAMPLES = 100_000


class Identifier:
    """Identifies while samples come in; the posterior is that of all of them at once.

    setup: what is known beforehand. candidates: materials or names, all equally probable; None for the whole table.
    touch: s, when the contact opened on the clock of the samples; None to find it in them. cache: keep curves on disk.
    Raises InvalidValueError and UnknownNameError.
    """

    def __init__(
        self,
        setup: TouchSetup | None = None,
        candidates: Sequence[str | Material] | None = None,
        *,
        touch: float | None = None,
        cache: bool = True,
    ) -> None:
        self.setup = TouchSetup() if setup is None else setup
        chosen = (
            list(materials().values()) if candidates is None else [named_material(one) for one in candidates]
        )
        if not chosen:
            raise InvalidValueError("there are no candidates: name at least one material")
        self.names = tuple(one.name for one in chosen)
        self.library: CurveLibrary = curve_library(self.setup, chosen, cache=cache)
        self._touch_time = None if touch is None else finite("touch (s)", touch)
        self.reset()

    def reset(self) -> None:
        """Forgets all samples: the next ones are of another touch."""
        self._found: dict[int, float] = {}
        self._t = np.zeros(0)
        self._kelvin = np.zeros((0, 1))

    def update(
        self, t: np.ndarray | Sequence[float], voltage: np.ndarray | Sequence[float]
    ) -> Identification:
        """Takes the next samples and returns the posterior. t: (n,) s, increasing. voltage: (n,) V or (n, F), which
        every fingertip of the touch has its column in. Raises InvalidValueError."""
        try:
            samples = np.asarray(t, float), np.asarray(voltage, float)
        except (TypeError, ValueError):
            raise InvalidValueError("t and voltage must be arrays of numbers, in s and V") from None
        self._append(*samples)
        evidence, touches = [], []
        for tip, kelvin in enumerate(self._kelvin.T):
            touch = self._touch(tip, kelvin)
            touches.append(float("nan") if touch is None else touch)
            if touch is not None:
                evidence.append(self._gather(kelvin, touch))
        return self._answer(evidence, tuple(touches))

    def _append(self, t: np.ndarray, voltage: np.ndarray) -> None:
        columns = voltage[:, None] if voltage.ndim == 1 else voltage
        if t.ndim != 1 or columns.ndim != 2 or len(columns) != len(t):
            raise InvalidValueError(
                f"t must be (n,) and voltage (n,) or (n, fingertips), got {t.shape}, {voltage.shape}"
            )
        if len(self._t) and columns.shape[1] != self._kelvin.shape[1]:
            raise InvalidValueError(
                f"voltage had {self._kelvin.shape[1]} columns before and has {columns.shape[1]}"
            )
        times = np.concatenate((self._t, t))
        if not np.isfinite(t).all() or not np.isfinite(columns).all():
            raise InvalidValueError("t and voltage must be finite: leave lost samples out")
        if np.any(np.diff(times) <= 0):
            at = times[int(np.argmax(np.diff(times) <= 0)) + 1]
            raise InvalidValueError(
                f"times must increase; the sample at {at:g} s does not come after the last one"
            )
        if len(times) > _MOST_SAMPLES:
            raise InvalidValueError(
                f"{len(times)} samples are more than {_MOST_SAMPLES}: begin anew for each touch"
            )
        kelvin = self.setup.kelvin(columns)
        self._kelvin = np.concatenate((self._kelvin, kelvin)) if len(self._t) else kelvin
        self._t = times

    def _touch(self, tip: int, kelvin: np.ndarray) -> float | None:
        if self._touch_time is not None:
            return self._touch_time
        if tip in self._found:
            return self._found[tip]
        noise, offset = self._kelvins()
        first = onset(kelvin, noise, offset)
        if first is None:
            return None
        scale = float(np.hypot(*self.setup.difference))
        touch = find_touch(self.library, self._t, kelvin, first, noise, offset, scale)
        if self._t[-1] > self._t[first] + SETTLED:
            self._found[tip] = touch
        return touch

    @property
    def saturated(self) -> bool:
        """Whether there are samples, and all are at an end of the converter's range."""
        return self._kelvin.size > 0 and bool(self.setup.saturated(self._kelvin).all())

    def _kelvins(self) -> tuple[float, float]:
        """K of a sample's noise and of the offset."""
        return self.setup.noise / self.setup.element.seebeck, self.setup.offset

    def _gather(self, kelvin: np.ndarray, touch: float) -> Evidence:
        setup = self.setup
        used = (self._t <= touch + setup.horizon) & ~setup.saturated(kelvin)
        if self._touch_time is None:
            used &= (self._t < touch - OPENING[0]) | (self._t > touch + OPENING[1])
        if setup.smoothing:
            used &= np.abs(self._t - touch) > setup.smoothing
        since, values = self._t[used] - touch, kelvin[used]
        noise, offset = self._kelvins()
        mean, deviation = setup.difference
        scale = float(np.hypot(mean, deviation))
        basis = self.library.basis(since)
        nuisances = [np.full((len(since), 1), offset)]
        if len(since):
            curve, rate = smooth_curve(self.library, since, values, noise, scale)
            touch_error = setup.touch_error if self._touch_time is not None else FOUND_WITHIN
            nuisances.append(touch_error * rate[:, None])
            lacking = np.hypot(setup.model_error * np.abs(curve).max(), setup.tolerance / 4)
            lacking *= np.sqrt(self._kelvin.shape[1])  # the same for every fingertip: it does not average out
            nuisances.append(slow_deviations(since, float(lacking), setup.horizon))
        return gather(
            basis,
            self.library.typical * scale,
            values,
            noise,
            np.hstack([one for one in nuisances if one.any()] or [np.zeros((len(since), 1))]),
        )

    def _explain(self, projected: ProjectedCurves, difference: tuple[float, float]) -> Explained:
        count = len(self.names)
        start = np.zeros(count), projected.nodes(difference)[1][:, 0]
        return explain(projected, np.arange(count), start, difference, self.setup.resistance)

    def _answer(self, evidence: list[Evidence], touches: tuple[float, ...]) -> Identification:
        setup = self.setup
        if not evidence:
            nothing = np.full(len(self.names), 1 / len(self.names))
            return judge(setup, self.names, nothing, prior_posterior(setup.difference), touches)
        both = reduce(add, evidence)
        projected = project(both, self.library.materials)
        objects = effusivity_posterior(both, self.library, setup.difference, setup.resistance)
        listed, free = (self._explain(projected, one) for one in (setup.difference, ANY_DIFFERENCE))
        likely = np.exp(listed.log_evidence - listed.log_evidence.max())
        return judge(setup, self.names, likely / likely.sum(), objects, touches, both, listed, free)


def identify(
    t: np.ndarray | Sequence[float],
    voltage: np.ndarray | Sequence[float],
    *,
    setup: TouchSetup | None = None,
    candidates: Sequence[str | Material] | None = None,
    touch: float | None = None,
    cache: bool = True,
) -> Identification:
    """The posterior of one whole recording: Identifier(...).update(t, voltage), whose arguments these are. Raises
    InvalidValueError also for a touch that comes after all samples, and for samples that are all at an end of the
    converter's range, which could tell nothing of it."""
    identifier = Identifier(setup, candidates, touch=touch, cache=cache)
    found, last = identifier.update(t, voltage), max(t, default=-np.inf)
    if identifier.saturated:
        raise InvalidValueError(
            "every sample is at an end of the converter's range, where voltages tell nothing: measure with less gain"
        )
    if touch is not None and touch >= last:
        raise InvalidValueError(
            f"touch {touch:g} s is not before the last sample, at {last:g} s: give the time of the touch on the clock "
            "of the samples, or leave it out, and it is found"
        )
    return found
