"""`thermograsp device emulate-hand`: fingertips and gripper in software, moved by one simulation, on two ports."""

from __future__ import annotations

import argparse

from thermograsp.cli.shared import (
    Output,
    add_materials_file,
    add_mode,
    add_sensor,
    add_service,
    add_skin,
    chosen_material,
    load_mujoco,
    serve,
)

HELP = "Emulate fingertips and a Robotiq 2F-85 that grasp a simulated object in real time, on two pseudo-terminals."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add("--material", default="glass", help="name of the object's material, see `thermograsp materials`")
    add_materials_file(parser)
    add_mode(parser)
    add_sensor(parser)
    add_skin(parser)
    add(
        "--gripper-link", metavar="PATH", help="path of a symbolic link to the gripper's port (default: none)"
    )
    add_service(parser, "seed of the object's place and of the noise")


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
