"""Files of recorded touches: a heated sensor, a passive one and the force, of many touches at the same times.

B: touches, n: samples.
"""

from __future__ import annotations

import os
import zipfile
import zlib
from dataclasses import dataclass, replace

import numpy as np

from thermograsp.errors import InvalidValueError

from ...assets import asset

START = -0.3
"""s, to which drops of temperature are relative, and from where they are compared."""
NO_FORCE = 0.05
"""N, at or below which nothing is touched."""
_EARLIEST, _LATEST, _SHORTEST = -0.8, 1.0, 20  # s before and after the touch, samples, that a file must have
_COARSEST = 0.1  # s between samples, so that some lie in the window before the touch
_CURVES = ("heated_degC", "passive_degC", "force_N")
_ROWS = ("run", "material")
_COLDEST, _HOTTEST, _STRONGEST = -100.0, 300.0, 200.0  # °C, °C, N: beyond them a column is in another unit


@dataclass(frozen=True, slots=True)
class Recordings:
    """Recorded touches of a heated and a passive sensor. t: (n,) s, evenly spaced, 0 at the touch. heated, passive: (B,
    n) °C. force: (B, n) N. run: (B,) integers, of touches made under the same circumstances. label: (B,) names of what
    was touched."""

    t: np.ndarray
    heated: np.ndarray
    passive: np.ndarray
    force: np.ndarray
    run: np.ndarray
    label: np.ndarray

    @property
    def labels(self) -> list[str]:
        """In order of the alphabet."""
        return sorted(set(self.label.tolist()))

    @property
    def start(self) -> int:
        """Index of START."""
        return int(np.argmin(np.abs(self.t - START)))

    @property
    def drops(self) -> np.ndarray:
        """(B, m) K, from START on, of the heated sensor below its own temperature there."""
        return drops_of(self, self.heated)

    def only(self, chosen: np.ndarray) -> Recordings:
        """The touches of a mask or of indices."""
        rows = ("heated", "passive", "force", "run", "label")
        return replace(self, **{name: getattr(self, name)[chosen] for name in rows})


def drops_of(recordings: Recordings, curves: np.ndarray) -> np.ndarray:
    """(B, m) K from START on: what curves (B, n) °C at the recordings' times are below their own at START."""
    first = recordings.start
    return curves[:, first : first + 1] - curves[:, first:]


def shipped_recordings() -> Recordings:
    """The touches of assets/measured/touches.npz, by Bhattacharjee, Clever, Wade and Kemp (2021): README.md there."""
    return load_recordings(asset("measured/touches.npz"))


def load_recordings(path: str | os.PathLike[str]) -> Recordings:
    """The recordings of an .npz file with time_s (n,), heated_degC, passive_degC and force_N (B, n), run and material
    (B,). Raises InvalidValueError, which names the file and what is wrong with it."""
    try:
        with open(path, "rb") as stream:
            if not zipfile.is_zipfile(stream):
                raise zipfile.BadZipFile("it is another kind of file, or was cut short")
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as file:
                arrays = {name: np.asarray(file[name]) for name in file.files}
    except OSError as error:
        raise InvalidValueError(f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, EOFError, zlib.error, zipfile.BadZipFile) as error:
        raise InvalidValueError(f"{path} is no .npz file of plain arrays: {error}") from error
    missing = [name for name in ("time_s", *_CURVES, *_ROWS) if name not in arrays]
    if missing:
        raise InvalidValueError(
            f"{path} lacks {', '.join(missing)}: it holds {', '.join(sorted(arrays)) or 'nothing'}; "
            "docs/validation.md says what belongs in such a file"
        )
    try:
        return _checked(arrays)
    except InvalidValueError as error:
        raise InvalidValueError(f"{path}: {error}") from None


def _checked(arrays: dict[str, np.ndarray]) -> Recordings:
    t = _numbers("time_s", arrays["time_s"])
    if t.ndim != 1 or len(t) < _SHORTEST:
        raise InvalidValueError(f"time_s must be ({_SHORTEST} or more,), got {t.shape}")
    steps = np.diff(t)
    if not (steps > 0).all() or np.ptp(steps) > 0.01 * steps.mean():
        raise InvalidValueError("time_s must rise in equal steps")
    if steps.mean() > _COARSEST:
        raise InvalidValueError(
            f"time_s has a sample every {steps.mean():g} s: it must be in s, {_COARSEST:g} s or less apart"
        )
    if t[0] > _EARLIEST or t[-1] < _LATEST:
        raise InvalidValueError(
            f"time_s runs from {t[0]:g} to {t[-1]:g} s: it must begin at {_EARLIEST:g} s or before, the touch at 0, "
            f"and go on to {_LATEST:g} s at least"
        )
    rows = len(arrays["heated_degC"]) if arrays["heated_degC"].ndim else 0
    if not rows:
        raise InvalidValueError("heated_degC holds no touch")
    curves = {}
    for name in _CURVES:
        curves[name] = _numbers(name, arrays[name])
        if curves[name].shape != (rows, len(t)):
            raise InvalidValueError(
                f"{name} must be (touches, times) = {(rows, len(t))}, got {curves[name].shape}"
            )
    for name in _ROWS:
        if arrays[name].shape != (rows,):
            raise InvalidValueError(f"{name} must be ({rows},), one per touch, got {arrays[name].shape}")
    for name in ("heated_degC", "passive_degC"):
        _within(name, curves[name], _COLDEST, _HOTTEST, "°C")
    _within("force_N", curves["force_N"], -_STRONGEST, _STRONGEST, "N")
    warmer = (curves["heated_degC"] - curves["passive_degC"])[:, t < 0].mean(axis=1)
    if (warmer < 0).all():
        raise InvalidValueError(
            f"heated_degC is {-warmer.mean():.1f} K below passive_degC before the touch: are the two sensors' "
            "temperatures exchanged?"
        )
    idle = np.flatnonzero(curves["force_N"][:, t >= 0].max(axis=1) <= NO_FORCE)
    if len(idle):
        raise InvalidValueError(
            f"force_N stays at or below {NO_FORCE:g} N after the touch in {len(idle)} of {rows} touches, the first "
            f"number {idle[0]}: it must be the force that presses, above 0, in N"
        )
    if arrays["run"].dtype.kind not in "iu":
        raise InvalidValueError(f"run must be whole numbers, got {arrays['run'].dtype}")
    if arrays["material"].dtype.kind != "U":
        raise InvalidValueError(f"material must be strings, got {arrays['material'].dtype}")
    even = t[0] + (t[-1] - t[0]) * np.arange(len(t)) / (len(t) - 1)
    heated, passive, force = (curves[name] for name in _CURVES)
    return Recordings(even, heated, passive, force, arrays["run"], arrays["material"])


def _numbers(name: str, values: np.ndarray) -> np.ndarray:
    if values.dtype.kind not in "fiu":
        raise InvalidValueError(f"{name} must be numbers, got {values.dtype}")
    wrong = np.argwhere(~np.isfinite(values))
    if len(wrong):
        at = tuple(int(i) for i in wrong[0])
        raise InvalidValueError(
            f"{name} has {len(wrong)} values that are not finite, the first at {at}: leave such touches out"
        )
    return values.astype(float)


def _within(name: str, values: np.ndarray, low: float, high: float, unit: str) -> None:
    wrong = values[(values < low) | (values > high)]
    if len(wrong):
        raise InvalidValueError(f"{name} holds {wrong.flat[0]:g}: it must be in {unit}, {low:g} to {high:g}")
