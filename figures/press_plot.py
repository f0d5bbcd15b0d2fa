"""A figure of one press: the temperature drop, and the two surfaces."""

from __future__ import annotations

import os

from matplotlib.figure import Figure

from thermograsp.figures.look import label_ends, ordered_colors, style
from thermograsp.files import atomic_write
from thermograsp.thermal import Press


def plot_press(path: str | os.PathLike[str], press: Press, title: str) -> None:
    """Draws to a file whose suffix says in which format."""
    warm, cold = ordered_colors(2)
    with style():
        figure = Figure(figsize=(7.2, 5.4), layout="constrained")
        drop, surfaces = figure.subplots(2, 1, sharex=True)
        drop.plot(press.t, press.temperature_drop, color=cold)
        drop.set(ylabel="temperature drop (K)", title=f"{title}, rung {press.rung}")
        both = (press.sensor_surface, press.object_surface)
        for values, color in zip(both, (warm, cold), strict=True):
            surfaces.plot(press.t, values, color=color)
        surfaces.set(xlabel="time after the touch (s)", ylabel="contact surface (°C)", xlim=press.t[[0, -1]])
        label_ends(surfaces, press.t[-1], [values[-1] for values in both], ("sensor", "object"), (warm, cold))
        with atomic_write(path) as temporary:
            figure.savefig(temporary)
