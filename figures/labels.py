"""Labels beside points where they cover neither points nor each other, and keys of coloured words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

_REACH = (7.0, 13.0, 21.0, 32.0, 45.0)  # points
_ANGLES = np.radians(np.arange(0, 360, 30))


@dataclass(frozen=True, slots=True)
class Label:
    """text at (x, y) in data, in a colour; size in points."""

    x: float
    y: float
    text: str
    color: str
    size: float = 8.0
    weight: str = "normal"


def coloured_key(
    figure: Figure, words: Sequence[tuple[str, str]], left: float, top: float, line: float
) -> None:
    """What colours stand for, as (colour, words) written in a row from (left, top), wrapped at the figure's right edge;
    line: distance of rows. All in shares of the figure."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    x, y = left, top
    for color, words_here in words:
        written = figure.text(x, y, words_here, size=9, color=color, weight="semibold")
        width = written.get_window_extent(renderer).width / figure.bbox.width
        if x + width > 0.99:
            x, y = left, y - line
            written.set_position((x, y))
        x += width + 0.018


def place_labels(axes: Axes, labels: Sequence[Label], avoid: np.ndarray) -> None:
    """Writes each label at the nearest free place around its point, with a hair where that is far.

    avoid: (n, 2) data positions not to be covered. Limits and scales must be set before."""
    figure = axes.figure
    assert isinstance(figure, Figure)
    renderer = FigureCanvasAgg(figure).get_renderer()
    pixel = figure.dpi / 72
    frame = axes.get_window_extent(renderer)
    points = axes.transData.transform(avoid)
    taken: list[tuple[float, float, float, float]] = []
    for label in labels:
        text = axes.text(0, 0, label.text, size=label.size, weight=label.weight, color=label.color)
        extent = text.get_window_extent(renderer)
        width, height = extent.width, extent.height
        at = axes.transData.transform((label.x, label.y))
        best, cost = None, np.inf
        for reach in _REACH:
            for angle in _ANGLES:
                away = np.array([np.cos(angle), np.sin(angle)])
                centre = at + away * reach * pixel + away * np.array([width, height]) / 2
                box = (
                    centre[0] - width / 2,
                    centre[1] - height / 2,
                    centre[0] + width / 2,
                    centre[1] + height / 2,
                )
                price = reach + _covered(box, points, taken, pixel)
                outside = box[0] < frame.x0 or box[1] < frame.y0 or box[2] > frame.x1 or box[3] > frame.y1
                price += 500 * outside
                if price < cost:
                    best, cost = (box, centre, reach), price
        assert best is not None
        box, centre, reach = best
        taken.append(box)
        inverse = axes.transData.inverted()
        text.set(position=inverse.transform(centre), ha="center", va="center")
        if reach > _REACH[0]:
            near = np.clip(at, [box[0], box[1]], [box[2], box[3]])
            ends = inverse.transform(np.array([at, near]))
            axes.plot(ends[:, 0], ends[:, 1], color=label.color, lw=0.6, alpha=0.7, zorder=1.5)


def _covered(
    box: tuple[float, float, float, float],
    points: np.ndarray,
    taken: Sequence[tuple[float, float, float, float]],
    pixel: float,
) -> float:
    margin = 2.5 * pixel
    inside = (
        (points[:, 0] > box[0] - margin)
        & (points[:, 0] < box[2] + margin)
        & (points[:, 1] > box[1] - margin)
        & (points[:, 1] < box[3] + margin)
    )
    crossed = sum(
        box[0] < other[2] + margin
        and other[0] < box[2] + margin
        and box[1] < other[3] + pixel
        and other[1] < box[3] + pixel
        for other in taken
    )
    return 60.0 * int(inside.sum()) + 200.0 * crossed
