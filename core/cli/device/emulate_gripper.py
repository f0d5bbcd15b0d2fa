"""`thermograsp device emulate-gripper`: a Robotiq 2F-85 in software, on a port that any Modbus RTU client opens."""

from __future__ import annotations

import argparse
import sys
import time

from thermograsp.cli.shared import Output
from thermograsp.errors import InvalidValueError, positive

HELP = "Emulate a Robotiq 2F-85 with something between its fingers, on a pseudo-terminal."
_STROKE = 0.085


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add("--width", type=float, help="of what is between the fingers, m (default: nothing is)")
    add("--stiffness", type=float, default=1e5, help="of it, N/m")
    add("--link", metavar="PATH", help="a stable name for the port (default: none)")
    add("--seed", type=int, default=0, help="of faults")
    add("--seconds", type=float, help="stop then (default: at Ctrl-C)")
    add(
        "--fault",
        action="append",
        default=[],
        metavar="NAME[=VALUE][@SECONDS]",
        help="what goes wrong, and when, such as corrupt=0.01, overcurrent@5, stall=2@10; may be repeated; "
        "an unknown one lists all",
    )


def run(args: argparse.Namespace) -> int:
    """Serves until the end of the time or an interrupt."""
    import numpy as np

    from thermograsp.hardware import EmulatedGripper, PtyDevice, SpringFingers
    from thermograsp.hardware.emulators import plan_gripper_fault

    if args.seed < 0:
        raise InvalidValueError(f"seed must be 0 or above, got {args.seed}")
    seconds = None if args.seconds is None else positive("seconds", args.seconds)
    fingers = SpringFingers(_STROKE, args.width, args.stiffness)
    device = EmulatedGripper(fingers=fingers, rng=np.random.default_rng(args.seed))
    for text in args.fault:
        plan_gripper_fault(device, text)
    with PtyDevice(device, args.link) as served:
        output = Output(args.json)
        output.line(f"{served.path}  (Ctrl-C ends it)")
        output.document({"port": served.path, "url": f"robotiq://{served.path}", "width_m": args.width})
        sys.stdout.flush()
        try:
            time.sleep(seconds if seconds is not None else np.iinfo(np.int32).max)
        except KeyboardInterrupt:
            pass
    return 0
