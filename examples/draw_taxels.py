"""Draws what the left pad feels of six shapes, as docs/images/taxels.png shows them.

python examples/draw_taxels.py taxels.png
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle

from thermograsp.envs.footprint import PAD
from thermograsp.figures import FAINT, presses, readable, style
from thermograsp.files import atomic_write


def main() -> int:
    """Draws the maps; the exit status."""
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    shown = presses()
    half, face = 500 * PAD.width, 500 * PAD.face  # mm
    with style():
        figure, row = plt.subplots(1, len(shown), figsize=(9.6, 2.05), layout="constrained")
        for axes, press in zip(row, shown, strict=True):
            kilopascals = 1e-3 * press.pressure
            axes.imshow(
                kilopascals, origin="lower", cmap="Purples", vmin=0, extent=(-half, half, -half, half)
            )
            axes.add_patch(
                Rectangle((-face, -face), 2 * face, 2 * face, fill=False, ec=FAINT, lw=0.8, ls=":")
            )
            axes.set_title(readable(press.name), fontsize=8.5)
            axes.set_xlabel(f"at most {kilopascals.max():.0f} kPa", fontsize=8)
            axes.set_xticks([])
            axes.set_yticks([])
            axes.spines[["top", "right"]].set_visible(True)
        with atomic_write(Path(sys.argv[1])) as temporary:
            figure.savefig(temporary, format="png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
