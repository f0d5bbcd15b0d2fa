"""The studio's picture as a file: the grippers with their temperatures above the curve, drawn without a display."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from thermograsp.figures import FAINT, Film, readable, strip, style, write_pictures
from thermograsp.studio.control import Choices, Controls, Stock
from thermograsp.studio.sources import SimulatedGrasp

FRAMES = 10  # a second
_COLOURS = ("#0b62a8", "#c2570c")  # of the rows, as on the page
_CURVES = 190  # pixels, their height
_DPI = 100


def record_studio(
    path: str | os.PathLike[str],
    choices: Choices,
    stock: Stock,
    seconds: float,
    advance: Callable[[float], None],
) -> None:
    """Writes a scripted grasp of the choices: an animation (.gif, .webp) or a strip of six pictures (.png). advance:
    called for every s that is done. Raises MissingDependencyError where there is no OpenGL."""
    strip_only = str(path).lower().endswith(".png")
    times = np.linspace(0.0, seconds, 6 if strip_only else max(2, round(FRAMES * seconds))).tolist()
    grasp = SimulatedGrasp(choices, stock)
    low, high = grasp.colours
    films = [Film(grasp.plant, times, row, size=(960, 720), low=low, high=high) for row in range(grasp.rows)]
    controls = Controls()
    blocks: list[np.ndarray] = []
    try:
        for _ in range(round(seconds / grasp.dt) + 1):
            for film in films:
                film.watch(grasp.time, grasp.batch)
            columns = grasp.step(controls)
            blocks.append(np.stack((columns["time_s"][0], *1e3 * columns["voltage_left_V"])))
            advance(grasp.dt)
    finally:
        for film in films:
            film.close()
        grasp.close()
    curves = np.concatenate(blocks, axis=1)
    above = [
        strip([Image.fromarray(one.pixels) for one in stills])
        for stills in zip(*(f.stills for f in films), strict=True)
    ]
    below = _drawn(curves, times, seconds, [readable(name) for name in grasp.names], above[0].width)
    write_pictures(path, [_stacked(*pair) for pair in zip(above, below, strict=True)], times)


def _drawn(
    curves: np.ndarray, times: Sequence[float], seconds: float, names: Sequence[str], width: int
) -> list[Image.Image]:
    """The voltage in mV up to each of the times. curves: (1 + B, N), s first."""
    pictures = []
    with style():
        figure, axes = plt.subplots(figsize=(width / _DPI, _CURVES / _DPI), dpi=_DPI, layout="constrained")
        top = max(float(curves[1:].max()) * 1.1, 0.5)
        axes.set(xlim=(0, seconds), ylim=(min(float(curves[1:].min()), 0.0), top), xlabel="s", ylabel="mV")
        axes.grid(axis="y", color=FAINT, alpha=0.3)
        lines = [axes.plot([], [], color=_COLOURS[row], label=name)[0] for row, name in enumerate(names)]
        axes.legend(loc="upper left", frameon=False)
        for time in times:
            until = int(np.searchsorted(curves[0], time + 1e-9))
            for line, values in zip(lines, curves[1:], strict=True):
                line.set_data(curves[0, :until], values[:until])
            figure.canvas.draw()
            pixels = np.asarray(figure.canvas.buffer_rgba())  # pyright: ignore[reportAttributeAccessIssue]
            pictures.append(Image.fromarray(pixels[..., :3].copy()))
        plt.close(figure)
    return pictures


def _stacked(above: Image.Image, below: Image.Image) -> Image.Image:
    joined = Image.new("RGB", (above.width, above.height + below.height), "white")
    joined.paste(above, (0, 0))
    joined.paste(below, (0, above.height))
    return joined
