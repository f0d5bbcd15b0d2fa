"""Draws a grasp as a moving picture with its voltages, as docs/images/grasp.gif shows it.

python examples/draw_grasp.py grasp.gif
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image, ImageSequence

from thermograsp.cli import main as command
from thermograsp.columns import read_csv
from thermograsp.figures import FAINT, INK, style, write_pictures

MATERIAL, SECONDS = "aluminium", 4.0
SIZE = (560, 300)  # pixels


def main() -> int:
    """Draws the film; the exit status."""
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        film, table = Path(folder, "grasp.gif"), Path(folder, "grasp.csv")
        words = ["grasp", "--material", MATERIAL, "--seconds", str(SECONDS), "--hold", "1"]
        if command([*words, "--render", str(film), "--csv", str(table)]):
            return 1
        columns = read_csv(table)
        with Image.open(film) as opened:
            frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(opened)]
    times = np.linspace(0, SECONDS, len(frames))
    millivolts = 1e3 * columns["voltage_left_V"]
    pictures = []
    for frame, time in zip(frames, times, strict=True):
        picture = Image.new("RGB", SIZE, "white")
        scaled = frame.resize((round(frame.width * SIZE[1] / frame.height), SIZE[1]))
        picture.paste(scaled, (0, 0))
        curve = _curve(columns["time_s"], millivolts, time, (SIZE[0] - scaled.width, SIZE[1]))
        picture.paste(curve, (scaled.width, 0))
        pictures.append(picture.quantize(64))
    write_pictures(sys.argv[1], pictures, list(times))
    return 0


def _curve(t: np.ndarray, millivolts: np.ndarray, now: float, size: tuple[int, int]) -> Image.Image:
    """The voltage up to `now` s."""
    with style():
        figure = plt.figure(figsize=(size[0] / 100, size[1] / 100), dpi=100, layout="constrained")
        axes = figure.subplots()
        axes.plot(t, millivolts, color=FAINT, lw=0.8)
        axes.plot(t[t <= now], millivolts[t <= now], color=INK, lw=1.6)
        axes.set(xlabel="time, s", ylabel="voltage, mV", title=MATERIAL)
        figure.canvas.draw()
        pixels = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()  # pyright: ignore[reportAttributeAccessIssue]
        plt.close(figure)
    return Image.fromarray(pixels)


if __name__ == "__main__":
    sys.exit(main())
