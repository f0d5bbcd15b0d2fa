"""`thermograsp score`: a policy on episodes that no training has seen."""

from __future__ import annotations

import argparse
from dataclasses import replace

from thermograsp.cli.shared import Output, load_mujoco
from thermograsp.errors import InvalidValueError

NAME = "score"
HELP = (
    "Count how often a policy succeeds in held-out episodes of a task, which are the same for every policy."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "policy",
        metavar="POLICY",
        help="policy: scripted, feeling, trained, random, zero, a policy's .npz file, or module:callable, a function "
        "of the observations of all environments that returns their actions",
    )
    add("--task", required=True, help="task: grasp, identify, sort or hotter")
    add("--episodes", type=int, default=200, help="number of episodes")
    add("--no-load", action="store_true", help="score on a gripper without load cells: forces read 0")
    add("--gripper", metavar="FILE", help="MJCF file of your own gripper (default: the shipped gripper)")
    add(
        "--randomize",
        action="store_true",
        help="draw at random everything that can differ between episodes (envs.EVERYTHING)",
    )
    add(
        "--twin",
        action="store_true",
        help="score through emulated devices and their serial protocols",
    )
    add(
        "--force-range",
        type=float,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="force range of the emulated gripper in N, with --twin (default: a Robotiq 2F-85's, 20 235)",
    )


def run(args: argparse.Namespace) -> int:
    """Runs the episodes."""
    output = Output(args.json)
    load_mujoco(output)
    from thermograsp.agents.learning import HELD_OUT, learning_task, score

    task = learning_task(args.task)
    if args.force_range and not args.twin:
        raise InvalidValueError("--force-range is of an emulated gripper: give --twin, too")
    changes = {"gripper": args.gripper} if args.gripper else {}
    if args.twin:
        weakest, strongest = args.force_range or (None, None)
        changes["plant"] = f"twin:?{weakest=}&{strongest=}" if args.force_range else "twin"
    task = task.drawn() if args.randomize else task
    task = replace(task, keywords={**task.keywords, **changes})
    with output.progress(args.episodes) as advance:
        found = score(task, args.policy, args.episodes, not args.no_load, advance)
    output.line(f"{task.name} ({task.env_id}), policy {args.policy}, {found.episodes} held-out episodes")
    interval = f"{100 * found.low:.1f} .. {100 * found.high:.1f} %"
    output.line(f"success  {100 * found.success:.1f} %, with 95 % certainty {interval}")
    output.line(f"return   {found.mean_return:.3f} (mean)")
    output.line(f"length   {found.seconds:.2f} s (mean)")
    output.line(f"digest   {found.digest}")
    output.document(
        {
            "task": task.name,
            "env_id": task.env_id,
            "policy": args.policy,
            "load": not args.no_load,
            "gripper": args.gripper,
            "randomize": args.randomize,
            "twin": args.twin,
            "force_range": args.force_range,
            "first_seed": HELD_OUT,
            "episodes": found.episodes,
            "successes": found.successes,
            "success_rate": found.success,
            "success_interval": [found.low, found.high],
            "mean_return": found.mean_return,
            "mean_seconds": found.seconds,
            "digest": found.digest,
        }
    )
    return 0
