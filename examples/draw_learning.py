"""Draws learning curves from the files of train_grasp.py, success over control steps with and without heat, and
prints the table of the fresh episodes at the end.

python examples/draw_learning.py out/learning docs/images/learning.png
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from thermograsp.figures import FAINT, label_ends, style
from thermograsp.files import atomic_write

GRIPPERS = {"load": "gripper with load cells", "no-load": "gripper without load cells"}
AGENTS = {"heat": ("with heat", "#1d4f91"), "no-heat": ("without heat", "#c8571b")}
LEVELS = ((1.0, "script that feels"), (0.625, "best constant force"))


def curve(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Control steps and success, (n,) each."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return tuple(np.array([float(row[name]) for row in rows]) for name in ("control_steps", "success"))  # pyright: ignore


def draw(axes: Axes, runs: Path, gripper: str) -> None:
    """One gripper's panel. A line a seed, thick their mean; a ring the 500 fresh episodes at the end."""
    ends, labels, colors = [], [], []
    for agent, (label, color) in AGENTS.items():
        found = [path for path in sorted(runs.glob(f"{agent}-{gripper}-*.json"))]
        if not found:
            continue
        curves = [curve(path.with_suffix(".csv")) for path in found]
        for at, success in curves:
            axes.plot(at / 1e3, 100 * success, color=color, lw=0.8, alpha=0.45)
        mean = np.mean([success for _, success in curves], axis=0)
        axes.plot(curves[0][0] / 1e3, 100 * mean, color=color, lw=2.4)
        final = [json.loads(path.read_text()) for path in found]
        shares = [100 * each["successes"] / each["episodes"] for each in final]
        axes.plot(
            [each["control_steps"] / 1e3 for each in final], shares, "o", color=color, mfc="white", ms=5
        )
        ends.append(float(np.mean(shares)))
        labels.append(f"{label}, {np.mean(shares):.0f} %")
        colors.append(color)
    axes.set(xlim=(0, None), ylim=(0, 104), xlabel="control steps (thousands)")
    for level, text in LEVELS:
        axes.axhline(100 * level, color=FAINT, lw=0.8, ls=(0, (4, 3)))
        axes.text(axes.get_xlim()[1] * 0.01, 100 * level - 1.2, text, color=FAINT, size=8, va="top")
    axes.set_title(GRIPPERS[gripper], pad=12)
    label_ends(axes, axes.get_xlim()[1], ends, labels, colors)


def table(runs: Path) -> None:
    """Successes of each agent, a seed after the other, as Markdown."""
    print("| gripper | agent | successes | mean |\n|---|---|---|---|")
    for gripper, where in GRIPPERS.items():
        for agent, (label, _) in AGENTS.items():
            found = [json.loads(path.read_text()) for path in sorted(runs.glob(f"{agent}-{gripper}-*.json"))]
            if found:
                counts = ", ".join(f"{each['successes']} of {each['episodes']}" for each in found)
                mean = np.mean([each["successes"] / each["episodes"] for each in found])
                print(f"| {where.removeprefix('gripper ')} | {label} | {counts} | {100 * mean:.1f} % |")


def main() -> None:
    """The figure, and the table."""
    runs, target = Path(sys.argv[1]), Path(sys.argv[2])
    table(runs)
    grippers = [name for name in GRIPPERS if list(runs.glob(f"heat-{name}-*.json"))]
    with style():
        figure, panels = plt.subplots(
            1, len(grippers), figsize=(5.6 * len(grippers), 3.9), squeeze=False, layout="constrained"
        )
        for axes, gripper in zip(panels[0], grippers, strict=True):
            draw(axes, runs, gripper)
        panels[0, 0].set_ylabel("successful episodes (%)")
        with atomic_write(target) as temporary:
            figure.savefig(temporary)


if __name__ == "__main__":
    main()
