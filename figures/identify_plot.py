"""A figure of one identification: the voltage, the material as samples came in, and the object's effusivity."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thermograsp.figures.look import (
    FAINT,
    INK,
    label_ends,
    ordered_colors,
    readable,
    spread_out,
    style,
)
from thermograsp.files import atomic_write
from thermograsp.thermal import (
    Identification,
    Identifier,
    Material,
    TouchSetup,
)

_MOMENTS = 40
_SHOWN = 0.03  # probability that a material reaches at some time to have a curve of its own
_MOST = 6
_LINE = 120  # characters of the title that fit above the three axes


def plot_identification(
    path: str | os.PathLike[str],
    t: np.ndarray,
    voltage: np.ndarray,
    setup: TouchSetup,
    candidates: Sequence[Material],
    touch: float | None,
) -> None:
    """Draws to a file whose suffix says in which format. t: (n,) s, voltage: (n, F) V; the others as of Identifier."""
    identifier = Identifier(setup, candidates, touch=touch)
    moments, found = [], []
    for part in np.array_split(np.arange(len(t)), min(_MOMENTS, len(t))):
        found.append(identifier.update(t[part], voltage[part]))
        moments.append(t[part[-1]])
    with style():
        figure = Figure(figsize=(11.5, 3.9), layout="constrained")
        curve, chance, density = figure.subplots(1, 3, width_ratios=(1, 1.15, 1))
        title(figure, found[-1].message)
        _voltage(curve, t, voltage, found[-1])
        _chance(chance, np.array(moments), found, candidates)
        _effusivity(density, found[-1], candidates)
        with atomic_write(path) as temporary:
            figure.savefig(temporary)


def title(figure: Figure, message: str) -> None:
    """Writes the message above the axes, a line for each of its clauses, or two for a long one."""
    lines = [textwrap.fill(clause, _LINE) for clause in message.split("; ")]
    figure.suptitle("\n".join(lines), x=0.01, ha="left", size=10.5, weight="semibold")


def _voltage(axes: Axes, t: np.ndarray, voltage: np.ndarray, last: Identification) -> None:
    for tip, values in enumerate(voltage.T):
        axes.plot(t, 1e3 * values, color=INK, lw=1.2, alpha=1 - 0.5 * tip)
    for touch in last.touch:
        if np.isfinite(touch):
            axes.axvline(touch, color=FAINT, lw=0.8, ls=":")
    axes.set(xlabel="time (s)", ylabel="voltage (mV)", title="Voltage, touch dotted")


def _chance(
    axes: Axes, moments: np.ndarray, found: Sequence[Identification], candidates: Sequence[Material]
) -> None:
    chances = np.array([one.probability for one in found])
    # among those that the last samples leave, and the most probable ones of before
    rank = np.argsort(-chances[-1] - 1e-3 * chances.max(axis=0), kind="stable")
    shown = [k for k in rank if chances[:, k].max() > _SHOWN][:_MOST] or rank[:1].tolist()
    shown.sort(key=lambda k: candidates[k].effusivity)
    axes.set(
        xlabel="time (s)",
        ylabel="probability",
        ylim=(0, 1.05 * chances.max()),
        xlim=(moments[0], moments[-1]),
    )
    colors = ordered_colors(len(shown))
    for k, color in zip(shown, colors, strict=True):
        axes.plot(moments, chances[:, k], color=color)
    names = [readable(candidates[k].name) for k in shown]
    label_ends(axes, moments[-1], chances[-1, shown], names, colors, size=8.5)
    axes.set_title("Material, as samples came in")


def _effusivity(axes: Axes, last: Identification, candidates: Sequence[Material]) -> None:
    posterior = last.effusivity
    low, high = posterior.interval()
    inside = (posterior.effusivity >= low) & (posterior.effusivity <= high)
    axes.plot(posterior.effusivity, posterior.density, color=INK, lw=1.4)
    axes.fill_between(posterior.effusivity[inside], posterior.density[inside], color=INK, alpha=0.15, lw=0)
    begin, end = posterior.quantiles([0.0005, 0.9995])
    top = float(posterior.density.max())
    axes.set(xscale="log", xlim=(begin / 1.05, end * 1.05), ylim=(0, 2.0 * top), yticks=[])
    ticks = [one * 10**power for power in range(6) for one in (1, 1.5, 2, 3, 4, 5, 7)]
    ticks = [tick for tick in ticks if begin <= tick <= end]
    if len(ticks) > 7:
        ticks = [tick for tick in ticks if f"{tick:.0e}"[0] in "125" and f"{tick:g}"[1:2] != "5"]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    names = last.likely(0.99)[:_MOST]
    named = [one for one in candidates if one.name in names and begin <= one.effusivity <= end]
    named.sort(key=lambda one: one.effusivity)
    width = np.log(end / begin)
    at = np.log([one.effusivity for one in named])
    for one, place in zip(
        named, np.exp(spread_out(at, 0.05 * width, np.log(begin), np.log(end))), strict=True
    ):
        axes.plot([one.effusivity, one.effusivity, place], [0, 1.06 * top, 1.12 * top], color=FAINT, lw=0.8)
        axes.text(place, 1.14 * top, readable(one.name), size=8.5, rotation=90, ha="center", va="bottom")
    axes.spines["left"].set_visible(False)
    axes.set(xlabel="effusivity (W s$^{0.5}$/(m² K))", title="Effusivity, 90 % shaded")
