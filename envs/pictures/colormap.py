"""Colours for temperatures."""

from __future__ import annotations

import numpy as np

from thermograsp.errors import InvalidValueError

COLOUR_MAP = "plasma"
"""Matplotlib's, perceptually uniform, dark blue over red to yellow; a lit body needs a cold end that is not black."""


def temperature_colour(celsius: np.ndarray | float, low: float = 20.0, high: float = 40.0) -> np.ndarray:
    """sRGB colours (..., 3) in 0..1 of temperatures (...) in degC; beyond low .. high the end colours are shown.

    Raises InvalidValueError when low >= high or a temperature is not finite.
    """
    from matplotlib import colormaps  # not needed by simulations that draw nothing

    if not low < high:
        raise InvalidValueError(f"colour range {low} .. {high} degC: give low < high")
    values = np.asarray(celsius, dtype=float)
    if not np.isfinite(values).all():
        raise InvalidValueError(f"temperature {celsius} degC: must be finite")
    return np.asarray(colormaps[COLOUR_MAP]((values - low) / (high - low)))[..., :3]
