"""The paper's figures 3, 5 and 6, drawn from arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from thermograsp.figures import (
    FAINT,
    INK,
    PALE,
    TEMPERATURE_MAP,
    label_ends,
    ordered_colors,
    readable,
    style,
)
from thermograsp.files import atomic_write
from thermograsp.reports.paper.band_figure import bands_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from thermograsp.reports.paper.claim import Claim
    from thermograsp.reports.paper.runs import PaperRuns, Section
    from thermograsp.reports.paper.sweeps import Sweep

FORMATS = ("svg", "png")
_TITLES = {"O": "O mode: element on the object", "T": "T mode: element on the thermostat"}
_SHOWN = (0.009, 0.0105)  # m, half width and depth of the sections drawn
_DEEPEST = 0.013  # m, of the profiles
_START = 2.0  # s, drawn by themselves
_ISOTHERMS = (24.1, 24.5, 26.0, 28.0, 30.0, 32.0, 34.0)  # °C
_LIMITS = (24.0, 36.0)  # °C


def draw_paper(
    folder: Path, runs: PaperRuns, claims: Sequence[Claim], materials: Sequence[str]
) -> list[Path]:
    """Writes figure_3, figure_5, figure_6 and figure_6_bands in FORMATS to the folder; the files' paths."""
    written = []
    with style():
        figures = {
            "figure_3": sections_figure(runs, materials),
            "figure_5": curves_figure(runs.smooth, materials),
            "figure_6": contact_figure(runs.smooth, runs.rough, materials),
            "figure_6_bands": bands_figure(runs, claims, materials),
        }
        for name, figure in figures.items():
            for kind in FORMATS:
                written.append(folder / f"{name}.{kind}")
                _save(written[-1], figure)
    return written


def _save(path: str | os.PathLike[str], figure: Figure) -> None:
    suffix = Path(path).suffix
    metadata = {"Date": None} if suffix == ".svg" else {}  # the same numbers give the same file
    with atomic_write(path) as temporary:
        figure.savefig(temporary, metadata=metadata)


def curves_figure(sweeps: Mapping[str, Sweep], materials: Sequence[str]) -> Figure:
    """Figure 5: the drop over time at a smooth contact; for each mode the first 2 s and the whole."""
    figure = Figure(figsize=(14, 5.4))
    figure.text(0.045, 0.935, "Ten materials, smooth contact (10 000 W/m²K)", size=14, weight="semibold")
    colors = ordered_colors(len(materials))
    for mode, left in (("O", 0.045), ("T", 0.535)):
        sweep = sweeps[mode]
        first, whole = (
            figure.add_axes((left + x, 0.115, width, 0.7)) for x, width in ((0, 0.1), (0.125, 0.25))
        )
        for axes in (first, whole):
            for row, color in zip(sweep.drop, colors, strict=True):
                axes.plot(sweep.t, row, color=color, zorder=2.5)
                peak = int(row.argmax())
                marked = axes is whole or sweep.t[peak] <= _START
                if marked:
                    axes.plot(
                        sweep.t[peak], row[peak], "o", ms=4.4, mfc="white", mec=color, mew=1.2, zorder=5
                    )
            _dress(axes, sweep)
        first.set(xlim=(0, _START), xticks=(0, 1, 2), ylabel="temperature drop (K)", xlabel="first 2 s")
        first.set_title(_TITLES[mode])
        whole.set(yticklabels=(), xlabel="time after the touch (s)")
        label_ends(whole, sweep.t[-1], sweep.drop[:, -1], [readable(m) for m in materials], colors)
        _note(whole, "circles: peaks")
    return figure


def contact_figure(
    smooth: Mapping[str, Sweep], rough: Mapping[str, Sweep], materials: Sequence[str]
) -> Figure:
    """Figure 6: the same with the contact resistance of rough faces, the smooth curves pale behind."""
    figure = Figure(figsize=(14, 5.4))
    title = "Rough faces (5 µm rms, 10 kPa): the gap makes every curve slower and lower"
    figure.text(0.045, 0.935, title, size=14, weight="semibold")
    colors = ordered_colors(len(materials))
    for mode, left in (("O", 0.045), ("T", 0.535)):
        axes, sweep = figure.add_axes((left, 0.115, 0.375, 0.7)), rough[mode]
        for row, before, color in zip(sweep.drop, smooth[mode].drop, colors, strict=True):
            axes.plot(sweep.t, before, color=color, lw=0.9, alpha=0.4)
            axes.plot(sweep.t, row, color=color, zorder=2.5)
        _dress(axes, sweep)
        axes.set_title(_TITLES[mode])
        axes.set(ylabel="temperature drop (K)", xlabel="time after the touch (s)")
        label_ends(axes, sweep.t[-1], sweep.drop[:, -1], [readable(m) for m in materials], colors)
        low, high = (
            f"{h:,.0f}".replace(",", " ") for h in (sweep.conductance.min(), sweep.conductance.max())
        )
        _note(axes, f"bold: rough, {low if low == high else f'{low} to {high}'} W/m²K   pale: smooth")
    return figure


