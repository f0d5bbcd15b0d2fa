"""Figure 6 with the bands that the experiment's unknowns leave, and on how many rigs its statements hold."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from thermograsp.figures import FAINT, INK, PALE, ordered_colors, readable
from thermograsp.reports.paper.bands import SHARE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from thermograsp.reports.paper.claim import Claim, Support, Verdict
    from thermograsp.reports.paper.runs import PaperRuns

_VERDICTS: tuple[tuple[Verdict, str, str], ...] = (
    ("holds", "#2f8f6b", "holds"),
    ("partly", "#e3b341", "holds in part"),
    ("fails", "#c9ced6", "does not hold"),
)
_DRAWN = slice(None, None, 5)  # of the samples, in bands
_WIDEST = 84  # characters of a statement's line


def bands_figure(runs: PaperRuns, claims: Sequence[Claim], materials: Sequence[str]) -> Figure:
    """A column a material, a row a mode: the curve on the assumed rig in its band. Below, the statements on the
    experiment and the share of the rigs on which each holds."""
    figure = Figure(figsize=(14, 8.4))
    count, rigs = len(materials), len(runs.bands.rigs)
    colors = ordered_colors(count)
    grid = figure.add_gridspec(
        2, count, left=0.055, right=0.985, top=0.845, bottom=0.43, hspace=0.12, wspace=0.12
    )
    for i, mode in enumerate(("O", "T")):
        low, high = runs.bands.band(mode)
        for j, name in enumerate(materials):
            axes = figure.add_subplot(grid[i, j])
            axes.fill_between(
                runs.bands.t[_DRAWN], low[j][_DRAWN], high[j][_DRAWN], color=colors[j], alpha=0.22, lw=0
            )
            axes.plot(runs.rough[mode].t, runs.rough[mode].drop[j], color=colors[j])
            axes.set(xlim=(0, 20), ylim=(0, 11.4), xticks=(0, 10), yticks=range(0, 11, 2))
            axes.grid(axis="y", color=PALE, lw=0.8)
            axes.tick_params(labelbottom=i == 1, labelleft=j == 0)
            if i == 0:
                axes.set_title(readable(name), loc="center", color=colors[j], size=10, pad=6)
            if j == 0:
                axes.set_ylabel(f"{mode} mode, drop (K)")
    figure.text(0.52, 0.382, "time after the touch (s)", ha="center")
    figure.text(
        0.055,
        0.955,
        "The experiment, with what the paper does not say of it drawn",
        size=14,
        weight="semibold",
    )
    figure.text(
        0.055,
        0.922,
        f"Band: the middle {100 * SHARE:.0f} % of {rigs} rigs, each with a roughness, pressure, thermostat, room and "
        "air of its own.  Line: 5 µm rms, 10 kPa, 36 and 24 °C.",
        color=FAINT,
    )
    judged = [(claim, claim.support) for claim in claims if claim.support is not None]
    _draw_support(figure.add_axes((0.54, 0.06, 0.4, 0.26)), judged, rigs)
    return figure


def _draw_support(axes: Axes, judged: Sequence[tuple[Claim, Support]], rigs: int) -> None:
    for row, (claim, support) in enumerate(judged):
        start = 0.0
        for verdict, color, _ in _VERDICTS:
            share = 100 * support.counts[verdict] / rigs
            axes.barh(row, share, left=start, height=0.6, color=color)
            if share >= 4:
                axes.text(start + share / 2, row, f"{share:.0f}", ha="center", va="center", size=9, color=INK)
            start += share
        words = textwrap.fill(claim.statement, _WIDEST)
        axes.text(-1.5, row, words, ha="right", va="center", size=9)
    for at, (_, color, words) in zip((0, 10, 32), _VERDICTS, strict=True):
        axes.text(
            at, -0.6, words, size=9, weight="semibold", color=FAINT if color == _VERDICTS[-1][1] else color
        )
    axes.set(xlim=(0, 100), ylim=(len(judged) - 0.5, -0.6), yticks=[], xlabel="% of the rigs")
    axes.spines[:].set_visible(False)
