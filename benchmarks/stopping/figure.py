"""Right answers against contact time: the agent beside posteriors, and where the agent stops beside fixed times."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thermograsp.bench.kinds import Record
from thermograsp.figures import FAINT, INK, PALE, save_figure, style

_LOOKS = {
    "agent": ("#1d4f91", "trained agent", "-"),
    "identify": ("#b5651d", "thermograsp identify, any contact", "--"),
    "fitted": (INK, "posterior fitted to these contacts", ":"),
}


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws stopping.png and stopping.svg. Returns both."""
    with style(), mpl.rc_context({"font.size": 10}):
        figure = Figure(figsize=(11.0, 5.2), dpi=110)
        left, right = figure.subplots(1, 2)
        figure.subplots_adjust(left=0.07, right=0.98, top=0.78, bottom=0.17, wspace=0.22)
        figure.text(0.02, 0.92, "How soon an agent knows what it holds", size=16, weight="semibold")
        figure.text(
            0.02,
            0.865,
            f"{len(record['materials'])} materials, {record['episodes']} held-out episodes of Identify-v0.",
            size=10.5,
        )
        _windows(left, record)
        _declared(right, record)
        figure.text(0.02, 0.02, footnote, size=7, color=FAINT)
        return save_figure(figure, folder / "stopping", 110)


def _windows(axes: Axes, record: Record) -> None:
    for name, shares in record["right"].items():
        color, title, line = _LOOKS[name]
        axes.plot(
            record["contact_s"],
            [100 * each for each in shares],
            line,
            color=color,
            label=title,
            marker="o",
            ms=4.5,
        )
    axes.set(xscale="log", ylim=(0, 104), xlabel="contact time (s)", ylabel="right (%)")
    axes.set_xticks(record["windows_s"], [f"{one:g}" for one in record["windows_s"]])
    axes.minorticks_off()
    axes.grid(color=PALE, lw=0.7)
    axes.legend(frameon=False, loc="lower right", fontsize=8.5)
    axes.set_title("By contact time, from the same samples")


def _declared(axes: Axes, record: Record) -> None:
    declared, fixed = record["declared"], record["fixed"]
    last = 2 * declared["contact_s"]
    axes.plot(
        fixed["contact_s"],
        [100 * each for each in fixed["right"]],
        color=FAINT,
        marker="s",
        ms=4.5,
        label="always at the same decision",
    )
    axes.plot(
        [declared["contact_s"]],
        [100 * declared["right"]],
        "*",
        color=_LOOKS["agent"][0],
        ms=13,
        label="where the agent declares",
    )
    axes.set(xlim=(0, last), xlabel="mean contact time (s)", ylabel="right (%)")
    axes.grid(color=PALE, lw=0.7)
    axes.legend(frameon=False, loc="lower right", fontsize=8.5)
    axes.set_title("The agent decides when to stop")
