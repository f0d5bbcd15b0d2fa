"""Accuracy against contact time, intervals, and which materials are confused."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thermograsp.bench.kinds import Record
from thermograsp.figures import (
    FAINT,
    INK,
    PALE,
    readable,
    save_figure,
    style,
)

_LOOKS = {
    "limit": (INK, "Bayes limit", "-"),
    "identify": ("#1d4f91", "thermograsp identify", "-"),
    "svm": ("#b5651d", "SVM + PCA", "--"),
    "net": ("#7b3fa0", "recurrent net", "--"),
}


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws identify.png and identify.svg. Returns both."""
    with style(), mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(13.2, 10.4), dpi=110)
        grid = figure.add_gridspec(
            2, 3, left=0.08, right=0.985, top=0.885, bottom=0.14, wspace=0.42, hspace=0.36
        )
        figure.text(0.02, 0.962, "Materials told apart by touch", size=16, weight="semibold")
        figure.text(
            0.02,
            0.936,
            f"{len(record['materials'])} materials, {record['touches']} touches; contact 10³ .. 2·10⁴ W/(m² K) and "
            "object 24 ± 3 °C unknown; finger 36 °C; 1 mV/K, 7.8 µV a bit, 1 bit rms noise, 100 Hz.",
            size=10.5,
        )
        _accuracy(figure.add_subplot(grid[0, 0]), record)
        _eleven(figure.add_subplot(grid[0, 1]), record["eleven"], record["published"])
        _intervals(figure.add_subplot(grid[0, 2]), record["coverage"])
        for k, window in enumerate((0.5, 1.0, 2.0)):
            _confusion(figure.add_subplot(grid[1, k]), record, window, k == 0)
        figure.text(0.02, 0.012, footnote, size=7, color=FAINT)
        return save_figure(figure, folder / "identify", 110)


def _accuracy(axes: Axes, record: Record) -> None:
    x = np.array(record["windows_s"])
    axes.set(xscale="log", xlim=(0.45, 4.0), ylim=(0, 102), xlabel="contact time (s)", ylabel="right (%)")
    axes.set_xticks(x, [f"{one:g}" for one in x])
    axes.minorticks_off()
    axes.grid(color=PALE, lw=0.7)
    for name, values in record["right"].items():
        color, title, line = _LOOKS[name]
        y = 100 * np.array(values)
        width = 4.5 if name == "limit" else 1.6
        axes.plot(
            x, y, line, color=color, lw=width, alpha=0.25 if name == "limit" else 1, label=title,
            marker="" if name == "limit" else "o", ms=4.5,
        )  # fmt: skip
        if name != "limit":
            beside = (4, 5) if name in ("identify", "svm") else (4, -11)
            for place, value in zip(x[:-1], y[:-1], strict=True):
                axes.annotate(
                    f"{value:.0f}", (place, value), beside, textcoords="offset points", size=8, color=color
                )
    axes.legend(frameon=False, loc="lower right", fontsize=8.5)
    axes.set_title("Right, by contact time")


def _eleven(axes: Axes, eleven: Record, published: Record) -> None:
    unknown, steady, windows = eleven["right"]["unknown"], eleven["right"]["steady"], eleven["windows_s"]
    bars = [("contact 10³ .. 2·10⁴", _LOOKS["identify"][0], 0.45, unknown["identify"])]
    bars.append(("contact ± 25 %", _LOOKS["identify"][0], 0.95, steady["identify"]))
    if "svm" in steady:
        bars.append(("± 25 %, SVM + PCA", _LOOKS["svm"][0], 0.9, steady["svm"]))
    bars.append(("published, SVM + PCA", FAINT, 0.9, [published[f"{window:g}"] for window in windows]))
    width = 0.84 / len(bars)
    for k, (title, color, alpha, values) in enumerate(bars):
        at = np.arange(len(values)) + (k - (len(bars) - 1) / 2) * width
        axes.bar(at, 100 * np.array(values), 0.92 * width, color=color, alpha=alpha)
        for place, value in zip(at, values, strict=True):
            axes.text(place, 100 * value + 2, f"{100 * value:.0f}", ha="center", size=8, color=color)
        axes.text(
            0.02 + 0.5 * (k % 2),
            0.975 - 0.065 * (k // 2),
            title,
            size=8.5,
            color=color,
            alpha=max(alpha, 0.6),
            transform=axes.transAxes,
            va="top",
            weight="semibold",
        )
    # what the limit allows, as a line over the bars that it belongs to
    for k, one in enumerate((unknown, steady)):
        for place, value in enumerate(one["limit"]):
            middle = place + (k - (len(bars) - 1) / 2) * width
            axes.plot([middle - width / 2, middle + width / 2], [100 * value] * 2, color=INK, lw=1.5)
    axes.set(ylim=(0, 128), ylabel="right (%)", yticks=range(0, 101, 20))
    axes.set_xticks(range(len(windows)), [f"{window:g} s" for window in windows])
    axes.set_title(f"{len(eleven['materials'])} materials; black: the limit")


def _intervals(axes: Axes, coverage: Sequence[Record]) -> None:
    x = np.array([one["window"] for one in coverage])
    low, middle, high = np.array([one["ratio"] for one in coverage]).T
    axes.fill_between(x, low, high, color=INK, alpha=0.12, lw=0)
    axes.plot(x, middle, color=INK, marker="o", ms=4.5, lw=1.6)
    axes.set(
        xscale="log",
        yscale="log",
        xlim=(0.4, 5.0),
        xlabel="contact time (s)",
        ylabel="upper end over lower end",
        title="90 % interval of effusivity, any object",
    )
    ticks = [1.05, 1.2, 1.5, 2, 3, 5]
    axes.set_yticks(ticks, [f"{one:g}" for one in ticks])
    axes.set_xticks(x, [f"{one:g}" for one in x])
    axes.minorticks_off()
    axes.set_ylim(0.98 * max(low.min(), 1.01), 1.5 * high.max())
    for one, top in zip(coverage, high, strict=True):
        axes.text(one["window"], 1.07 * top, f"{100 * one['held']:.1f} %\nheld", ha="center", size=8.5)


def _confusion(axes: Axes, record: Record, window: float, first: bool) -> None:
    table = 100 * np.array(record["confusion"][f"{window:g}"])
    names = [readable(name) for name in record["materials"]]
    axes.imshow(table, cmap="Blues", vmin=0, vmax=115, aspect="equal")
    for row, column in zip(*np.nonzero(table > 0.5), strict=True):
        value = table[row, column]
        axes.text(column, row, f"{value:.0f}", ha="center", va="center", size=7.5,
                  color="white" if value > 60 else INK)  # fmt: skip
    axes.set_xticks(range(len(names)), names, rotation=60, ha="right", rotation_mode="anchor", size=8)
    axes.set_yticks(range(len(names)), names, size=8)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    if first:
        axes.set_ylabel("touched (%)")
    axes.set_xlabel("named")
    axes.set_title(f"Who is taken for whom after {window:g} s")
