"""A figure of a real grasp beside the simulated one: voltage, force and opening."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from thermograsp.figures.look import FAINT, INK, style
from thermograsp.files import atomic_write

_PANELS = (
    ("voltage_{side}_V", 1e3, "voltage (mV)"),
    ("force_{side}_N", 1.0, "normal force (N)"),
    ("opening_m", 1e3, "opening (mm)"),
)


def plot_beside(path: str | os.PathLike[str], columns: Mapping[str, np.ndarray], title: str) -> None:
    """Draws to a file whose suffix says in which format. columns: of twin.beside.Beside."""
    time = columns["time_s"]
    with style():
        figure = Figure(figsize=(7.2, 6.4), layout="constrained")
        panels = figure.subplots(len(_PANELS), 1, sharex=True)
        for axes, (name, factor, label) in zip(panels, _PANELS, strict=True):
            for k, side in enumerate(("left", "right") if "{side}" in name else ("",)):
                column, fade = name.format(side=side), 1 - 0.5 * k
                axes.plot(time, factor * columns[column], color=FAINT, lw=2.6, alpha=fade)
                simulated = factor * columns[f"simulated_{column}"]
                axes.plot(time, simulated, color=INK, lw=1.0, ls="--", alpha=fade)
            axes.set_ylabel(label)
        panels[-1].set_xlabel("time (s)")
        figure.suptitle(f"{title}: measured (solid), simulated (dashed)", x=0.01, ha="left")
        with atomic_write(path) as temporary:
            figure.savefig(temporary)
