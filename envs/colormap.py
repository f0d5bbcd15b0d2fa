"""Colours for temperatures: a perceptually uniform map from dark blue over red to pale yellow.

Equal temperature differences are equal distances in Oklab (B. Ottosson, "A perceptual color space for image
processing", 2020), and lightness rises all the way, so that the map also reads in grey and to the colour-blind.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from thermograsp.errors import InvalidValueError

# Way points (lightness, chroma, hue in degrees) in Oklab's polar form, chosen to stay inside sRGB.
_WAY = np.array(
    [
        (0.24, 0.13, 268.0),
        (0.40, 0.17, 300.0),
        (0.55, 0.20, 355.0),
        (0.68, 0.19, 38.0),
        (0.82, 0.155, 75.0),
        (0.95, 0.11, 104.0),
    ]
)
_LMS_FROM_LAB = np.array(
    [(1, 0.3963377774, 0.2158037573), (1, -0.1055613458, -0.0638541728), (1, -0.0894841775, -1.2914855480)]
)
_RGB_FROM_LMS = np.array(
    [
        (4.0767416621, -3.3077115913, 0.2309699292),
        (-1.2684380046, 2.6097574011, -0.3413193965),
        (-0.0041960863, -0.7034186147, 1.7076147010),
    ]
)


def temperature_colour(celsius: np.ndarray | float, low: float = 20.0, high: float = 40.0) -> np.ndarray:
    """sRGB colours (..., 3) in 0..1 of temperatures (...) in degC; beyond low .. high the end colours are shown.

    Raises InvalidValueError when low >= high or a temperature is not finite.
    """
    if not low < high:
        raise InvalidValueError(f"colour range {low} .. {high} degC: give low < high")
    values = np.asarray(celsius, dtype=float)
    if not np.isfinite(values).all():
        raise InvalidValueError(f"temperature {celsius} degC: must be finite")
    table = colour_table()
    place = np.clip((values - low) / (high - low), 0.0, 1.0) * (len(table) - 1)
    return np.stack([np.interp(place, np.arange(len(table)), table[:, c]) for c in range(3)], axis=-1)


@cache
def colour_table(size: int = 256) -> np.ndarray:
    """(size, 3) sRGB colours in 0..1, equally spaced in Oklab. Read-only."""
    fine = oklab_path(4096)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))])
    even = np.linspace(0.0, along[-1], size)
    lab = np.stack([np.interp(even, along, fine[:, c]) for c in range(3)], axis=-1)
    table = srgb_from_oklab(lab)
    table.flags.writeable = False
    return table


def oklab_path(size: int) -> np.ndarray:
    """(size, 3) Oklab points of the map's curve through its way points."""
    hue = np.radians(_WAY[:, 2])
    unwrapped = np.unwrap(hue)
    at, to = np.linspace(0.0, 1.0, len(_WAY)), np.linspace(0.0, 1.0, size)
    light, chroma, angle = (np.interp(to, at, c) for c in (_WAY[:, 0], _WAY[:, 1], unwrapped))
    return np.stack([light, chroma * np.cos(angle), chroma * np.sin(angle)], axis=-1)


def srgb_from_oklab(lab: np.ndarray) -> np.ndarray:
    """(n, 3) gamma-coded sRGB of Oklab colours, clipped to what a screen can show."""
    linear = ((lab @ _LMS_FROM_LAB.T) ** 3) @ _RGB_FROM_LMS.T
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
