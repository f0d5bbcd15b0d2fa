"""Work against precision of a grasp, one panel an error: cost across, error up, the best toward the lower left."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from thermograsp.bench.kinds import Record
from thermograsp.figures import FAINT, Label, coloured_key, place_labels, save_figure, style

OURS, EULER, FAST, CONE, SQUARE, SOLVER, SOFT, OTHER = (
    "#1d4f91", "#b5651d", "#c0392b", "#0f8a8a", "#7b3fa0", "#8a6d3b", "#2e7d32", "#5b6470"
)  # fmt: skip
_LOOKS = {
    "time step": (OURS, "o"),
    "Euler": (EULER, "^"),
    "implicitfast": (FAST, "v"),
    "RK4": (OTHER, "P"),
    "elliptic cone": (CONE, "s"),
    "pyramidal cone": (SQUARE, "D"),
    "noslip": (OTHER, "X"),
    "Newton": (SOLVER, "<"),
    "CG": (SOLVER, "h"),
    "PGS": (SOLVER, "p"),
    "contact time": (SOFT, "d"),
    "discrete": (OTHER, "*"),
}
_KEY = (
    (OURS, "ring: shipped; dots: other time steps"),
    (EULER, "Euler"),
    (FAST, "implicitfast"),
    (CONE, "elliptic cone, other impratio"),
    (SQUARE, "pyramidal cone"),
    (SOLVER, "solver and iterations"),
    (SOFT, "softness of contacts"),
    (OTHER, "RK4, noslip, others"),
    ("#8fb3dc", "band: nothing is both cheaper and better"),
)
_PANELS = (
    ("slip_mm", "Slip", "largest slip while held and shaken (mm)"),
    ("force_N", "Force against the command", "RMS error of the normal force (N)"),
    ("force_reference_N", "Force against the reference run", "RMS error of the normal force (N)"),
    ("jitter_um", "Jitter of the contact", "RMS scatter of its centroid in 20 ms (µm)"),
    ("drop_K", "Temperature drop", "largest error from 0.05 s on, median (K)"),
)
_COURSE = "An object of aluminium is closed on with 10 N, lifted, shaken at 4 Hz and held"
_COST = "cost: CPU time over that of what is shipped"
_WORDS = {"breaks down": "breaks"}
_FATE_COLORS = {"jams": "#c58b00", "dropped": "#c8571b", "ejected": "#a3262a", "breaks down": "#4a1942"}
_HELD = "held"
_BAND = "#c9dcf2"
_SLIPS = 1.0  # mm, from which a held object is marked as slipping


def draw(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Draws grasp (the worst of the shapes, and what fails) and grasp_shapes, as .png and .svg. Returns all."""
    return [*_draw_worst(record, folder, footnote), *_draw_shapes(record, folder, footnote)]


def _draw_worst(record: Record, folder: Path, footnote: str) -> list[Path]:
    points, reference = record["points"], record["reference"]
    with style(), mpl.rc_context({"font.size": 9.5}):
        figure, grid = _page(
            3,
            "What it costs to hold an object well",
            f"{_COURSE}: the worst of box, cylinder, sphere and mesh.\n"
            f"Reference run: time step {1e3 * reference['timestep']:g} ms. Slip needs none: nothing should slip.",
            footnote,
        )
        for axes, (metric, title, label) in zip(grid.flat, _PANELS, strict=False):
            value = partial(_of_worst, metric=metric)
            _panel(axes, points, value, title, [value(p) for p in points])
            axes.set_ylabel(label)
        for axes in (grid[2, 0], grid[1, 1]):
            axes.set_xlabel(_COST)
        _failures(grid[2, 1], points, record["shape_names"])
        return save_figure(figure, folder / "grasp", 110)


def _draw_shapes(record: Record, folder: Path, footnote: str) -> list[Path]:
    """Slip and error of the temperature drop, shape by shape."""
    points, shapes = record["points"], record["shape_names"]
    with style(), mpl.rc_context({"font.size": 9.5}):
        figure, grid = _page(
            len(shapes),
            "What it costs to hold an object well, by shape",
            f"{_COURSE}.\nThe mesh is a hexagonal nut with its flats to the pads.",
            footnote,
        )
        for column, (metric, title, label) in zip(grid.T, (_PANELS[0], _PANELS[4]), strict=True):
            every = [_of_shape(p, shape, metric) for p in points for shape in shapes]
            for axes, shape in zip(column, shapes, strict=True):
                value = partial(_of_shape, shape=shape, metric=metric)
                _panel(axes, points, value, f"{title}, {shape}", every)
                axes.set_ylabel(label)
            column[-1].set_xlabel(_COST)
        return save_figure(figure, folder / "grasp_shapes", 110)


def _of_shape(point: Record, shape: str, metric: str) -> float:
    return _number(point["shapes"][shape][metric])


def _of_worst(point: Record, metric: str) -> float:
    return _number(point["worst"][metric])


def _number(value: float | None) -> float:
    return np.nan if value is None else value


