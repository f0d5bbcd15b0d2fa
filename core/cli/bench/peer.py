"""`thermograsp bench peer`: a peer's published contact temperatures beside ours and the exact ones."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from thermograsp.bench import peer
from thermograsp.bench.peer_figure import draw_peer
from thermograsp.cli.output import Output


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figure and what goes into the JSON document."""
    touches = peer.touches()
    output.line("contact temperature, degC: a 16 x 16 x 10 mm tip at 36 degC on plates at 24 degC")
    output.line(f"peer's figures published by {peer.PUBLISHED_BY}; quoted, not measured again")
    moments = [f"{time:g} s" for time in peer.TIMES]
    for title, row in (
        ("thermograsp, 1-D", lambda t: t.column),
        ("thermograsp, 40 x 40 x 10 mm plate", lambda t: t.slab),
        ("the same, 1e4 W/(m2 K)", lambda t: t.soft),
        ("peer, quoted", lambda t: t.peer),
    ):
        output.table(
            (title, "exact", *moments, *(f"off {moment}" for moment in moments)),
            [
                (
                    t.plate,
                    f"{t.exact:.2f}",
                    *(f"{value:.2f}" for value in row(t)),
                    *(f"{value - t.exact:+.2f}" for value in row(t)),
                )
                for t in touches
            ],
        )
        output.line()
    output.line("mean of the tip's first millimetre at 5 s, degC, exact and peer (1 x 1 x 10 grid, quoted)")
    for t in touches:
        if t.plate in peer.PEER_FIRST_MILLIMETRE:
            output.line(
                f"  {t.plate}: {t.first_millimetre:.2f}, peer {peer.PEER_FIRST_MILLIMETRE[t.plate]:.2f}"
            )
    metal = touches[-1]
    output.line(
        f"heat lost on {metal.plate} in 5 s, kJ/m2: exact {metal.heat[0] / 1e3:.1f}, ours {metal.heat[1] / 1e3:.1f}, "
        f"peer {peer.PEER_HEAT[metal.plate] / 1e3:.0f} (quoted)"
    )
    figures = draw_peer(folder / "peer", touches, footnote)
    return figures, {
        "published_by": peer.PUBLISHED_BY,
        "times_s": peer.TIMES,
        "plates": [asdict(t) for t in touches],
        "peer_first_millimetre": peer.PEER_FIRST_MILLIMETRE,
        "peer_heat_J_per_m2": peer.PEER_HEAT,
    }
