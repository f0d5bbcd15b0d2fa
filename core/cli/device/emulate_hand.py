"""`thermograsp device emulate-hand`: fingertips and gripper in software, moved by one simulation, on two ports."""

from __future__ import annotations

import argparse
import sys
import time

from thermograsp.cli.shared import Output, add_materials_file, chosen_material, load_mujoco
from thermograsp.errors import InvalidValueError, positive

_FOREVER = 2**31 - 1.0  # s

HELP = "Emulate fingertips and a Robotiq 2F-85 that grasp a simulated object, on two pseudo-terminals, in real time."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add("--material", default="glass", help="of the object: a name of `thermograsp materials`")
    add_materials_file(parser)
    add("--mode", default="T", help="T: element on the thermostat, O: on the object")
    add(
        "--sensor",
        default="seed",
        help="a sensor's name, or a file of `thermograsp device fit`",
    )
    add(
        "--skin",
        help="over the fingertips, in T mode: a skin's name, such as filled_silicone (default: bare)",
    )
    add("--link", metavar="PATH", help="a stable name for the fingertips' port (default: none)")
    add("--gripper-link", metavar="PATH", help="a stable name for the gripper's port (default: none)")
    add("--seed", type=int, default=0, help="of the objects' places and the noise")
    add("--seconds", type=float, help="stop then (default: at Ctrl-C)")


def run(args: argparse.Namespace) -> int:
    """Serves until the end of the time or an interrupt."""
    output = Output(args.json)
    load_mujoco(output)
    from thermograsp.envs.plant import SimulatedPlant, SimulationConfig
    from thermograsp.hardware import PtyDevice
    from thermograsp.twin import SimulatedHand

    if args.seed < 0:
        raise InvalidValueError(f"seed must be 0 or above, got {args.seed}")
    seconds = None if args.seconds is None else positive("seconds", args.seconds)
    material = chosen_material(args.material, args.materials)
    config = SimulationConfig(material=material, mode=args.mode, sensor=args.sensor, skin=args.skin)
    simulation = SimulatedPlant(1, config)
    hand = SimulatedHand(simulation, args.seed)
    with PtyDevice(hand.fingertips, args.link) as tips, PtyDevice(hand.gripper, args.gripper_link) as gripper:
        url = f"serial://{tips.path}?gripper=robotiq://{gripper.path}"
        output.line(f"{url}  (Ctrl-C ends it)")
        output.document({"plant": url, "material": material.name, "mode": args.mode})
        sys.stdout.flush()
        try:
            time.sleep(seconds if seconds is not None else _FOREVER)
        except KeyboardInterrupt:
            pass
    return 0
