"""What the package raises, and the checks of numbers that everybody shares.

Every class also derives from the built-in that describes it, so that callers need not know ours. Messages say what is
wrong, which value it was, and what to do.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterable
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

_ABSOLUTE_ZERO = -273.15  # °C
HOTTEST = 250.0
"""°C that anything here may have: the materials' properties are those near room temperature."""
LONGEST = 5.0
"""m, the longest side of an object that a hand may touch."""
_MISTAKEN: dict[str, tuple[str, float, Callable[[float], float]]] = {
    "°C": ("kelvin", -_ABSOLUTE_ZERO - 100.0, lambda kelvin: kelvin + _ABSOLUTE_ZERO),
    "m": ("millimetres", 1.0, lambda mm: mm / 1000),
    "m/s": ("mm/s", 1.0, lambda rate: rate / 1000),
    "rad": ("degrees", 10.0, lambda degrees: degrees * math.pi / 180),
    "N": ("millinewtons", 1000.0, lambda mn: mn / 1000),
}
"""For a unit, another one that numbers are given in by mistake, from which number on, and how it is converted."""


class ThermograspError(Exception):
    """Base of everything that the package raises on purpose."""


class InvalidValueError(ThermograspError, ValueError):
    """An argument, a file's entry or a setting has a value that cannot be used."""


class UnknownNameError(ThermograspError, LookupError):
    """A name that is not among the known ones. Made by unknown_name."""


class UnknownKeywordError(InvalidValueError, TypeError):
    """A keyword that nothing takes; a TypeError, as Python's own. Made by unknown_keyword."""


class MissingDependencyError(ThermograspError, ImportError):
    """An optional package is needed and not installed; the message names the extra that brings it."""


class WriteError(ThermograspError, OSError):
    """A file cannot be written, for example on a full disk. Under its name there is what was there before."""


class MeshError(InvalidValueError):
    """A mesh cannot serve as an object: open, empty, inverted, or in an unusable format."""


class GripperError(InvalidValueError):
    """A robot's description cannot serve as a gripper: unreadable, without fingers, actuators or flat pads."""


class SimulationError(ThermograspError, RuntimeError):
    """A computation went wrong although its input was valid, such as a state that is no longer finite."""


def unknown_name(kind: str, name: object, known: Iterable[str]) -> UnknownNameError:
    """The error for `name`, which is not a known `kind`: with near names, or all of them where nothing is near."""
    names = sorted(known)
    near = _near(name, names) if isinstance(name, str) else []
    if near:
        hint = f"did you mean {_either(near)}?"
    elif names:
        hint = f"known: {', '.join(names)}"
    else:
        hint = "none is known"
    return UnknownNameError(f"unknown {kind} {name!r}; {hint}")


def unknown_keyword(owner: str, name: str, known: Iterable[str]) -> UnknownKeywordError:
    """The error for the keyword `name`, which `owner` does not take: with near names, or all of them."""
    names = sorted(known)
    near = _near(name, names)
    hint = f"did you mean {_either(near)}?" if near else f"known: {', '.join(names)}"
    return UnknownKeywordError(f"{owner} got an unexpected keyword argument {name!r}; {hint}")


def finite(name: str, value: object) -> float:
    """The value as a float. Raises InvalidValueError unless it is a finite real number (bool is not a number here)."""
    number = _number(name, value)
    if not math.isfinite(number):
        raise InvalidValueError(f"{name} must be a finite number, got {value!r}")
    return number


def positive(name: str, value: object) -> float:
    """The value as a float. Raises InvalidValueError unless it is finite and above 0."""
    number = _number(name, value)
    if not (math.isfinite(number) and number > 0):
        raise InvalidValueError(f"{name} must be a finite number above 0, got {value!r}")
    return number


def non_negative(name: str, value: object) -> float:
    """The value as a float. Raises InvalidValueError unless it is finite and not below 0."""
    number = _number(name, value)
    if not (math.isfinite(number) and number >= 0):
        raise InvalidValueError(f"{name} must be a finite number, 0 or above, got {value!r}")
    return number


