"""`thermograsp bench`: what accuracy costs, where time steps fail, and a peer's figures beside ours."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError

NAME = "bench"
HELP = "Measure what accuracy costs, map where time steps fail, compare with a peer's published figures."

_ALL = ("accuracy", "stability", "peer")
_QUICK_MATERIALS = ("glass",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("what", nargs="?", choices=(*_ALL, "all"), default="all", help="which benchmark (default all)")
    add("--out", metavar="DIR", default="bench", help="folder for the figures (default bench)")
    add("--quick", action="store_true", help="coarser: one material, small maps")
    add("--seed", type=int, default=0, help="of the order of timings and of bouncing contacts (default 0)")


def run(args: argparse.Namespace) -> int:
    """Measures, draws and prints. That a method fails is a result: the status is 0 all the same."""
    if args.seed < 0:
        raise InvalidValueError(f"seed must be 0 or above, got {args.seed}")
    from thermograsp.bench.provenance import caption, provenance

    begun, output, folder = time.perf_counter(), Output(args.json), Path(args.out)
    if folder.exists() and not folder.is_dir():
        raise InvalidValueError(f"cannot write into {folder}: it is not a folder; name another with --out")
    folder.mkdir(parents=True, exist_ok=True)
    known = provenance(args.seed)
    document: dict[str, object] = {"provenance": known, "quick": args.quick}
    chosen = _ALL if args.what == "all" else (args.what,)
    for name in chosen:
        files, document[name] = _BENCHES[name](args, output, folder, caption(known))
        for file in files:
            output.line(f"wrote {file}")
    output.line(caption(known))
    document["figures"] = sorted(str(file) for file in folder.iterdir() if file.suffix in (".png", ".svg"))
    document["seconds"] = time.perf_counter() - begun
    output.document(document)
    return 0


def _accuracy(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    import numpy as np

    from thermograsp.bench import accuracy, elements
    from thermograsp.bench.accuracy_figure import draw_accuracy

    with_elements = elements.available()
    if not with_elements:
        output.warn("scikit-fem is not installed, so its points are left out: pip install thermograsp[fem]")
    names = _QUICK_MATERIALS if args.quick else accuracy.MATERIALS
    cases = [(name, mode) for mode in "TO" for name in names]
    methods = accuracy.methods(args.quick, with_elements)
    rng = np.random.default_rng(args.seed)
    points = []
    with output.progress(len(cases)) as advance:
        for case in cases:
            points += accuracy.measure(case, methods, rng, lambda doing: advance(doing, 0))
            advance("", 1)
    output.line(
        "time per second of contact, its ratio to the network for 0.03 K, and the largest error; * = Pareto front"
    )
    header = ("method", "setting", *(f"{name} {mode}" for name, mode in cases))
    rows = []
    for method in methods:
        mine = [p for p in points if (p.family, p.setting) == (method.family, method.setting)]
        cells = [
            f"{_seconds(p.seconds)} {p.ratio:8.3g}x {p.error:8.4f} K{'*' if p.pareto else ' '}" for p in mine
        ]
        rows.append((method.family, method.setting, *cells))
    for start in range(2, len(header), 2):
        pick = [0, 1, *range(start, min(start + 2, len(header)))]
        output.table([header[i] for i in pick], [[row[i] for i in pick] for row in rows])
        output.line()
    for case in cases:
        auto = [p for p in points if (p.material, p.mode) == case and p.family == "auto"]
        output.line(f"{' '.join(case)}: auto took " + ", ".join(f"{p.detail} for {p.setting}" for p in auto))
    kept = [p.error <= float(p.setting.split()[0]) for p in points if p.family == "auto"]
    output.line(f"auto kept its tolerance in {sum(kept)} of {len(kept)} cases")
    figures = [
        file
        for mode in "TO"
        for file in draw_accuracy(folder / f"accuracy{'' if mode == 'T' else '_o'}", points, mode, footnote)
    ]
    return figures, {
        "reference": "semi_analytic, 3-D, good to 0.0003 K of 12 K",
        "ratio_to": accuracy.RATIO_TO,
        "finite_elements": with_elements,
        "auto_kept_tolerance": sum(kept),
        "auto_cases": len(kept),
        "points": [
            {
                "material": p.material,
                "mode": p.mode,
                "method": p.family,
                "setting": p.setting,
                "rung": p.detail,
                "seconds_per_second": p.seconds,
                "preparation_s": p.preparation,
                "ratio": p.ratio,
                "error_K": p.error,
                "pareto": p.pareto,
            }
            for p in points
        ],
    }


def _stability(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    from thermograsp.bench import atlas
    from thermograsp.bench.atlas_figure import draw_atlas

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


def _peer(args: argparse.Namespace, output: Output, folder: Path, footnote: str) -> tuple[list[Path], object]:
    from thermograsp.bench import peer
    from thermograsp.bench.peer_figure import draw_peer

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


def _seconds(value: float) -> str:
    return f"{1e6 * value:7.1f} us" if value < 1e-3 else f"{1e3 * value:7.1f} ms"


_BENCHES: dict[str, Callable[[argparse.Namespace, Output, Path, str], tuple[list[Path], object]]] = {
    "accuracy": _accuracy,
    "stability": _stability,
    "peer": _peer,
}
