"""A figure of measured touches beside the predicted ones."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thermograsp.figures.look import FAINT, INK, label_ends, ordered_colors, readable, style
from thermograsp.files import atomic_write
from thermograsp.thermal.measured import Recordings, drops_of


def plot_validation(
    path: str | os.PathLike[str],
    parts: Sequence[tuple[str, Recordings, np.ndarray]],
    title: str,
) -> None:
    """Draws to a file whose suffix says in which format. parts: a name, touches and their predicted curves (B, n) °C,
    a column each: mean drops with one standard deviation of the touches, and below what the prediction is off."""
    labels = sorted({label for _, recordings, _ in parts for label in recordings.labels})
    last = {
        label: max(r.drops[r.label == label][:, -1].mean() for _, r, _ in parts if label in r.labels)
        for label in labels
    }
    colors = dict(
        zip(sorted(labels, key=lambda label: last[label]), ordered_colors(len(labels)), strict=True)
    )
    with style():
        figure = Figure(figsize=(4.3 * len(parts) + 0.8, 5.6), layout="constrained")
        axes = figure.subplots(2, len(parts), sharex=True, sharey="row", squeeze=False, height_ratios=(2, 1))
        for column, (name, recordings, curves) in enumerate(parts):
            above, below = axes[:, column]
            _draw(above, below, recordings, drops_of(recordings, curves), colors)
            above.set_title(name)
            below.set_xlabel("time after the touch (s)")
        axes[0, 0].set_ylabel("drop of temperature (K)")
        axes[1, 0].set_ylabel("measured less\npredicted (K)")
        figure.suptitle(
            f"{title}: measured (solid, shaded: one standard deviation of the touches), predicted (dashed)",
            x=0.01,
            ha="left",
            size=9.5,
            color=INK,
        )
        figure.draw_without_rendering()
        for column, (_, recordings, _) in enumerate(parts):
            ends = [recordings.drops[recordings.label == label][:, -1].mean() for label in recordings.labels]
            label_ends(
                axes[0, column],
                recordings.t[-1],
                ends,
                [readable(label) for label in recordings.labels],
                [colors[label] for label in recordings.labels],
            )
        with atomic_write(path) as temporary:
            figure.savefig(temporary)


def _draw(
    above: Axes, below: Axes, recordings: Recordings, predicted: np.ndarray, colors: dict[str, str]
) -> None:
    t, measured = recordings.t[recordings.start :], recordings.drops
    below.axhline(0.0, color=FAINT, lw=0.8)
    for label in recordings.labels:
        of_label = recordings.label == label
        mean, spread = measured[of_label].mean(axis=0), measured[of_label].std(axis=0)
        above.fill_between(t, mean - spread, mean + spread, color=colors[label], alpha=0.2, lw=0)
        above.plot(t, mean, color=colors[label])
        above.plot(t, predicted[of_label].mean(axis=0), color=INK, lw=1.0, ls="--")
        below.plot(t, (measured - predicted)[of_label].T, color=colors[label], lw=0.4, alpha=0.25)
        below.plot(t, mean - predicted[of_label].mean(axis=0), color=colors[label])
    above.set_xlim(t[0], t[-1] + 0.14 * (t[-1] - t[0]))
