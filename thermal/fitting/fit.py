"""A sensor's properties from recorded touches of known objects: maximum likelihood, with intervals.

The model is that of model.py. Its Seebeck coefficient, offset, delay and sensed layer are shared by all touches; each
touch has its conductance and, where its origin of time is uncertain, its lateness, normal about 0. Noise is white.
Intervals are those of the linearised problem (covariance from the Jacobian: Seber & Wild, Nonlinear Regression, Wiley
1989, section 5.1), with the variance of the residuals where that is above the noise's.

R: touches, P: shared parameters, x: parameters, the shared ones that are free, then of all touches the logarithms of
conductances, then the latenesses. Parameters that are positive are logarithms.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares
from scipy.special import ndtri

from thermograsp.errors import (
    InvalidValueError,
    SimulationError,
    positive,
    unknown_name,
)

from ..matter import SensorStack
from ..readout import ADS1115, SignalChain
from ..stack import HeatedStack, any_sensor, converter
from .heated import as_drops, fitted_core, with_element
from .known_touch import KnownTouch
from .model import (
    MOST_DELAY,
    POSITIVE,
    UNITS,
    TouchModel,
    shared_of,
    with_shared,
)

_CONDUCTANCE = (1e1, 5e3, 1e6)  # W/(m2 K): lowest, first, highest
_FACTOR = 10.0  # between the start and its bounds
_MOST_OFFSET = 0.1  # V
_MOST_LATE = 8.0  # standard deviations
_LEAST_SIGNAL = 20.0  # noises of a sample that the voltage must move by
_MISFIT = 0.05  # share of a touch's largest signal
_WIDE = 0.2  # relative half-width of an interval beyond which a value is not told
_ALIKE = 0.98  # correlation beyond which two are told only together
_OPEN = 1e-10  # relative singular value of the scaled Jacobian below which a direction is open


@dataclass(frozen=True, slots=True)
class Estimate:
    """value, and the interval from low to high, in the quantity's unit."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class SensorFit:
    """A sensor fitted to touches of known materials. stack: the fitted sensor. shared: by the keys of UNITS; one that
    was held is its own interval. conductances: (R,) W/(m2 K). misfit: (R,) rms of the residuals as a share of the
    touch's largest signal. noise: V rms of all residuals. correlation: (P, P), 0 with those held. untold: sentences on
    what the touches cannot tell. confidence: of the intervals."""

    stack: SensorStack | HeatedStack
    shared: Mapping[str, Estimate]
    conductances: tuple[Estimate, ...]
    misfit: tuple[float, ...]
    noise: float
    correlation: np.ndarray
    untold: tuple[str, ...]
    confidence: float


def fit_sensor(
    touches: Sequence[KnownTouch],
    *,
    start: str | SensorStack | HeatedStack = "seed",
    chain: SignalChain = ADS1115,
    hold: Collection[str] = (),
    confidence: float = 0.95,
) -> SensorFit:
    """Fits the sensor that made the touches.

    start: a sensor of the same make; its Seebeck coefficient and the conductivity and heat capacity of its sensed layer
    are fitted within a factor of 10, all else is kept. chain: its bandwidth, noise and resolution count, its offset and
    gain do not. hold: keys of UNITS to keep as they start (offset and delay: 0), for what the touches cannot tell.

    A heated sensor (one with a `touch` table) has been warm for long before each touch, and its heat is cut, constant
    or held. Its sensed layer is the one between heater and readout; its divider is given, so that `seebeck` is held.
    Its records are those before any smoothing that looks ahead.

    Raises InvalidValueError for no touches, for one that is not felt or does not fit (as with another material or
    temperature than was given), for estimates at a bound, and where the touches leave a parameter open;
    UnknownNameError for `hold`; SimulationError where no optimum is found.
    """
    for name in hold:
        if name not in UNITS:
            raise unknown_name("parameter", name, UNITS)
    if not touches:
        raise InvalidValueError("no touches: give one at least, better ten on two materials")
    if not 0 < confidence < 1:
        raise InvalidValueError(f"confidence must be between 0 and 1, got {confidence!r}")
    sensor = any_sensor(start)
    chain = converter(sensor, chain)
    if isinstance(sensor, HeatedStack):
        core = fitted_core(sensor)
        stack, hold = core.element, {*hold, "seebeck"}
        touches = as_drops(touches, core)
    else:
        stack, core = sensor, None
    noise = positive(
        "noise and resolution of the chain (V)", float(np.hypot(chain.noise, chain.resolution / 12**0.5))
    )
    for touch in touches:
        if np.ptp(touch.voltage) < _LEAST_SIGNAL * noise:
            raise InvalidValueError(
                f"{touch.name}: the voltage moves by {np.ptp(touch.voltage):.2g} V, at a noise of {noise:.2g} V rms: "
                "nothing is felt; look at the sensor's wires and the temperatures"
            )
    model = TouchModel(touches, stack, chain.bandwidth, core)
    problem = _Problem(model, shared_of(stack), noise, hold)
    found = least_squares(
        problem.residuals,
        problem.first,
        jac=problem.jacobian,  # pyright: ignore[reportArgumentType]
        bounds=(problem.low, problem.high),
        x_scale="jac",
        max_nfev=100,
    )
    if not found.success:
        raise SimulationError(
            f"no optimum within 100 evaluations: {found.message}; look at the recordings' materials"
        )
    fit = problem.result(found.x, found.fun, found.jac, stack, confidence)
    if isinstance(sensor, HeatedStack) and isinstance(fit.stack, SensorStack):
        return replace(fit, stack=with_element(sensor, fit.stack))
    return fit


