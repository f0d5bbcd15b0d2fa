"""`thermograsp device gripper`: how a gripper is, after it was activated or moved where asked."""

from __future__ import annotations

import argparse

from thermograsp.cli.shared import Output

HELP = "Report the status of a gripper, after activating or moving it if asked."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add("url", metavar="URL", help="URL of the gripper, such as robotiq:///dev/ttyUSB0")
    add(
        "--activate",
        action="store_true",
        help="activate the gripper if it is not ready; its fingers travel their whole range",
    )
    add(
        "--clear-faults",
        action="store_true",
        help="reset and activate the gripper; an object that it holds falls",
    )
    add(
        "--opening",
        type=float,
        metavar="M",
        help="opening to move to, m; the command waits for the end of the motion",
    )
    add("--force", type=float, default=20.0, help="limit of the gripper's force, N")
    add("--speed", type=float, default=0.05, help="speed of the motion, m/s")


def run(args: argparse.Namespace) -> int:
    """Acts and prints. 1 where the gripper has a fault."""
    from thermograsp.hardware import open_gripper

    with open_gripper(args.url) as gripper:
        if args.clear_faults:
            gripper.clear_faults()
        elif args.activate:
            gripper.activate()
        if args.opening is not None:
            gripper.move(args.opening, args.force, args.speed)
            gripper.wait()
        status = gripper.status()
    output = Output(args.json)
    contact = status.contact.name.lower()
    motion = "moving" if status.moving else "at rest" if contact == "none" else f"stopped while {contact}"
    output.line(f"{'active' if status.active else 'not active'}, {motion}")
    output.line(f"opening {1e3 * status.opening:.1f} mm of {1e3 * status.target:.1f} mm commanded")
    if status.fault:
        output.line(f"fault: {status.fault}")
    output.document(
        {
            "active": status.active,
            "moving": status.moving,
            "contact": contact,
            "opening_m": status.opening,
            "target_m": status.target,
            "current_A": status.current,
            "fault": status.fault,
        }
    )
    return 1 if status.fault else 0
