"""`thermograsp device emulate-hand`: fingertips and gripper in software, moved by one simulation, on two ports."""

from __future__ import annotations

import argparse

from thermograsp.cli.device.connection import add_service, serve
from thermograsp.cli.shared import Output, add_materials_file, chosen_material, load_mujoco

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
    add("--gripper-link", metavar="PATH", help="a stable name for the gripper's port (default: none)")
    add_service(parser, "of the objects' places and the noise")


def run(args: argparse.Namespace) -> int:
    """Serves until the end of the time or an interrupt."""
    load_mujoco(Output(args.json))
    from thermograsp.envs.plant import SimulatedPlant, SimulationConfig
    from thermograsp.hardware import PtyDevice
    from thermograsp.twin import SimulatedHand

    material = chosen_material(args.material, args.materials)
    config = SimulationConfig(material=material, mode=args.mode, sensor=args.sensor, skin=args.skin)
    simulation = SimulatedPlant(1, config)
    hand = SimulatedHand(simulation, args.seed)
    with PtyDevice(hand.fingertips, args.link) as tips, PtyDevice(hand.gripper, args.gripper_link) as gripper:
        url = f"serial://{tips.path}?gripper=robotiq://{gripper.path}"
        return serve(args, url, {"plant": url, "material": material.name, "mode": args.mode})
