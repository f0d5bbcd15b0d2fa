"""`thermograsp device emulate-gripper`: a Robotiq 2F-85 in software, on a port that any Modbus RTU client opens."""

from __future__ import annotations

import argparse

from thermograsp.cli.shared import add_service, serve

HELP = "Emulate a Robotiq 2F-85 with or without an object between its fingers, on a pseudo-terminal."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add("--width", type=float, help="width of the object between the fingers, m (default: no object)")
    add("--stiffness", type=float, default=1e5, help="stiffness of the object, N/m")
    add_service(parser, "seed of the faults", "corrupt=0.01, overcurrent@5, stall=2@10")


def run(args: argparse.Namespace) -> int:
    """Serves until the end of the time or an interrupt."""
    import numpy as np

    from thermograsp.hardware import EmulatedGripper, PtyDevice, RobotiqUnits, SpringFingers
    from thermograsp.hardware.emulators import plan_gripper_fault

    fingers = SpringFingers(RobotiqUnits().stroke, args.width, args.stiffness)
    device = EmulatedGripper(fingers=fingers, rng=np.random.default_rng(args.seed))
    for text in args.fault:
        plan_gripper_fault(device, text)
    with PtyDevice(device, args.link) as served:
        url = f"robotiq://{served.path}"
        return serve(args, served.path, {"port": served.path, "url": url, "width_m": args.width})
