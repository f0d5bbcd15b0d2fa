"""`thermograsp device emulate`: fingertips in software, on a port that any serial driver opens."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from thermograsp.cli.shared import add_mode, add_service, add_skin, serve
from thermograsp.errors import unknown_name

if TYPE_CHECKING:
    from thermograsp.hardware import Source

HELP = "Emulate fingertips that press an object again and again, or play a recording, on a pseudo-terminal."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add("--material", default="glass", help="name of the object's material, see `thermograsp materials`")
    add_mode(parser)
    add_skin(parser)
    add("--conductance", type=float, default=1e4, help="contact conductance, W/(m2 K)")
    add("--force", type=float, default=10.0, help="contact force, N")
    add(
        "--replay",
        metavar="FILE",
        help="recording to play instead of presses, from `thermograsp device record`",
    )
    add("--chain", default="ads1115", help="signal chain (amplifier and converter): ads1115 or ideal")
    add("--drift", type=float, default=0.0, help="drift of the device's clock, ppm")
    add_service(parser, "seed of the noise and the faults", "corrupt=0.01, reboot@5, unplug=2@10")


def run(args: argparse.Namespace) -> int:
    """Serves until the end of the time or an interrupt."""
    import numpy as np

    from thermograsp.hardware import DeviceModel, EmulatedFingertips, PtyDevice
    from thermograsp.hardware.emulators import plan_fault
    from thermograsp.thermal import SIGNAL_CHAINS

    if args.chain not in SIGNAL_CHAINS:
        raise unknown_name("signal chain", args.chain, SIGNAL_CHAINS)
    model = DeviceModel(chain=SIGNAL_CHAINS[args.chain], drift=1e-6 * args.drift)
    device = EmulatedFingertips(_source(args), model, rng=np.random.default_rng(args.seed))
    with PtyDevice(device, args.link) as served:
        for text in args.fault:
            plan_fault(served, text)
        material = None if args.replay else args.material
        return serve(args, served.path, {"port": served.path, "material": material, "mode": args.mode})


def _source(args: argparse.Namespace) -> Source:
    from thermograsp.hardware import press_source, replay, samples_source

    if args.replay is not None:
        return samples_source(replay(args.replay).samples)
    return press_source(
        args.material, mode=args.mode, skin=args.skin, conductance=args.conductance, force=args.force
    )
