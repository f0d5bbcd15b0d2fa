"""Line charts as SVG: curves labelled at their ends, marks on the time axis, colours from the page's style sheet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from thermograsp.figures.look import spread_out

WIDTH, HEIGHT = 560.0, 400.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 34.0, 112.0, 26.0, 36.0
_LABEL = 15.0  # pixels between labels
_FINE = 0.2  # pixels that a path may leave out


@dataclass(frozen=True, slots=True)
class Curve:
    """One line of a plot. x, y: (n,). style: class of the group, which the style sheet colours."""

    label: str
    style: str
    x: np.ndarray
    y: np.ndarray


@dataclass(frozen=True, slots=True)
class Mark:
    """A moment on the time axis. before: its label stands left of it."""

    x: float
    label: str
    before: bool = False


def chart(curves: Sequence[Curve], marks: Sequence[Mark], x_end: float, y_end: float, title: str) -> str:
    """An <svg> element: x from 0 to x_end s, y from 0 to y_end K. title: for screen readers."""
    across, up = WIDTH - _LEFT - _RIGHT, HEIGHT - _TOP - _BOTTOM

    def px(x: np.ndarray | float) -> np.ndarray | float:
        return _LEFT + across * x / x_end

    def py(y: np.ndarray | float) -> np.ndarray | float:
        return _TOP + up * (1 - y / y_end)

    parts = [f'<svg viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img"><title>{escape(title)}</title>']
    for tick in _ticks(y_end):
        at = py(tick)
        parts.append(f'<line class="grid" x1="{_LEFT}" x2="{_LEFT + across}" y1="{at:.1f}" y2="{at:.1f}"/>')
        parts.append(f'<text class="tick" x="{_LEFT - 7}" y="{at + 4:.1f}" text-anchor="end">{tick:g}</text>')
    for tick in _ticks(x_end):
        at = px(tick)
        parts.append(
            f'<text class="tick" x="{at:.1f}" y="{_TOP + up + 18:.1f}" text-anchor="middle">{tick:g}</text>'
        )
    parts.append(f'<text class="tick" x="{_LEFT + across + 12}" y="{_TOP + up + 18}">s</text>')
    for mark in marks:
        at, anchor, shift = px(mark.x), "end" if mark.before else "start", -3 if mark.before else 3
        parts.append(f'<line class="mark" x1="{at:.1f}" x2="{at:.1f}" y1="{_TOP - 16}" y2="{_TOP + up}"/>')
        parts.append(
            f'<text class="mark" x="{at + shift:.1f}" y="{_TOP - 8}" text-anchor="{anchor}">{escape(mark.label)}</text>'
        )
    ends = [float(py(float(curve.y[-1]))) for curve in curves]
    places = spread_out(ends, _LABEL, _TOP + 4, _TOP + up - 2)
    for curve, end, place in zip(curves, ends, places, strict=True):
        x, y = _simplified(np.asarray(px(curve.x)), np.asarray(py(curve.y)))
        path = "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(x, y, strict=True))
        hair = f"M{x[-1] + 3:.1f} {end:.1f}L{x[-1] + 15:.1f} {place:.1f}"
        parts.append(
            f'<g class="curve {curve.style}"><path d="{path}"/><path class="hair" d="{hair}"/>'
            f'<text x="{x[-1] + 19:.1f}" y="{place + 4:.1f}">{escape(curve.label)}</text></g>'
        )
    return "".join([*parts, "</svg>"])


def _ticks(end: float) -> np.ndarray:
    step = next(step for step in (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 500.0, end) if end / step <= 7)
    return np.arange(0.0, end + step / 100, step)


def _simplified(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The points that a path needs to stay within _FINE of all of them, by vertical distance.

    Source: Ramer U., Computer Graphics and Image Processing 1(3), 244-256 (1972)."""
    keep = np.zeros(len(x), bool)
    keep[[0, -1]] = True
    spans = [(0, len(x) - 1)]
    while spans:
        first, last = spans.pop()
        inner = slice(first + 1, last)
        away = np.abs(y[inner] - np.interp(x[inner], x[[first, last]], y[[first, last]]))
        if len(away) and away.max() > _FINE:
            worst = first + 1 + int(np.argmax(away))
            keep[worst] = True
            spans += [(first, worst), (worst, last)]
    return x[keep], y[keep]
