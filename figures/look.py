"""One look for all figures: a colour a material, fonts, sizes, and labels at the curves instead of legends.

Colours run through matplotlib's perceptually uniform "plasma", from amber for the material that draws least heat (it
feels warm) to deep blue for the one that draws most (it feels cold); the map's last tenth is too pale for lines.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK = "#22252a"
"""Text and axes."""
FAINT = "#8a9099"
"""What stands behind: ticks, guides, notes."""
PALE = "#e9ecf0"
"""Shaded regions."""
TEMPERATURE_MAP = "inferno"
"""Colour map of temperature fields, bright = hot."""

_WARM, _COLD = 0.86, 0.0
_SETTINGS: Any = {
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "savefig.dpi": 160,
    "svg.fonttype": "none",
    "svg.hashsalt": "thermograsp",
    "font.family": "sans-serif",
    "font.sans-serif": ["Inter", "Source Sans 3", "Helvetica Neue", "Arial", "DejaVu Sans"],
    "font.size": 9.5,
    "text.color": INK,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.titlesize": 11,
    "axes.titleweight": "semibold",
    "axes.titlelocation": "left",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.direction": "out",
    "lines.linewidth": 1.9,
    "lines.solid_capstyle": "round",
}


def style() -> AbstractContextManager[None]:
    """Within it matplotlib draws in the house's look."""
    # The families are alternatives: a warning for each one that a machine lacks would say nothing.
    logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)
    return mpl.rc_context(_SETTINGS)


def ordered_colors(count: int) -> list[str]:
    """Hex colours of that many things in order, warm to cold."""
    at = np.linspace(_WARM, _COLD, count) if count > 1 else np.array([_COLD])
    return [to_hex(color) for color in mpl.colormaps["plasma"](at)]


def readable(name: str) -> str:
    """A material's name as people write it."""
    return name.replace("_", " ")


def spread_out(places: Sequence[float] | np.ndarray, least: float, low: float, high: float) -> np.ndarray:
    """Places at least `least` apart, inside [low, high] as far as they fit, each as near to its own as can be.

    Least squares under the order constraint: pool adjacent violators on the places less their offsets."""
    order = np.argsort(places, kind="stable")
    wanted = np.asarray(places, float)[order] - least * np.arange(len(places))
    blocks: list[list[float]] = []  # (mean, size)
    for value in wanted:
        blocks.append([value, 1])
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            mean, size = blocks.pop()
            before = blocks[-1]
            before[0] = (before[0] * before[1] + mean * size) / (before[1] + size)
            before[1] += size
    pooled = np.repeat([mean for mean, _ in blocks], [int(size) for _, size in blocks])
    room = max(high - least * (len(places) - 1), low)
    result = np.empty(len(places))
    result[order] = np.clip(pooled, low, room) + least * np.arange(len(places))
    return result


def label_ends(
    axes: Axes,
    x: float,
    ends: Sequence[float] | np.ndarray,
    labels: Sequence[str],
    colors: Sequence[str],
    size: float = 9.0,
) -> None:
    """Labels right of curves that end at (x, ends), in the curves' colours, moved apart where they would collide; a
    hair leads from the curve to its label. Limits must be set before."""
    low, high = axes.get_ylim()
    points = axes.get_window_extent().height / axes.figure.dpi * 72
    least = 1.22 * size / points * (high - low)
    left, right = axes.get_xlim()
    hair, text = x + 0.012 * (right - left), x + 0.045 * (right - left)
    places = spread_out(ends, least, low + least / 2, high - least / 2)
    for end, place, label, color in zip(ends, places, labels, colors, strict=True):
        axes.plot([hair, text - 0.006 * (right - left)], [end, place], color=color, lw=0.7, clip_on=False)
        axes.text(text, place, label, color=color, size=size, va="center", ha="left", clip_on=False)
