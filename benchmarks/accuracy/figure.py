"""Work against precision, one panel a material: computing time across, error up, the best toward the lower left."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thermograsp.bench.kinds import Record
from thermograsp.figures import FAINT, Label, coloured_key, place_labels, readable, save_figure, style

OURS, FORMS, GRIDS, PLAIN, ELEMENTS, COLUMN, FIPY = (
    "#1d4f91",
    "#0f8a8a",
    "#7b3fa0",
    "#b5651d",
    "#2e7d32",
    "#8a6d3b",
    "#b3266b",
)
_LOOKS = {
    "auto": (OURS, "o", ""),
    "network": (OURS, ".", "network"),
    "lumped": (FORMS, "D", "lumped"),
    "half_space": (FORMS, "D", "half spaces"),
    "closed_form": (FORMS, "D", "closed form"),
    "layered": (FORMS, "D", "layered 1-D"),
    "axisymmetric": (GRIDS, "s", "graded grid r, z"),
    "grid_3d": (GRIDS, "s", "graded grid 3-D"),
    "FTCS": (PLAIN, "v", "FTCS"),
    "backward Euler": (PLAIN, "^", "backward Euler"),
    "Crank-Nicolson": (PLAIN, "<", "Crank-Nicolson"),
    "BDF": (PLAIN, "P", "scipy BDF"),
    "Radau": (PLAIN, "X", "scipy Radau"),
    "LSODA": (PLAIN, ">", "scipy LSODA"),
    "1-D Crank-Nicolson": (COLUMN, "<", "1-D Crank-Nicolson"),
    "1-D FTCS": (COLUMN, "v", "1-D FTCS"),
    "1-D BDF": (COLUMN, "P", "1-D BDF"),
    "FiPy": (FIPY, "d", "FiPy"),
    "finite elements": (ELEMENTS, "h", "3-D elements"),
}


_GROUPS = (
    (OURS, "rings: auto, dots: other networks"),
    (FORMS, "closed forms and 1-D rungs"),
    (GRIDS, "thermograsp's graded grids"),
    (PLAIN, "uniform grid in r and z, cells of 1, 0.5, 0.25, 0.125 mm"),
    (COLUMN, "the same in z alone"),
    (FIPY, "FiPy on that grid, backward Euler"),
    (ELEMENTS, "scikit-fem, a quarter"),
    ("#8fb3dc", "band: nothing is both cheaper and better"),
)


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws accuracy (T mode) and accuracy_o (O mode), as .png and .svg. Returns all."""
    stems = {"T": "accuracy", "O": "accuracy_o"}
    return [
        file
        for mode, stem in stems.items()
        for file in _draw_mode(
            folder / stem, [p for p in record["points"] if p["mode"] == mode], mode, footnote
        )
    ]


def _draw_mode(stem: Path, shown: Sequence[Record], mode: str, footnote: str) -> list[Path]:
    names = list(dict.fromkeys(point["material"] for point in shown))
    across = min(len(names), 2)
    down = -(-len(names) // across)
    with style(), mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(13.8, 4.75 * down + 1.45), dpi=110)
        grid = figure.subplots(down, across, squeeze=False, sharex=True, sharey=True)
        height = 4.75 * down + 1.45
        figure.subplots_adjust(
            left=0.055, right=0.988, top=1 - 1.72 / height, bottom=0.8 / height, wspace=0.05, hspace=0.24
        )
        kind = "element on the thermostat" if mode == "T" else "element on the object"
        figure.text(
            0.055,
            1 - 0.4 / height,
            f"What a kelvin of accuracy costs ({mode} mode, {kind})",
            size=16,
            weight="semibold",
        )
        figure.text(
            0.055,
            1 - 0.68 / height,
            "Temperature drop every 20 ms of an 8 s press, 12 K apart, h = 10⁴ W/(m² K); error against the "
            "3-D semi-analytic solution.",
            size=10.5,
        )
        coloured_key(figure, _GROUPS, 0.055, 1 - 0.95 / height, 0.2 / height)
        low = 10 ** np.floor(np.log10(min(p["seconds_per_second"] for p in shown)))
        high = 2 * max(p["seconds_per_second"] for p in shown)
        errors = [p["error_K"] for p in shown]
        for axes in grid.flat:
            axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(0.6 * min(errors), 2 * max(errors)))
        for i, name in enumerate(names):
            _panel(grid.flat[i], name, [p for p in shown if p["material"] == name], i >= len(names) - across)
        for row in grid:
            row[0].set_ylabel("largest error from 0.05 s on (K)")
        figure.text(0.055, 0.12 / height, footnote, size=7, color=FAINT)
        return save_figure(figure, stem, 110)