def sections_figure(runs: PaperRuns, materials: Sequence[str]) -> Figure:
    """Figure 3: sections through element and object at one moment, a column a material, and the profiles below."""
    count = len(materials)
    colors = ordered_colors(count)
    figure = Figure(figsize=(14, 8.1))
    grid = figure.add_gridspec(
        2, count, left=0.055, right=0.93, top=0.845, bottom=0.575, hspace=0.12, wspace=0.07
    )
    for i, mode in enumerate(("O", "T")):
        for j, name in enumerate(materials):
            axes = figure.add_subplot(grid[i, j])
            _draw_section(axes, runs.sections[mode][j])
            if i == 0:
                axes.set_title(readable(name), loc="center", color=colors[j], size=10, pad=6)
            if j == 0:
                axes.set_ylabel(f"{mode} mode", weight="semibold", labelpad=8)
    _color_bar(figure, (0.945, 0.595, 0.01, 0.23))
    for mode, left in (("O", 0.055), ("T", 0.535)):
        axes = figure.add_axes((left, 0.075, 0.325, 0.415))
        _draw_profiles(axes, mode, runs.sections[mode], materials, colors)
    figure.text(0.055, 0.955, "Where the 12 K lie, 4 s after the touch", size=14, weight="semibold")
    figure.text(
        0.055,
        0.922,
        "Sections through thermostat, element (framed, 9 mm wide) and object; isotherms every 2 K and at 24.1 and 24.5 "
        "°C. As effusivity falls the difference moves from the element into the object.",
        color=FAINT,
    )
    return figure


def _draw_section(axes: Axes, section: Section) -> None:
    width, depth = (1e3 * x for x in _SHOWN)
    for half in (section.body, section.element):
        edges = 1e3 * np.concatenate((-half.radius[:0:-1], half.radius))
        mirrored = np.concatenate((half.temperature[:, ::-1], half.temperature), axis=1)
        shades = {"cmap": TEMPERATURE_MAP, "vmin": _LIMITS[0], "vmax": _LIMITS[1]}
        axes.pcolormesh(edges, 1e3 * half.depth, mirrored, rasterized=True, **shades)
        if half is section.body:
            middles = [(x[1:] + x[:-1]) / 2 for x in (edges, 1e3 * half.depth)]
            axes.contour(*middles, mirrored, levels=_ISOTHERMS, colors="white", linewidths=0.5, alpha=0.65)
    rim, height = 1e3 * section.element.radius[-1], 1e3 * section.element.depth[-1]
    axes.add_patch(Rectangle((-rim, 0), 2 * rim, height, fill=False, ec="white", lw=2.0, zorder=3))
    axes.add_patch(Rectangle((-rim, 0), 2 * rim, height, fill=False, ec=INK, lw=0.9, zorder=4))
    axes.add_patch(Rectangle((-rim - 1, -0.9), 2 * rim + 2, 0.9, fc="#c9ced6", ec="none", zorder=4))
    axes.set(xlim=(-width, width), ylim=(depth, -0.9), xticks=[], yticks=[], aspect="equal")
    axes.spines[:].set_visible(False)


def _color_bar(figure: Figure, place: tuple[float, float, float, float]) -> None:
    mapped = ScalarMappable(Normalize(*_LIMITS), TEMPERATURE_MAP)
    bar = figure.colorbar(mapped, cax=figure.add_axes(place), ticks=[24, 28, 32, 36])
    bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]
    bar.set_label("temperature (°C)")


def _draw_profiles(
    axes: Axes, mode: str, sections: Sequence[Section], materials: Sequence[str], colors: Sequence[str]
) -> None:
    deepest = 1e3 * _DEEPEST
    face = 1e3 * sections[0].element.depth[-1]
    axes.axvspan(0, face, color=PALE, lw=0, zorder=0)
    for section, color in zip(sections, colors, strict=True):
        depth, level = [], []
        for half in (section.element, section.body):
            depth.append(1e3 * (half.depth[1:] + half.depth[:-1]) / 2)
            level.append(half.levels)
        depth.append(1e3 * section.body.depth[-1:])  # the far face is adiabatic: as warm as the last cell
        level.append(level[-1][-1:])
        axes.plot(np.concatenate(depth), np.concatenate(level), color=color)
    axes.set(xlim=(0, deepest), ylim=(23.7, 36.6), yticks=[24, 28, 32, 36])
    axes.set_xlabel("depth below the thermostat (mm)")
    axes.set_ylabel("mean over the element's width (°C)")
    axes.set_title(_TITLES[mode])
    axes.text(face / 2, 24.0, "element", color=FAINT, ha="center", va="bottom", size=9)
    axes.text((face + deepest) / 2, 36.4, "object", color=FAINT, ha="center", va="top", size=9)
    ends = [float(section.body.levels[0]) for section in sections]
    for end, color in zip(ends, colors, strict=True):
        axes.plot([face, deepest], [end, end], color=color, lw=0.6, alpha=0.35, zorder=1)
        axes.plot([face], [end], "o", ms=3.6, color=color, zorder=6)
    shares = [
        f"{readable(m)} {100 * s.share_in_object:.0f} %" for m, s in zip(materials, sections, strict=True)
    ]
    label_ends(axes, deepest, ends, shares, colors)
    axes.text(1.045, 1.0, "share in the object", transform=axes.transAxes, color=FAINT, size=9, va="bottom")


def _dress(axes: Axes, sweep: Sweep) -> None:
    axes.set(xlim=(0, sweep.t[-1]), ylim=(0, 11.4), xticks=range(0, 21, 4), yticks=range(0, 11, 2))
    axes.grid(axis="y", color=PALE, lw=0.8)
    axes.set_axisbelow(True)


def _note(axes: Axes, text: str) -> None:
    axes.text(1.0, 1.0, text, transform=axes.transAxes, color=FAINT, size=9, ha="right", va="top")
