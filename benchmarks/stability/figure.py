"""The stability atlas: one small map a scheme, one legend."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from thermograsp.bench.kinds import Record
from thermograsp.figures import FAINT, INK, save_figure, style

COLORS = ("#e4eef5", "#f6cf65", "#e2793b", "#8a1538")
_SHORT = {"wood": "wood", "glass": "glass", "stainless_steel": "steel", "aluminium": "Al"}


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws stability.png and stability.svg. Returns both."""
    with style(), mpl.rc_context({"font.size": 8.5, "axes.titlesize": 9.5}):
        figure = Figure(figsize=(12.2, 10.4))
        grid = figure.add_gridspec(
            3, 4, left=0.052, right=0.985, top=0.865, bottom=0.078, wspace=0.2, hspace=0.5
        )
        figure.text(0.052, 0.965, "Where time steps of a thermal contact fail", size=17, weight="semibold")
        figure.text(
            0.052,
            0.94,
            "A warm sensor touches an object of a tenth of its conductivity and heat capacity, for good and, again, "
            "bouncing at random.",
            size=10,
        )
        for i, each in enumerate(record["maps"]):
            _panel(figure.add_subplot(grid[divmod(i, 4)]), each, record["presses"], first=i % 4 == 0)
        _legend(figure.add_subplot(grid[2, 2:]), record["kinds"])
        figure.text(0.052, 0.016, footnote, size=7, color=FAINT)
        return save_figure(figure, folder / "stability", 120)


def _panel(axes: Axes, each: Record, presses: Record, first: bool) -> None:
    x, y = np.array(each["x"]), np.array(each["y"])
    axes.pcolormesh(
        _edges(x),
        _edges(y),
        each["kind"],
        cmap=ListedColormap(COLORS),
        vmin=-0.5,
        vmax=3.5,
        rasterized=True,
    )
    axes.set(xscale="log", yscale="log", xlim=x[[0, -1]], ylim=y[[0, -1]])
    axes.minorticks_off()
    axes.spines[["top", "right"]].set_visible(True)
    package_scheme = each["scheme"].startswith("ours")
    if package_scheme:
        for spine in axes.spines.values():
            spine.set(color="#1d4f91", linewidth=1.8)
    axes.set_title(each["title"], pad=29, color="#1d4f91" if package_scheme else INK)
    axes.text(
        0, 1.025, each["note"], transform=axes.transAxes, size=8, color=INK, va="bottom", linespacing=1.15
    )
    series = each["scheme"] == "series"
    axes.set_xlabel(each["axes"][0] if series else "Fourier number α dt/dx²", labelpad=1, size=8)
    if first or series:
        axes.set_ylabel(each["axes"][1], labelpad=0, size=8)
    axes.tick_params(labelsize=7.5, length=2.5)
    for line in each["limits"]:
        axes.plot(line["x"], line["y"], color=INK, lw=1.4)
        at_x, at_y = line["label"]
        axes.text(at_x, at_y, line["name"], size=8, color=INK, style="italic", va="bottom")
    if not series:
        _presses(axes, presses, labels=each["scheme"] == "ours")


def _presses(axes: Axes, presses: Record, labels: bool) -> None:
    """Where a press computed on cells of 0.1 mm in steps of 20 ms would lie."""
    for name, press in presses.items():
        fourier, (low, middle, high) = press["fourier"], press["stiffness"]
        axes.plot([fourier] * 2, [low, high], color=INK, lw=0.9, alpha=0.75)
        axes.plot(fourier, middle, "o", ms=3.6, mfc="white", mec=INK, mew=0.9)
        if labels:
            axes.annotate(
                _SHORT[name],
                (fourier, high),
                xytext=(0, 3),
                textcoords="offset points",
                size=7.4,
                ha="center",
            )


def _legend(axes: Axes, kinds: list[str]) -> None:
    axes.set_axis_off()
    axes.set(xlim=(0, 2), ylim=(0, 1))
    meanings = (
        "stable, every temperature within the initial range",
        "rings: the gap between the faces grows, or turns around",
        "leaves the initial range by more than 0.1 % (the series: is that far off)",
        "blows up",
    )
    assert len(meanings) == len(kinds)
    for i, (color, name) in enumerate(zip(COLORS, meanings, strict=True)):
        y = 0.95 - 0.125 * i
        axes.add_patch(Rectangle((0, y - 0.04), 0.09, 0.08, facecolor=color, edgecolor=FAINT, lw=0.6))
        axes.text(0.14, y, name, va="center", size=9.5)
    axes.plot([0.0, 0.09], [0.45, 0.45], color=INK, lw=1.4)
    axes.plot([0.045, 0.045], [0.15, 0.29], color=INK, lw=0.9)
    axes.plot(0.045, 0.22, "o", ms=4.5, mfc="white", mec=INK, mew=0.9)
    for y, line in (
        (0.45, "theory: λ largest rate of the contact, Y admittance of a body at z = -1,"),
        (0.365, "w what the flux at a step's begin leaves on a face, β stiffness"),
        (0.24, "a press in steps of 20 ms on cells of 0.1 mm, h = 10³, 10⁴, 10⁵ W/(m² K),"),
        (0.155, "from left to right wood, glass, stainless steel, aluminium"),
    ):
        axes.text(0.14, y, line, va="center", size=9.5)


def _edges(centres: np.ndarray) -> np.ndarray:
    """Borders of pixels evenly spaced in the logarithm."""
    log = np.log(centres)
    half = (log[1] - log[0]) / 2
    return np.exp(np.append(log - half, log[-1] + half))
