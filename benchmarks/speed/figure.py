"""How near the environments come to bare MuJoCo, where the rest goes, and what else one may run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thermograsp.bench.kinds import Record
from thermograsp.figures import FAINT, INK, save_figure, style

_OURS = "#1d4f91"
_COLORS = ("#c3c9d1", "#8fb3dc", "#d4691e", "#e3b23c", "#1d4f91", "#5b8c5a")
_WIDTH, _HEIGHT = 10.0, 10.6


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws speed.png and speed.svg. Returns both."""
    speeds, start = record["speeds"], record["start_up"]
    with style(), mpl.rc_context({"font.size": 10}):
        figure = Figure(figsize=(_WIDTH, _HEIGHT), dpi=120)
        layout = figure.add_gridspec(
            3,
            2,
            height_ratios=(1, 1, 0.55),
            left=0.1,
            right=0.96,
            top=0.85,
            bottom=0.125,
            wspace=0.22,
            hspace=0.52,
        )
        grid = [[figure.add_subplot(layout[i, j]) for j in range(2)] for i in range(2)]
        title = {"x": 0.03, "ha": "left"}
        figure.text(y=0.962, s="What touch costs beside bare MuJoCo", size=17, weight="semibold", **title)
        figure.text(
            y=0.913,
            s="thermograsp/Grasp-v0 as shipped, a box, control steps of 10 x 2 ms, random actions, beside\n"
            "mujoco.batch stepping the same models through the same contacts on as many threads, in the same run.",
            size=10,
            **title,
        )
        _ratios(grid[0][0], speeds)
        _parts(grid[0][1], speeds, record["parts"])
        _modes(grid[1][0], record["modes"])
        _endurance(grid[1][1], record["endurance"])
        _scenes(figure.add_subplot(layout[2, :]), record["scenes"])
        figure.text(
            y=0.035,
            s=f"Each environment adds {record['memory']['per_env'] / 1e3:.0f} kB. Importing thermograsp adds "
            f"{1e3 * start['thermograsp']:.1f} ms to Gymnasium's {1e3 * start['gymnasium']:.0f} ms. "
            f"From make to the\nfirst step it takes {start['to_first_step']:.2f} s, from cache.",
            size=10,
            **title,
        )
        figure.text(y=0.012, s=footnote, size=6.5, color=FAINT, **title)
        return save_figure(figure, folder / "speed", 120)


def _ratios(axes: Axes, speeds: Sequence[Record]) -> None:
    axes.set_title("Speed as a share of bare MuJoCo's", pad=12)
    x = np.array([each["num_envs"] for each in speeds])
    y = np.array([each["ratio"] for each in speeds])
    low, high = np.array([each["quartiles"] for each in speeds]).T
    axes.fill_between(x, low, high, color=_OURS, alpha=0.18, lw=0)
    axes.plot(x, y, marker="o", color=_OURS, ms=6)
    for a, b in zip(x, y, strict=True):
        axes.annotate(
            f"{b:.2f}", (a, b), xytext=(0, -17), textcoords="offset points", ha="center", color=_OURS
        )
    axes.axhline(1.0, color=FAINT, lw=1.0, ls=(0, (4, 3)))
    axes.text(x[0], 1.012, "bare mujoco.batch", ha="left", va="bottom", color=FAINT, size=9)
    axes.set(xscale="log", xlabel="environments (band: quartiles of the blocks)", ylim=(0, 1.1))
    axes.set_xticks(x, [f"{n:,}" for n in x])
    axes.minorticks_off()
    axes.margins(x=0.08)


def _parts(axes: Axes, speeds: Sequence[Record], parts: Sequence[str]) -> None:
    axes.set_title("Where a step's time goes", pad=12)
    rows = np.arange(len(speeds))[::-1]
    for row, each in zip(rows, speeds, strict=True):
        begun, bare = 0.0, each["parts"][parts[0]]
        for name, color in zip(parts, _COLORS, strict=True):
            width = max(each["parts"][name], 0.0) / bare
            axes.barh(row, width, 0.62, left=begun, color=color)
            begun += width
    axes.set_yticks(rows, [f"{each['num_envs']:,}" for each in speeds])
    axes.set(xlabel="time of a control step over bare MuJoCo's", ylabel="environments")
    axes.set_xlim(0, 1.2 * axes.get_xlim()[1])  # room for the names
    axes.axvline(1.0, color=INK, lw=0.8)
    for i, (name, color) in enumerate(zip(parts, _COLORS, strict=True)):
        axes.text(
            0.99,
            0.42 - 0.075 * i,
            name,
            color=color if i else FAINT,
            transform=axes.transAxes,
            ha="right",
            size=9,
            weight="semibold",
        )


def _modes(axes: Axes, modes: Sequence[Record]) -> None:
    axes.set_title(f"{modes[0]['num_envs']} environments, ways to run them", pad=12)
    rows = np.arange(len(modes))[::-1]
    axes.barh(
        rows,
        [each["ratio"] for each in modes],
        0.62,
        color=[_OURS if each["mode"].startswith("native") else _COLORS[0] for each in modes],
    )
    for row, each in zip(rows, modes, strict=True):
        axes.text(each["ratio"] + 0.02, row, f"{each['ratio']:.2f}", va="center", color=INK)
    axes.set_yticks(
        rows, [each["mode"].replace(", ", ",\n").replace("Vector", "\nVector") for each in modes], size=9.5
    )
    axes.set_xlim(0, 1.15 * max(each["ratio"] for each in modes))
    axes.set_xlabel("environment steps per second, native = 1 (wall clock)")


def _endurance(axes: Axes, endurance: Record) -> None:
    axes.set_title("One episode without an end", pad=12)
    bins = len(endurance["relative"])
    x = (np.arange(bins) + 0.5) * endurance["steps"] / bins
    axes.plot(x, np.array(endurance["relative"]) / endurance["relative"][0], color=_OURS, marker=".", ms=5)
    axes.set_ylim(0, 1.2 * max(endurance["relative"]) / endurance["relative"][0])
    axes.set_xlim(0, endurance["steps"])
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    axes.set_xlabel(f"control steps, with {endurance['touches']:,} touches in all")
    axes.set_ylabel("cost of a step, first = 1")
    axes.locator_params(axis="x", nbins=5)


def _scenes(axes: Axes, scenes: Sequence[Record]) -> None:
    axes.set_title("Scenes of one's own with thermograsp.touch", pad=12)
    rows = np.arange(len(scenes))[::-1]
    axes.barh(rows, [each["ratio"] for each in scenes], 0.62, color=_OURS)
    for row, each in zip(rows, scenes, strict=True):
        low, high = each["quartiles"]
        axes.text(0.01, row, each["scene"], va="center", color="white", size=9)
        axes.text(max(high, 1.0) + 0.01, row, f"{each['ratio']:.2f}", va="center", color=INK)
        axes.plot((low, high), (row, row), color=INK, lw=1.2)
    axes.axvline(1.0, color=FAINT, lw=1.0, ls=(0, (4, 3)))
    axes.set_yticks([])
    axes.set_xlim(0, 1.15)
    axes.set_xlabel("speed as a share of the same scene's without touch (lines: quartiles of the blocks)")
