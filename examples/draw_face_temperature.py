"""Draws pressure over the left pad and temperature over its sensor's face, as docs/images/face_temperature.png does.

python examples/draw_face_temperature.py face_temperature.png
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle

from thermograsp.envs.footprint import PAD
from thermograsp.figures import (
    FAINT,
    RANGE,
    TEMPERATURE_MAP,
    readable,
    style,
    touches,
)
from thermograsp.files import atomic_write


def main() -> int:
    """Draws the maps; the exit status."""
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    shown = touches()
    pad, face = 500 * PAD.width, 500 * PAD.face  # mm
    with style():
        figure, rows = plt.subplots(2, len(shown), figsize=(8.4, 4.6), layout="constrained")
        drawn = None
        for column, touch in enumerate(shown):
            above, below = rows[:, column]
            above.imshow(
                touch.pressure, origin="lower", cmap="Purples", vmin=0, extent=(-pad, pad, -pad, pad)
            )
            square = Rectangle((-face, -face), 2 * face, 2 * face, fill=False, ec=FAINT, lw=0.8, ls=":")
            above.add_patch(square)
            above.set_title(readable(touch.name), fontsize=9)
            above.set_xlabel(f"at most {1e-3 * touch.pressure.max():.0f} kPa", fontsize=8)
            drawn = below.imshow(
                touch.celsius,
                origin="lower",
                cmap=TEMPERATURE_MAP,
                vmin=RANGE[0],
                vmax=RANGE[1],
                extent=(-face, face, -face, face),
            )
            below.set_xlabel(f"{touch.celsius.min():.1f} to {touch.celsius.max():.1f} °C", fontsize=8)
            for axes in (above, below):
                axes.set_xticks([])
                axes.set_yticks([])
                axes.spines[["top", "right"]].set_visible(True)
        rows[0, 0].set_ylabel(f"pad, {2 * pad:.0f} mm", fontsize=8.5)
        rows[1, 0].set_ylabel(f"sensor's face, {2 * face:.0f} mm", fontsize=8.5)
        assert drawn is not None
        figure.colorbar(drawn, ax=rows[1].tolist(), label="°C", shrink=0.8, aspect=12, pad=0.02)
        with atomic_write(Path(sys.argv[1])) as temporary:
            figure.savefig(temporary, format="png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