class _Problem:
    """Residuals in standard deviations: all samples, then the uncertain origins."""

    def __init__(
        self, model: TouchModel, start: Mapping[str, float], noise: float, hold: Collection[str]
    ) -> None:
        self._model, self._start, self._noise = model, start, noise
        self.free = [name for name in UNITS if name not in hold]
        self._errors = np.array([touch.touch_error for touch in model.touches])
        self._uncertain = np.flatnonzero(self._errors)
        bounds = [self._bounds(name) for name in self.free]
        bounds += [tuple(np.log(_CONDUCTANCE))] * len(model.touches)
        bounds += [(-_MOST_LATE * e, 0.0, _MOST_LATE * e) for e in self._errors[self._uncertain]]
        self.low, self.first, self.high = np.array(bounds, float).T

    def residuals(self, x: np.ndarray) -> np.ndarray:
        """(samples and origins,)."""
        shared, conductances, late = self._parts(x)
        misses = [
            self._model.voltage(r, shared, conductances[r], late[r]) - touch.voltage
            for r, touch in enumerate(self._model.touches)
        ]
        return np.concatenate(
            (np.concatenate(misses) / self._noise, (late / _ones_for_zeros(self._errors))[self._uncertain])
        )

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """(samples and origins, parameters)."""
        shared, conductances, late = self._parts(x)
        lengths = [len(touch.t) for touch in self._model.touches]
        matrix = np.zeros((sum(lengths) + len(self._uncertain), len(x)))
        of_late = {int(r): len(x) - len(self._uncertain) + k for k, r in enumerate(self._uncertain)}
        for r, end in enumerate(np.cumsum(lengths)):
            rows = slice(end - lengths[r], end)
            slopes = self._model.slopes(r, shared, conductances[r], late[r])
            for column, name in enumerate(self.free):
                matrix[rows, column] = slopes[name] / self._noise
            matrix[rows, len(self.free) + r] = slopes["conductance"] / self._noise
            if r in of_late:
                matrix[rows, of_late[r]] = slopes["delay"] / self._noise
        for row, (r, column) in enumerate(of_late.items(), sum(lengths)):
            matrix[row, column] = 1 / self._errors[r]
        return matrix

    def result(
        self,
        x: np.ndarray,
        residuals: np.ndarray,
        jacobian: np.ndarray,
        stack: SensorStack,
        confidence: float,
    ) -> SensorFit:
        """What the optimum says. Raises as fit_sensor does."""
        samples = residuals[: len(residuals) - len(self._uncertain)] * self._noise
        misfit = self._misfit(samples)
        self._require_inside(x)
        variance = max(1.0, float(residuals @ residuals) / max(1, len(residuals) - len(x)))
        covariance = variance * self._inverse(jacobian)
        half = ndtri((1 + confidence) / 2) * np.sqrt(np.diag(covariance))
        shared, conductances, _ = self._parts(x)
        estimates = {name: Estimate(value, value, value) for name, value in shared.items()}
        for k, name in enumerate(self.free):
            estimates[name] = _estimate(shared[name], half[k], name in POSITIVE)
        count = len(self.free)
        correlation = np.zeros((len(UNITS), len(UNITS)))
        places = [list(UNITS).index(name) for name in self.free]
        spread = np.sqrt(np.diag(covariance)[:count])
        correlation[np.ix_(places, places)] = covariance[:count, :count] / np.outer(spread, spread)
        return SensorFit(
            stack=with_shared(stack, shared),
            shared=estimates,
            conductances=tuple(
                _estimate(h, e, True) for h, e in zip(conductances.tolist(), half[count:], strict=False)
            ),
            misfit=misfit,
            noise=float(np.sqrt(np.mean(samples**2))),
            correlation=correlation,
            untold=_untold(estimates, correlation),
            confidence=confidence,
        )

    def _bounds(self, name: str) -> tuple[float, float, float]:
        """Lowest, first, highest."""
        if name == "offset":
            before = [touch.voltage[touch.t < 0] for touch in self._model.touches]
            return -_MOST_OFFSET, float(np.clip(np.mean(np.concatenate(before)), -0.09, 0.09)), _MOST_OFFSET
        if name == "delay":
            return MOST_DELAY[0], 0.0, MOST_DELAY[1]
        first, reach = np.log(self._start[name]), np.log(_FACTOR)
        return first - reach, first, first + reach

    def _parts(self, x: np.ndarray) -> tuple[dict[str, float], np.ndarray, np.ndarray]:
        """Shared parameters, conductances (R,) W/(m2 K), latenesses (R,) s."""
        shared = dict(self._start)
        for name, value in zip(self.free, x.tolist(), strict=False):
            shared[name] = float(np.exp(value)) if name in POSITIVE else value
        begin, end = len(self.free), len(self.free) + len(self._model.touches)
        late = np.zeros(len(self._model.touches))
        late[self._uncertain] = x[end:]
        return shared, np.exp(x[begin:end]), late

    def _misfit(self, samples: np.ndarray) -> tuple[float, ...]:
        shares, end = [], 0
        for touch in self._model.touches:
            begin, end = end, end + len(touch.t)
            shares.append(float(np.sqrt(np.mean(samples[begin:end] ** 2)) / np.ptp(touch.voltage)))
            if shares[-1] > _MISFIT:
                raise InvalidValueError(
                    f"{touch.name} does not fit: residuals of {shares[-1]:.0%} of its signal; are its material, "
                    "temperatures and object size those given, and is it one steady touch of a fresh object?"
                )
        return tuple(shares)

    def _require_inside(self, x: np.ndarray) -> None:
        at = np.isclose(x, self.low, rtol=1e-6, atol=1e-9) | np.isclose(x, self.high, rtol=1e-6, atol=1e-9)
        names = [*self.free, *(f"conductance of {touch.name}" for touch in self._model.touches)]
        stuck = [name for name, is_at in zip(names, at, strict=False) if is_at]
        if stuck:
            raise InvalidValueError(
                f"the fit ends at a bound of {', '.join(stuck)}: the touches do not tell it, or what is given of them "
                "is wrong; hold it, add touches of another material, or start nearer"
            )

    def _inverse(self, jacobian: np.ndarray) -> np.ndarray:
        """Of J'J. Raises InvalidValueError where it has none, with the parameters that are open."""
        scale = np.linalg.norm(jacobian, axis=0)
        _, singular, turn = np.linalg.svd(jacobian / _ones_for_zeros(scale), full_matrices=False)
        if singular[-1] <= _OPEN * singular[0] or not scale.all():
            names = [name for k, name in enumerate(self.free) if abs(turn[-1, k]) > 0.1 or not scale[k]]
            raise InvalidValueError(
                f"the touches do not determine {' and '.join(names) or 'a conductance'}: hold one of them"
            )
        half = turn.T / singular / scale[:, None]
        return half @ half.T


def _estimate(value: float, half: float, logarithm: bool) -> Estimate:
    if logarithm:
        return Estimate(value, float(value * np.exp(-half)), float(value * np.exp(half)))
    return Estimate(value, float(value - half), float(value + half))


def _untold(estimates: Mapping[str, Estimate], correlation: np.ndarray) -> tuple[str, ...]:
    wide = [
        f"{name} is only known to lie between {e.low:.3g} and {e.high:.3g} {UNITS[name]}"
        for name, e in estimates.items()
        if name in POSITIVE and e.high > e.value * (1 + _WIDE)
    ]
    alike = [
        f"{one} and {other} are told only together (correlation {correlation[i, j]:+.3f}): hold one of them, or touch "
        "materials that differ more"
        for i, one in enumerate(UNITS)
        for j, other in enumerate(UNITS)
        if i < j and abs(correlation[i, j]) > _ALIKE
    ]
    return (*wide, *alike)


def _ones_for_zeros(values: np.ndarray) -> np.ndarray:
    return np.where(values == 0, 1.0, values)
