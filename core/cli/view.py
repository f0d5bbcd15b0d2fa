"""`thermograsp view`: the browser studio, on a local web page."""

from __future__ import annotations

import argparse
import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from thermograsp.cli.arguments import add_materials_file, target
from thermograsp.cli.opengl import load_mujoco
from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError, positive

if TYPE_CHECKING:
    from thermograsp.view.choices import Choices, Stock

NAME = "view"
HELP = "Open the studio: a web page with the gripper in 3-D, live curves and all controls. Or record what it shows."

_PORT = 8421


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "--material",
        nargs="+",
        default=["glass"],
        metavar="NAME",
        help="one, or two side by side (default glass)",
    )
    add_materials_file(parser)
    add("--mode", default="T", help="T: element on the thermostat (default), O: on the object")
    add("--mesh", metavar="FILE", help="an object to choose, from a mesh: .stl, .obj, .ply or .glb")
    add("--scale", type=float, default=1.0, help="lengths in the mesh times this are metres (default 1)")
    add(
        "--policy",
        metavar="FILE",
        help="a trained policy's .npz file, for the driver Learnt (default: the package's)",
    )
    add(
        "--recording",
        metavar="CSV",
        help="play what `grasp`, `press` or `device replay` wrote instead of simulating",
    )
    add(
        "--plant",
        metavar="URL",
        help="drive the gripper of serial://PORT?gripper=URL instead; one page at a time",
    )
    add(
        "--host",
        default="127.0.0.1",
        help="address to listen on (default 127.0.0.1, this machine only); any other one asks for a random token",
    )
    add("--port", type=int, default=_PORT, help=f"to listen on, 0 for any that is free (default {_PORT})")
    add("--visitors", type=int, default=4, help="pages at once, each with its own simulation (default 4)")
    add("--open", action="store_true", help="open the page in this machine's browser")
    add("--record", metavar="FILE", help="write a grasp as .gif, .webp or .png and leave; needs no display")
    add("--seconds", type=float, default=6.0, help="with --record: how long (default 6)")


def run(args: argparse.Namespace) -> int:
    """Serves until it is interrupted, or records."""
    output = Output(args.json)
    load_mujoco(output)
    stock, choices = _start(args)
    if args.record is not None:
        return _record(args, output, stock, choices)
    if not 0 <= args.port <= 65535:
        raise InvalidValueError(f"port must be 0 to 65535, got {args.port}")
    if args.visitors < 1:
        raise InvalidValueError(f"visitors must be at least 1, got {args.visitors}")
    from thermograsp.view.access import Access
    from thermograsp.view.server import Studio

    studio = Studio(Access.to(args.host), stock, choices, 1 if args.plant else args.visitors)

    def started(url: str) -> None:
        output.line(f"thermograsp studio: {url}  (Ctrl-C ends it)")
        output.document({"url": url})
        if args.open:
            import webbrowser

            webbrowser.open(url)

    asyncio.run(studio.run(args.port, started))
    return 0


def _start(args: argparse.Namespace) -> tuple[Stock, Choices]:
    """What visitors may choose, and what they find chosen."""
    from thermograsp import thermal
    from thermograsp.envs import ObjectSpec
    from thermograsp.report.trained import load_network
    from thermograsp.view.choices import Choices, Stock
    from thermograsp.view.played import PlayedGrasp

    if args.recording is not None and args.plant is not None:
        raise InvalidValueError("--recording and --plant exclude each other")
    if args.plant is not None and not args.plant.startswith("serial:"):
        raise InvalidValueError(
            f"--plant takes serial://PORT?gripper=URL, got {args.plant!r}; see docs/hardware.md"
        )
    stock = Stock(network=args.policy, recording=args.recording, plant=args.plant)
    if args.materials is not None:
        stock = replace(stock, materials=dict(thermal.load_materials(args.materials)))
    wanted: dict[str, Any] = {"materials": args.material, "mode": args.mode}
    if args.mesh is not None:
        stock = replace(stock, mesh=ObjectSpec(shape="mesh", mesh=args.mesh, scale=args.scale))
        wanted["shape"] = "mesh"
    choices = Choices().changed(wanted, stock)
    # What can't be read is refused here, not to each visitor.
    if args.policy is not None:
        load_network(args.policy)
    if args.recording is not None and args.record is None:
        PlayedGrasp(choices, stock)
    return stock, choices


def _record(args: argparse.Namespace, output: Output, stock: Stock, choices: Choices) -> int:
    from thermograsp.view.record import record_studio

    file = target(args.record, (".gif", ".webp", ".png"))
    assert file is not None
    if stock.recording is not None or stock.plant is not None:
        raise InvalidValueError("--record draws a simulation: leave --recording and --plant out")
    if positive("seconds", args.seconds) > 60.0:
        raise InvalidValueError(f"--record takes 60 s at most, got {args.seconds:g}")
    with output.progress(args.seconds) as advance:
        record_studio(file, choices, stock, args.seconds, lambda done: advance("grasping", done))
    output.line(f"wrote {args.record}")
    output.document({"materials": choices.materials, "mode": choices.mode, "record": args.record})
    return 0
