"""Contact temperatures of five plates: exact, ours and a peer's, at three moments."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from thermograsp.bench.kinds import Record
from thermograsp.figures import (
    FAINT,
    INK,
    coloured_key,
    readable,
    save_figure,
    style,
)

_OURS, _PEER = "#1d4f91", "#c2571a"


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws peer.png and peer.svg. Returns both."""
    plates, times = record["plates"], record["times_s"]
    with style(), mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(10.5, 4.9), dpi=120)
        panels = figure.subplots(1, len(times), sharey=True)
        figure.subplots_adjust(left=0.06, right=0.99, top=0.74, bottom=0.19, wspace=0.08)
        figure.text(0.06, 0.93, "Contact temperature of a fingertip", size=15, weight="semibold")
        figure.text(
            0.06,
            0.875,
            f"A 16 x 16 x 10 mm tip at {record['tip_C']:g} °C on plates at {record['plate_C']:g} °C, perfect contact.",
            size=10,
        )
        words = (
            (INK, "exact, two half-spaces"),
            (_OURS, "thermograsp: dots 1-D, squares on a 40 x 40 x 10 mm plate"),
            (_PEER, "Genesis World 1.4.5, quoted"),
        )
        coloured_key(figure, words, 0.06, 0.825, 0.04)
        for i, (axes, time) in enumerate(zip(panels, times, strict=True)):
            axes.set_title(f"after {time:g} s")
            for n, touch in enumerate(plates):
                axes.plot([n, n], [touch["exact"], touch["peer"][i]], color=_PEER, lw=1, alpha=0.5)
                axes.plot([n - 0.3, n + 0.3], [touch["exact"]] * 2, color=INK, lw=1.6)
                axes.plot(n - 0.1, touch["column"][i], "o", color=_OURS, ms=5)
                axes.plot(n + 0.1, touch["slab"][i], "s", color=_OURS, ms=4.5, mfc="white", mew=1.3)
                axes.plot(n, touch["peer"][i], "X", color=_PEER, ms=7, mew=0)
                axes.annotate(
                    f"{touch['peer'][i] - touch['exact']:+.1f} K",
                    (n, touch["peer"][i]),
                    xytext=(0, 6 if touch["peer"][i] > touch["exact"] else -13),
                    textcoords="offset points",
                    ha="center",
                    size=8,
                    color=_PEER,
                )
            names = [readable(touch["plate"]).replace("stainless ", "") for touch in plates]
            axes.set_xticks(range(len(plates)), names)
            axes.set(xlim=(-0.6, len(plates) - 0.4), ylim=(record["plate_C"] - 0.5, record["tip_C"] + 1.4))
            axes.grid(axis="y", color="#eef0f3", lw=0.7)
        panels[0].set_ylabel("°C")
        figure.text(
            0.06,
            0.05,
            f"Peer's figures published by {record['published_by']}.\n"
            "Not measured again; its cells are 10 mm deep, and their mean is set against a surface.",
            size=7.5,
        )
        figure.text(0.06, 0.02, footnote, size=6.5, color=FAINT)
        return save_figure(figure, folder / "peer", 120)