def _panel(axes: Axes, name: str, points: Sequence[Record], bottom: bool) -> None:
    axes.grid(color="#eef0f3", lw=0.7)
    axes.set_axisbelow(True)
    axes.set_title(readable(name), pad=20)
    best = next(p for p in points if p["ratio"] == 1.0)
    top = axes.secondary_xaxis(
        "top",
        functions=(
            lambda x: np.asarray(x) / best["seconds_per_second"],
            lambda r: np.asarray(r) * best["seconds_per_second"],
        ),
    )
    top.spines["top"].set_visible(False)
    top.tick_params(labelsize=7.5, length=2, pad=1)
    top.xaxis.set_major_formatter(lambda value, _: f"{value:g}x" if value >= 1 else "")
    front = sorted((p for p in points if p["pareto"]), key=lambda p: p["seconds_per_second"])
    axes.plot(
        [front[0]["seconds_per_second"], *(p["seconds_per_second"] for p in front), axes.get_xlim()[1]],
        [axes.get_ylim()[1], *(p["error_K"] for p in front), front[-1]["error_K"]],
        drawstyle="steps-post",
        color="#c9dcf2",
        lw=6,
        solid_capstyle="butt",
        solid_joinstyle="miter",
        zorder=1,
    )
    labels = []
    for family, (color, marker, label) in _LOOKS.items():
        chain = [p for p in points if p["method"] == family]
        if not chain:
            continue
        x, y = [p["seconds_per_second"] for p in chain], [p["error_K"] for p in chain]
        auto = family == "auto"
        axes.plot(
            x,
            y,
            marker=marker,
            color=color,
            ms=8 if auto else 5,
            mfc="white" if auto else color,
            mew=1.8 if auto else 0,
            lw=1.6 if auto else 0.0 if family == "network" else 0.9,
            alpha=1 if color in (OURS, FORMS) else 0.9,
            zorder=4 if auto else 3,
        )
        if auto:
            for p in chain:
                labels.insert(
                    0,
                    Label(
                        p["seconds_per_second"], p["error_K"], f"auto {p['setting']}", color, 8.5, "semibold"
                    ),
                )
        elif family not in ("network", "1-D FTCS", "1-D BDF"):
            end = chain[-1] if family not in ("FTCS", "LSODA") else chain[0]
            text = "1-D grid" if family == "1-D Crank-Nicolson" else label
            labels.append(Label(end["seconds_per_second"], end["error_K"], text, color))
    # chains are obstacles along their lines, not only at their points
    avoid = []
    for family in _LOOKS:
        chain = [p for p in points if p["method"] == family]
        for a, b in zip(chain, chain[1:] or chain, strict=False):
            for w in np.linspace(0, 1, 8):
                avoid.append(
                    (
                        a["seconds_per_second"] ** (1 - w) * b["seconds_per_second"] ** w,
                        a["error_K"] ** (1 - w) * b["error_K"] ** w,
                    )
                )
    place_labels(axes, labels, np.array(avoid))
    if bottom:
        axes.set_xlabel("CPU time per second of contact (s); above: over the network that auto 0.03 K takes")
