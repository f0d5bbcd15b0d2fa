"""Speed across, error of the voltage up, a point a setting; the best toward the lower right."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from thermograsp.bench.kinds import Record
from thermograsp.figures import (
    FAINT,
    INK,
    ordered_colors,
    save_figure,
    style,
)

_FRONT = "#c9dcf2"
_MARKERS = ("^", "o", "s", "D")
_SIZE = 8.5


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws end_to_end.png and end_to_end.svg. Returns both."""
    points = record["points"]
    with style(), mpl.rc_context({"font.size": 11}):
        figure = Figure(figsize=(10.0, 6.4), dpi=120)
        axes = figure.add_axes((0.085, 0.14, 0.6, 0.66))
        figure.text(0.03, 0.93, "What speed costs in what the agent feels", size=17, weight="semibold")
        figure.text(
            0.03,
            0.86,
            f"{record['environments']} grasps at once: close, lift, put down, open, close again; all get the same "
            "commands.\nBest is the lower right.",
            size=10.5,
        )
        keys = _Keys(points)
        axes.set(xscale="log", yscale="log")
        speeds, errors = (
            np.array([p["speed"] for p in points]),
            1e6 * np.array([p["error_V"] for p in points]),
        )
        noise = 1e6 * record["converter_noise_V"]
        axes.set_xlim(0.8 * speeds.min(), 1.25 * speeds.max())
        axes.set_ylim(0.6 * min(errors.min(), noise), 1.7 * errors.max())
        _front(axes, points)
        axes.axhline(noise, color=FAINT, lw=1.0, ls=(0, (4, 3)))
        axes.text(
            axes.get_xlim()[1], noise * 0.96, "noise of the converter ", color=FAINT, ha="right", va="top"
        )
        for p in points:
            axes.plot(p["speed"], 1e6 * p["error_V"], ls="", **keys.look(p))
        _shipped(axes, points)
        axes.set_xlabel("simulated time per computing time, as shipped = 1")
        axes.set_ylabel("error of the voltage (µV rms)")
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.xaxis.set_minor_formatter(lambda value, _: f"{value:g}" if f"{value:e}"[0] in "25" else "")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        scale = next(p["relative"] / (1e6 * p["error_V"]) for p in points)
        right = axes.secondary_yaxis(
            "right", functions=(lambda y: np.asarray(y) * 100 * scale, lambda y: np.asarray(y) / 100 / scale)
        )
        right.yaxis.set_major_formatter(lambda value, _: f"{value:g} %")
        right.set_ylabel("of the signal's rms")
        right.spines["right"].set_visible(False)
        keys.draw(figure, 0.795, 0.8)
        figure.text(0.03, 0.02, footnote, size=6.5, color=FAINT)
        return save_figure(figure, folder / "end_to_end", 120)


def _front(axes: Axes, points: Sequence[Record]) -> None:
    front = sorted((p for p in points if p["pareto"]), key=lambda p: p["speed"])
    x = [axes.get_xlim()[0], *(p["speed"] for p in front), front[-1]["speed"]]
    y = [1e6 * front[0]["error_V"], *(1e6 * p["error_V"] for p in front), axes.get_ylim()[1]]
    axes.plot(x, y, drawstyle="steps-pre", color=_FRONT, lw=7, solid_joinstyle="miter", zorder=1)


def _shipped(axes: Axes, points: Sequence[Record]) -> None:
    shipped = next(p for p in points if p["shipped"])
    axes.plot(shipped["speed"], 1e6 * shipped["error_V"], "o", ms=19, mfc="none", mec=INK, mew=1.6, zorder=5)
    axes.annotate(
        f"as shipped: {1e3 * shipped['timestep']:g} ms x {shipped['substeps']}, {shipped['tolerance']:g} K",
        (shipped["speed"], 1e6 * shipped["error_V"]),
        xytext=(-8, 32),
        textcoords="offset points",
        ha="right",
        weight="semibold",
        arrowprops={"arrowstyle": "-", "color": INK, "lw": 0.8, "shrinkB": 10},
    )


class _Keys:
    """Colour: time step. Shape: control step. Filling: tolerance."""

    def __init__(self, points: Sequence[Record]) -> None:
        self._timesteps = sorted({p["timestep"] for p in points})
        self._periods = sorted({round(p["control_step_s"], 9) for p in points})
        self._tolerances = sorted({p["tolerance"] for p in points})
        self._colors = ordered_colors(len(self._timesteps))[::-1]

    def look(self, point: Record) -> dict:
        """Keywords of Axes.plot."""
        color = self._colors[self._timesteps.index(point["timestep"])]
        return {
            "color": color,
            "marker": _MARKERS[self._periods.index(round(point["control_step_s"], 9))],
            **self._filling(point["tolerance"], color),
        }

    def draw(self, figure: Figure, left: float, top: float) -> None:
        """Writes the three keys one below the other."""
        dot = {"marker": "o", "ls": "", "ms": _SIZE}
        groups = (
            (
                "MuJoCo time step",
                [
                    (f"{1e3 * t:g} ms", {**dot, "color": c})
                    for t, c in zip(self._timesteps, self._colors, strict=True)
                ],
            ),
            (
                "control step",
                [
                    (f"{1e3 * t:g} ms", {**dot, "color": INK, "marker": m})
                    for t, m in zip(self._periods, _MARKERS, strict=False)
                ],
            ),
            (
                "tolerance of heat",
                [(f"{t:g} K", {**dot, "color": INK, **self._filling(t, INK)}) for t in self._tolerances],
            ),
        )
        for title, entries in groups:
            figure.legend(
                [Line2D([], [], **look) for _, look in entries],
                [label for label, _ in entries],
                title=title,
                title_fontproperties={"weight": "semibold", "size": 11},
                loc="upper left",
                bbox_to_anchor=(left, top),
                frameon=False,
                alignment="left",
                handletextpad=0.4,
                labelspacing=0.35,
            )
            top -= 0.07 + 0.04 * len(entries)
        figure.legend(
            [Line2D([], [], color=_FRONT, lw=7)],
            ["nothing is both\nfaster and better"],
            loc="upper left",
            bbox_to_anchor=(left, top),
            frameon=False,
            handlelength=1.2,
        )

    def _filling(self, tolerance: float, color: str) -> dict:
        """Tight tolerances are filled, loose ones empty, the one between by half."""
        at = self._tolerances.index(tolerance)
        style = "full" if at == 0 else "none" if at == len(self._tolerances) - 1 else "left"
        return {"fillstyle": style, "mfc": color, "mfcalt": "white", "mew": 1.4, "ms": _SIZE, "zorder": 3}
