"""How many of a model's steps a time has, and how many samples of the converter."""

from __future__ import annotations

from thermograsp.errors import InvalidValueError

SAMPLE_TIME = 0.01  # s between samples of the converter, about: a whole part of dt and whole substeps
LONGEST = 3600.0  # s, of a dt and between updates
_WHOLE = 1e-6


def whole_steps(dt: float, step: float) -> int:
    """Steps of the model, s, in a dt."""
    if dt > LONGEST:
        raise InvalidValueError(f"dt={dt:g} s is too long between readings: give at most {LONGEST:g}")
    count = round(dt / step)
    if count < 1 or abs(dt / step - count) > _WHOLE * count:
        nearest = max(count, 1) * step
        raise InvalidValueError(
            f"dt={dt:g} s is not a whole number of the model's steps of {step:.9g} s: give {nearest:.9g}"
        )
    return count


def samples_in(substeps: int, dt: float) -> int:
    """How many samples a reading has: as many as divide its substeps, at most one each SAMPLE_TIME."""
    most = max(int(dt / SAMPLE_TIME * (1 + _WHOLE)), 1)
    return max(count for count in range(1, most + 1) if substeps % count == 0)
