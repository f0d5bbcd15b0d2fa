"""`thermograsp gripper check FILE`: what is found in a gripper's MJCF file, and whether it grasps and feels."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from thermograsp.cli.shared import Output, add_old_name, load_mujoco, target
from thermograsp.errors import MissingDependencyError

if TYPE_CHECKING:
    from thermograsp.envs import Gripper

NAME = "gripper"
HELP = "Check your own gripper's MJCF file: report what is found in it, and grasp to show whether it is fit."

_FAILED = 1
_PICTURE = (480, 360)  # pixels, each of the two


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    about = "Find fingers, pads and actuators, grasp an object of glass and one of aluminium, and report the result."
    check = actions.add_parser("check", help=about, description=about, allow_abbrev=False)
    add = check.add_argument
    add("file", help="MJCF file of the gripper; a whole robot will do")
    add(
        "--fingertips",
        nargs=2,
        metavar=("BODY", "BODY"),
        help="bodies that carry the fingertips, or parts of the names of two digits (default: found in the file)",
    )
    add(
        "--actuators",
        nargs="+",
        metavar="NAME",
        help="names of the actuators that close the gripper (default: all)",
    )
    add("--parallel-at", type=float, default=0.04, help="opening at which the pads are parallel, m")
    add("--shape", choices=("box", "cylinder", "sphere"), default="box", help="shape of the objects")
    add(
        "--force",
        type=float,
        help="limit of the gripper's force, N (default: that of a usual grasp, or the most that it can exert)",
    )
    render = add("--render", metavar="FILE", help="draw the gripper open and closed: .png")
    add_old_name(check, "--png", render)


def run(args: argparse.Namespace) -> int:
    """Checks, draws and prints; 1 where the gripper is not fit."""
    output, picture = Output(args.json), target(args.render, (".png",))
    load_mujoco(output)
    from thermograsp.agents import REPORTED_AFTER, check_gripper
    from thermograsp.envs import load_gripper

    gripper = load_gripper(
        args.file, fingertips=args.fingertips, actuators=args.actuators, parallel_at=args.parallel_at
    )
    output.line(str(gripper))
    check = check_gripper(gripper, shape=args.shape, force=args.force)
    output.line(
        f"grasps of a {check.shape}, {1e3 * check.width:.0f} mm wide, at a limit of {check.limit:.1f} N; drops after "
        f"{REPORTED_AFTER:g} s of contact:"
    )
    header = ("material", "left N", "right N", "left K", "right K", "lifted mm", "slip mm")
    output.table(
        header,
        [
            [
                trial.material,
                *(f"{value:.2f}" for value in (*trial.force, *trial.drop)),
                f"{1e3 * trial.lifted:.1f}",
                f"{1e3 * trial.slip:.3f}",
            ]
            for trial in check.trials
        ],
    )
    drawn = picture is not None and _draw(output, gripper, picture, check.width)
    if drawn:
        output.line(f"wrote {picture}")
    output.line("fit: it grasps, holds and feels" if check.passed else f"not fit: {check.problem}")
    output.document({**check.document(), "png": str(picture) if drawn else None})
    return 0 if check.passed else _FAILED


def _draw(output: Output, gripper: Gripper, file: Path, width: float) -> bool:
    """Whether the picture could be drawn, which needs OpenGL."""
    from thermograsp.figures import draw_gripper

    try:
        draw_gripper(file, gripper, width, *_PICTURE)
    except MissingDependencyError as error:
        output.warn(f"no picture: {error}")
        return False
    return True