def whole_number(name: str, value: object, least: int = 0) -> int:
    """The value as an int. Raises InvalidValueError unless it is an integer (2.0 is none), `least` or above."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        raise InvalidValueError(f"{name} must be a whole number, {least} or above, got {value!r}")
    return int(value)


def numbers(name: str, values: object, count: int) -> tuple[float, ...]:
    """The values as floats. Raises InvalidValueError unless they are so many finite numbers."""
    try:
        given = tuple(finite(name, value) for value in values)  # pyright: ignore[reportGeneralTypeIssues]
    except (TypeError, InvalidValueError):  # not iterable, or holds something else
        given = ()
    if len(given) != count:
        raise InvalidValueError(f"{name} must be {count} finite numbers, got {values!r}")
    return given


def celsius(name: str, value: object) -> float:
    """The value as a float. Raises InvalidValueError, which asks about kelvin, unless it is a temperature in °C from
    absolute zero to HOTTEST."""
    number = _number(name, value)
    if not _ABSOLUTE_ZERO <= number <= HOTTEST:
        raise InvalidValueError(
            f"{name} must be a temperature in °C, {_ABSOLUTE_ZERO} to {HOTTEST:g}, got {value!r}"
            + likely_unit(number, _ABSOLUTE_ZERO, HOTTEST, "°C")
        )
    return number


def length(name: str, value: object) -> float:
    """The value as a float. Raises InvalidValueError, which asks about millimetres, unless it is a length in m above 0
    and at most LONGEST."""
    number = positive(name, value)
    if number > LONGEST:
        raise InvalidValueError(
            f"{name} must be a length in m, at most {LONGEST:g}, got {value!r}"
            + likely_unit(number, 0.0, LONGEST, "m")
        )
    return number


def within(name: str, value: Any, low: float, high: float, unit: str) -> np.ndarray:
    """The value or values as an array of floats. Raises InvalidValueError, which names the first that is not in low ..
    high up to round-off, and the unit that it is likely to have been given in."""
    import numpy as np  # commands that need no arrays start without it

    slack = 1e-6 * high
    if isinstance(value, float) and low - slack <= value <= high + slack:
        return np.asarray(value)  # as most are, in a tenth of the time
    try:
        values = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InvalidValueError(
            f"{name} must be a number in {unit}, or an array of them, got {value!r}"
        ) from None
    wrong = values[~((values >= low - slack) & (values <= high + slack))]
    if wrong.size:
        given = float(wrong.flat[0])
        hint = likely_unit(given, low, high, unit)
        raise InvalidValueError(f"{name} {given:g} {unit}: give {low:g} to {high:g} {unit}{hint}")
    return values


def likely_unit(value: float, low: float, high: float, unit: str) -> str:
    """The end of a message about a value that is not in low .. high: what to give if it was in another unit, or nothing
    where that is not in low .. high either."""
    if unit not in _MISTAKEN:
        return ""
    mistaken, least, convert = _MISTAKEN[unit]
    meant = convert(value)
    likely = abs(value) >= least and low <= meant <= high
    return f"; {value:.6g} looks like {mistaken}: give {meant:.6g}" if likely else ""


def distinct_text(value: float, limit: float, decimals: int = 1) -> str:
    """A value that is beyond a limit, with so many decimals that it is still when it is read; `decimals` at least."""
    for count in range(decimals, 16):
        text = f"{value:.{count}f}"
        if (float(text) - limit) * (value - limit) > 0:
            return text
    return repr(value)


def install(extra: str) -> str:
    """The end of a message about a package that one of our extras brings: commands that install it."""
    return f"pip install 'thermograsp[{extra}]', or in a clone pip install -e '.[{extra}]'"


def _number(name: str, value: object) -> float:
    if isinstance(value, float):  # as most are; it is looked at ten times as fast as any real number
        return float(value)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InvalidValueError(f"{name} must be a number, got {value!r} ({type(value).__name__})")
    try:
        return float(value)
    except OverflowError:
        raise InvalidValueError(f"{name} must be a finite number, got an integer beyond float64") from None


def _near(name: str, names: list[str]) -> list[str]:
    """Up to three of `names` that resemble `name` in spelling, or else that hold it as a part."""
    folded = {known.casefold(): known for known in names}
    wanted = name.casefold()
    close = difflib.get_close_matches(wanted, folded, n=3)
    parts = [key for key in folded if len(wanted) >= 3 and wanted in key and key not in close]
    return [folded[key] for key in (close + parts)[:3]]


def _either(names: list[str]) -> str:
    quoted = [repr(name) for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
