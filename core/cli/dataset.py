"""`thermograsp dataset`: episodes as Parquet files, by one process or by Ray's workers, and their export."""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

from thermograsp.cli.arguments import add_materials_file, chosen_material
from thermograsp.cli.opengl import load_mujoco
from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.dataset import Plan

NAME = "dataset"
HELP = "Write episodes to Parquet files, in parallel, going on where it was stopped; export them to Minari."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("--episodes", type=int, help="how many; without it --export takes the folder as it is")
    add("--out", metavar="DIR", default="dataset", help="folder of the dataset (default dataset)")
    add("--id", default="thermograsp/Grasp-v0", help="environment (default thermograsp/Grasp-v0)")
    add("--policy", default="scripted", help="scripted (default), feeling, trained, random or zero")
    add("--seed", type=int, default=0, help="episode k is that of seed + k (default 0)")
    add("--mode", default="T", help="T: element on the thermostat (default), O: on the object")
    add(
        "--material",
        nargs="+",
        metavar="NAME",
        help="materials that episodes draw from (default: the paper's ten)",
    )
    add_materials_file(parser)
    add("--shard", type=int, default=128, metavar="N", help="episodes a file (default 128)")
    add("--workers", type=int, default=0, help="Ray tasks at a time; 0 (default): this process, without Ray")
    add(
        "--ray-address", metavar="ADDRESS", help="of a running Ray cluster, or auto (default: one of its own)"
    )
    add("--export", choices=("minari",), help="when the folder is complete, write a Minari dataset")
    add("--name", help="of the Minari dataset (default such as thermograsp/Grasp/scripted-v0)")


def run(args: argparse.Namespace) -> int:
    """Makes what the folder lacks, then exports where that is asked."""
    if args.episodes is None and args.export is None:
        raise InvalidValueError("say how many --episodes, or --export minari for a folder that is complete")
    if args.name is not None and args.export is None:
        raise InvalidValueError("--name goes with --export minari")
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
        name, path = dataset.export_minari(args.out, args.name, output.progress)
        output.line(f"wrote Minari dataset {name} to {path}")
        document["minari"] = {"id": name, "path": str(path)}
    output.document(document)
    return 0


def _plan(args: argparse.Namespace) -> Plan:
    from thermograsp.dataset import Plan

    drawn = {}
    if args.material:
        drawn["materials"] = tuple(chosen_material(name, args.materials) for name in args.material)
    elif args.materials:
        raise InvalidValueError(
            "--materials needs --material: name those of the file that episodes draw from"
        )
    return Plan(args.id, args.episodes, args.seed, args.policy, args.mode, shard_size=args.shard, **drawn)
