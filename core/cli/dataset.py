"""`thermograsp dataset`: episodes as Parquet files, by one process or by Ray's workers, and their export."""

from __future__ import annotations

import argparse
import json
import time
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, add_materials_file, add_mode, chosen_material, load_mujoco
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.dataset import Plan

NAME = "dataset"
HELP = "Write episodes to Parquet files in parallel, resuming where it stopped; export them to Minari or LeRobot."

_FORMATS = {"minari": "Minari", "lerobot": "LeRobot"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("--episodes", type=int, help="number of episodes; without it, --export takes the folder as it is")
    add("--out", metavar="DIR", default="dataset", help="folder of the dataset")
    add("--id", default="thermograsp/Grasp-v0", help="id of the environment")
    add("--policy", default="scripted", help="policy: scripted, feeling, trained, random or zero")
    add("--seed", type=int, default=0, help="seed of the first episode; episode k uses seed + k")
    add_mode(parser)
    add(
        "--material",
        nargs="+",
        metavar="NAME",
        help="names of the materials that episodes draw from (default: the paper's ten)",
    )
    add_materials_file(parser)
    add("--shard", type=int, default=128, metavar="N", help="number of episodes per file")
    add(
        "--set",
        nargs="+",
        default=[],
        metavar="NAME=VALUE",
        help="further keywords of the environment, with values as JSON or text, such as tolerance=0.02",
    )
    add(
        "--workers",
        type=int,
        default=0,
        help="number of processes, or of Ray tasks at a time; 0 works in this process",
    )
    add(
        "--ray-address",
        metavar="ADDRESS",
        help="Ray cluster to run the workers on: its address, auto for one that is running, or local to start one",
    )
    add(
        "--export",
        choices=tuple(_FORMATS),
        help="format in which to write a dataset of the complete folder",
    )
    add(
        "--name",
        help="name of the exported dataset (default: such as thermograsp/Grasp/scripted-v0 for Minari, "
        "thermograsp/Grasp-scripted for LeRobot)",
    )


def run(args: argparse.Namespace) -> int:
    """Makes what the folder lacks, then exports where that is asked."""
    if args.episodes is None and args.export is None:
        raise InvalidValueError(
            "say how many --episodes, or --export minari or lerobot for a folder that is complete"
        )
    if args.name is not None and args.export is None:
        raise InvalidValueError("--name goes with --export minari or lerobot")
    output = Output(args.json)
    load_mujoco(output)
    from thermograsp import dataset

    document: dict[str, object] = {"folder": args.out}
    if args.episodes is not None:
        begun = time.perf_counter()
        made = dataset.make(_plan(args), args.out, args.workers, args.ray_address, output.progress)
        seconds = time.perf_counter() - begun
        output.line(
            f"{args.out}: {args.episodes} episodes of {args.id} in {made.shards} files"
            f"{f', {made.found} of them found done' if made.found else ''}; {seconds:.1f} s"
        )
        document |= {
            "episodes": args.episodes,
            "shards": made.shards,
            "found": made.found,
            "seconds": seconds,
        }
    if args.export is not None:
        export = dataset.export_minari if args.export == "minari" else dataset.export_lerobot
        name, path = export(args.out, args.name, output.progress)
        output.line(f"wrote {_FORMATS[args.export]} dataset {name} to {path}")
        document[args.export] = {"id": name, "path": str(path)}
    output.document(document)
    return 0


def _keyword(given: str) -> tuple[str, Any]:
    """NAME=VALUE, where what is no JSON is text."""
    from thermograsp.dataset import decoded

    name, equals, text = given.partition("=")
    if not equals or not name.isidentifier():
        raise InvalidValueError(f"--set takes NAME=VALUE, got {given!r}")
    try:
        return name, decoded(json.loads(text))
    except json.JSONDecodeError:
        return name, text


def _plan(args: argparse.Namespace) -> Plan:
    from thermograsp.dataset import Plan

    keywords = dict(map(_keyword, args.set))
    if len(keywords) < len(args.set):
        raise InvalidValueError(f"--set {' '.join(args.set)}: give every name once")
    drawn: dict[str, Any] = {"keywords": keywords}
    if args.material:
        drawn["materials"] = tuple(chosen_material(name, args.materials) for name in args.material)
    elif args.materials:
        raise InvalidValueError(
            "--materials needs --material: name those of the file that episodes draw from"
        )
    elif drawn["keywords"].keys() & {"objects", "scene"}:
        drawn["materials"] = ()
    return Plan(args.id, args.episodes, args.seed, args.policy, args.mode, shard_size=args.shard, **drawn)
