"""`thermograsp bench`: what accuracy costs, where time steps fail, and a peer's figures beside ours.

A benchmark is a room of thermograsp.bench, which measures and draws, and a module of this package of the same name with
report(record, output), which prints. Only those that were chosen are imported.
"""

from __future__ import annotations

import argparse
import importlib
import json
import time
from pathlib import Path
from typing import Any

from thermograsp.cli.shared import Output, add_seed, plain
from thermograsp.errors import InvalidValueError
from thermograsp.files import made_folder, write_text

NAME = "bench"
HELP = "Measure what accuracy and touch cost, map where time steps fail, and compare with a peer's published figures."

BENCHMARKS = ("accuracy", "stability", "grasp", "speed", "episode", "peer", "identify", "stopping")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("what", nargs="?", choices=(*BENCHMARKS, "all"), default="all", help="benchmark to run")
    add("--out", metavar="DIR", default="bench", help="folder for the records and figures")
    add("--quick", action="store_true", help="coarser measurements: one material, small maps")
    add_seed(parser, "seed of the order of timings and of the bouncing contacts")
    add(
        "--from",
        dest="source",
        metavar="FILE",
        help="record of an earlier run, NAME.json, to print and draw instead of measuring",
    )


def run(args: argparse.Namespace) -> int:
    """Measures or reads, prints and draws. That a method fails is a result: the status is 0 all the same."""
    from thermograsp.bench import caption, provenance

    begun, output = time.perf_counter(), Output(args.json)
    stored = _stored(args) if args.source else None
    folder = made_folder(args.out)
    document = {"provenance": provenance(args.seed), "quick": args.quick} if stored is None else stored
    chosen = BENCHMARKS if args.what == "all" else (args.what,)
    for name in chosen if stored is None else [name for name in chosen if name in stored]:
        room = importlib.import_module(f"thermograsp.bench.{name}")
        if stored is None:
            # As it will be read back: what is drawn now and what is drawn from the file are the same.
            document[name] = plain(room.measured(args.quick, args.seed, output.progress))
            saved = {key: document[key] for key in ("provenance", "quick", name)}
            write_text(folder / f"{name}.json", json.dumps(saved, allow_nan=False) + "\n")
        try:
            importlib.import_module(f"{__name__}.{name}").report(document[name], output)
            drawn = room.draw(document[name], folder, caption(document["provenance"]))
        except KeyError as error:
            if stored is None:
                raise
            raise InvalidValueError(
                f"{args.source}: the record of {name} has no {error}, as another version wrote it; measure again"
            ) from error
        for file in [*([] if stored else [folder / f"{name}.json"]), *drawn]:
            output.line(f"wrote {file}")
    output.line(caption(document["provenance"]))
    document["figures"] = sorted(str(file) for file in folder.iterdir() if file.suffix in (".png", ".svg"))
    document["seconds"] = time.perf_counter() - begun
    output.document(document)
    return 0


def _stored(args: argparse.Namespace) -> dict[str, Any]:
    """What an earlier run saved: its NAME.json, or what it printed with --json."""
    if args.quick or args.seed:
        raise InvalidValueError("--from measures nothing: leave out --quick and --seed")
    try:
        stored = json.loads(Path(args.source).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InvalidValueError(
            f"cannot read {args.source}: {error}; give a file that bench wrote"
        ) from error
    held = [name for name in BENCHMARKS if isinstance(stored, dict) and name in stored]
    if not held or "provenance" not in stored or args.what not in ("all", *held):
        raise InvalidValueError(
            f"{args.source} holds no record of {'any benchmark' if args.what == 'all' else args.what}"
            f"{f', but of {held}' if held else ''}; give a file that bench wrote"
        )
    return stored