def _page(down: int, title: str, subtitle: str, footnote: str) -> tuple[Figure, np.ndarray]:
    """A page of two columns, narrow enough to be read in a README."""
    height = 3.75 * down + 2.6
    figure = Figure(figsize=(10.5, height), dpi=110)
    grid = figure.subplots(down, 2, squeeze=False)
    figure.subplots_adjust(
        left=0.075, right=0.985, top=1 - 2.15 / height, bottom=0.8 / height, wspace=0.2, hspace=0.24
    )
    figure.text(0.06, 1 - 0.45 / height, title, size=17, weight="semibold")
    figure.text(0.06, 1 - 0.97 / height, subtitle, size=11, linespacing=1.35)
    coloured_key(figure, _KEY, 0.06, 1 - 1.27 / height, 0.21 / height)
    figure.text(0.06, 0.15 / height, footnote, size=7, color=FAINT)
    return figure, grid


def _panel(
    axes: Axes,
    points: Sequence[Record],
    value: Callable[[Record], float],
    title: str,
    every: Sequence[float],
) -> None:
    """One error of all points that hold. every: values that the vertical axis must span."""
    held = [p for p in points if np.isfinite(value(p))]
    axes.grid(color="#eef0f3", lw=0.7)
    axes.set_axisbelow(True)
    axes.set_title(title)
    costs = [p["ratio"] for p in held]
    axes.set(xscale="log", yscale="log")
    axes.set_xlim(0.75 * min(costs), 1.35 * max(costs))
    axes.set_ylim(0.6 * float(np.nanmin(every)), 2.0 * float(np.nanmax(every)))
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(lambda x, _: f"{x:g}x")
    axes.xaxis.set_minor_locator(NullLocator())
    best = front(held, value)
    axes.plot(
        [best[0]["ratio"], *(p["ratio"] for p in best), axes.get_xlim()[1]],
        [axes.get_ylim()[1], *(value(p) for p in best), value(best[-1])],
        drawstyle="steps-post",
        color=_BAND,
        lw=6,
        solid_capstyle="butt",
        solid_joinstyle="miter",
        zorder=1,
    )
    shipped = next(p for p in points if p["family"] == "shipped")
    labels = [Label(shipped["ratio"], value(shipped), "shipped", OURS, 10.0, "bold")]
    for family, (color, marker) in _LOOKS.items():
        chain = [p for p in held if p["family"] == family]
        axes.plot(
            [p["ratio"] for p in chain],
            [value(p) for p in chain],
            marker,
            color=color,
            ms=5,
            mew=0,
            zorder=3,
            alpha=0.95,
        )
        labels += [Label(p["ratio"], value(p), _short(p), color, 8.5) for p in chain]
    axes.plot(shipped["ratio"], value(shipped), "o", ms=10, mfc="white", mec=OURS, mew=2.2, zorder=4)
    place_labels(axes, _thinned(axes, labels), np.array([[p["ratio"], value(p)] for p in held]))


def front(points: Sequence[Record], value: Callable[[Record], float]) -> list[Record]:
    """Points whose grasps all hold and than which none is both cheaper and better in `value`, cheapest first."""
    best: list[Record] = []
    for point in sorted(points, key=lambda p: (p["ratio"], value(p))):
        if np.isfinite(value(point)) and (not best or value(point) < value(best[-1])):
            best.append(point)
    return best


def _short(point: Record) -> str:
    family, label = point["family"], point["label"]
    if family == "time step":
        return label
    label = label.replace(" iterations", " it.").replace(" iteration", " it.").replace("impratio ", "")
    names = {"elliptic cone": "impratio", "pyramidal cone": "pyramidal", "contact time": "contact"}
    return f"{names.get(family, family)} {label}"


def _thinned(axes: Axes, labels: Sequence[Label]) -> list[Label]:
    """Without those whose points lie on top of one that is labelled already."""
    kept: list[Label] = []
    spots: list[np.ndarray] = []
    for label in labels:
        spot = axes.transData.transform((label.x, label.y))
        if all(np.linalg.norm(spot - other) > 20 for other in spots):
            kept.append(label)
            spots.append(spot)
    return kept


def _failures(axes: Axes, points: Sequence[Record], shapes: Sequence[str]) -> None:
    """A table of variants that lose or badly slip a shape, and of what is shipped."""
    axes.set_axis_off()
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.text(-0.06, 1.04, "What fails (mm: slips that far)", size=11, weight="semibold")
    shipped = next(p for p in points if p["family"] == "shipped")
    failing = [p for p in points if p["worst"]["fate"] != _HELD or p["worst"]["slip_mm"] > _SLIPS]
    rows = [shipped, *sorted(failing, key=lambda p: p["family"])]
    rows += [p for p in points if p["family"] == "discrete"]
    step = min(0.075, 0.92 / (len(rows) + 1))
    columns = np.linspace(0.53, 0.96, len(shapes))
    for x, shape in zip(columns, shapes, strict=True):
        axes.text(x, 0.97, shape, size=8.5, ha="center", weight="semibold")
    for i, point in enumerate(rows):
        y = 0.97 - (i + 1) * step
        name = "shipped" if point is shipped else f"{point['family']}, {point['label']}"
        axes.text(-0.06, y, name, size=8.5, va="center", weight="semibold" if point is shipped else "normal")
        for x, shape in zip(columns, shapes, strict=True):
            word, color = _word(point["shapes"][shape])
            axes.text(x, y, word, size=8.5, ha="center", va="center", color=color)


def _word(errors: Record) -> tuple[str, str]:
    if errors["fate"] != _HELD:
        return _WORDS.get(errors["fate"], str(errors["fate"])), _FATE_COLORS[errors["fate"]]
    if errors["slip_mm"] > _SLIPS:
        return f"{errors['slip_mm']:.1f} mm", "#c58b00"
    return _HELD, FAINT
