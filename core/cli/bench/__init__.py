"""`thermograsp bench`: what accuracy costs, where time steps fail, and a peer's figures beside ours.

Each benchmark is a module of this package with measure(args, output, folder, footnote) -> (figures, JSON content); only
those that were chosen are imported.
"""

from __future__ import annotations

import argparse
import importlib
import time
from pathlib import Path

from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError

NAME = "bench"
HELP = "Measure what accuracy and touch cost, map where time steps fail, compare with a peer's published figures."

BENCHMARKS = ("accuracy", "stability", "grasp", "speed", "episode", "peer", "identify")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("what", nargs="?", choices=(*BENCHMARKS, "all"), default="all", help="which benchmark (default all)")
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
    chosen = BENCHMARKS if args.what == "all" else (args.what,)
    for name in chosen:
        module = importlib.import_module(f"{__name__}.{name}")
        files, document[name] = module.measure(args, output, folder, caption(known))
        for file in files:
            output.line(f"wrote {file}")
    output.line(caption(known))
    document["figures"] = sorted(str(file) for file in folder.iterdir() if file.suffix in (".png", ".svg"))
    document["seconds"] = time.perf_counter() - begun
    output.document(document)
    return 0
