"""A figure of one press: temperature drop and voltage, and the two surfaces."""

from __future__ import annotations

import os

from matplotlib.figure import Figure

from thermograsp.files import atomic_write
from thermograsp.thermal import Press


def plot_press(path: str | os.PathLike[str], press: Press, title: str) -> None:
    """Draws to a file whose suffix says in which format."""
    figure = Figure(figsize=(7.2, 5.4), layout="constrained")
    drop, surfaces = figure.subplots(2, 1, sharex=True)
    drop.plot(press.t, press.temperature_drop, color="#1f6fb4", lw=1.8)
    drop.set_ylabel("temperature drop (K)")
    drop.set_title(f"{title}, rung {press.rung}", loc="left", fontsize=11)
    for values, label, colour in (
        (press.sensor_surface, "sensor", "#d1495b"),
        (press.object_surface, "object", "#3a6b8c"),
    ):
        surfaces.plot(press.t, values, color=colour, lw=1.8, label=label)
    surfaces.set_ylabel("contact surface (°C)")
    surfaces.set_xlabel("time after the touch (s)")
    surfaces.legend(frameon=False)
    for axes in (drop, surfaces):
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(alpha=0.25, lw=0.6)
    with atomic_write(path) as temporary:
        figure.savefig(temporary, dpi=160)
