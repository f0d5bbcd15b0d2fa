"""Figures to files."""

from __future__ import annotations

import io
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from thermograsp.files import atomic_write


def save_figure(figure: Figure, stem: Path, dpi: int) -> list[Path]:
    """Writes stem.png, in a palette of 256 colours (a third of the size), and stem.svg. Returns both."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=dpi, format="png")
    image = Image.open(drawn).convert("RGB").quantize(256, dither=Image.Dither.NONE)
    with atomic_write(stem.with_suffix(".png")) as temporary:
        image.save(temporary, format="png", optimize=True, dpi=(dpi, dpi))
    with atomic_write(stem.with_suffix(".svg")) as temporary:
        figure.savefig(temporary, dpi=dpi, format="svg", metadata={"Date": None})
    return [stem.with_suffix(".png"), stem.with_suffix(".svg")]
