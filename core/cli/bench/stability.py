"""`thermograsp bench stability`: where each time step of a contact is stable, rings, is wrong or blows up."""

from __future__ import annotations

import argparse
from pathlib import Path

from thermograsp.bench import atlas
from thermograsp.bench.atlas_figure import draw_atlas
from thermograsp.cli.output import Output


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figure and what goes into the JSON document."""
    pixels, steps = (20, 200) if args.quick else (64, atlas.STEPS)
    with output.progress(10) as advance:
        maps = atlas.atlas(pixels, steps, args.seed, lambda doing: advance(doing, 1))
    output.line(f"share of the map, and how far the range was left at most ({steps} steps)")
    header = ("scheme", "stable", "rings", "leaves range", "blows up", "outside")
    rows = [
        (
            each.title,
            *(f"{100 * each.share(kind):.1f} %" for kind in range(4)),
            f"{each.outside.max():.2g}",
        )
        for each in maps
    ]
    output.table(header, rows)
    figures = draw_atlas(folder / "stability", maps, footnote)
    return figures, {
        "steps": steps,
        "tolerance": atlas.TOLERANCE,
        "kinds": atlas.NAMES,
        "maps": [
            {
                "scheme": each.key,
                "title": each.title,
                "axes": each.axes,
                "x": each.x,
                "y": each.y,
                "kind": each.kinds,
                "shares": {name: each.share(kind) for kind, name in enumerate(atlas.NAMES)},
                "outside": each.outside.max(),
                "heat_from_nowhere": each.heat.max(),
                "limits": [{"name": line.name, "x": line.x, "y": line.y} for line in each.lines],
            }
            for each in maps
        ],
    }
