"""`thermograsp view`: the browser studio, on a local web page."""

from __future__ import annotations

import argparse
import asyncio
import os
import tempfile
import webbrowser
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, add_materials_file, add_mode, add_old_name, load_mujoco, target
from thermograsp.errors import InvalidValueError, MissingDependencyError, positive
from thermograsp.opengl import has_display

if TYPE_CHECKING:
    from thermograsp.studio.control import Choices, Stock

NAME = "view"
HELP = "Open the studio, a web page with the gripper in 3-D, live curves and all controls, or record what it shows."

_PORT = 8421
_SCALE = 1.0
_TOKEN_VARIABLE = "THERMOGRASP_TOKEN"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "--material",
        nargs="+",
        default=["glass"],
        metavar="NAME",
        help="name of the object's material, or of two to see side by side",
    )
    add_materials_file(parser)
    add_mode(parser)
    add("--mesh", metavar="FILE", help="mesh file of one more object to choose: .stl, .obj, .ply or .glb")
    add("--scale", type=float, help=f"metres per unit of length in the mesh file (default: {_SCALE:g})")
    add(
        "--policy",
        metavar="FILE",
        help="policy for the driver Learnt, an .npz file (default: the package's)",
    )
    add(
        "--model",
        metavar="XML",
        help="MuJoCo scene of your own to open in MuJoCo's viewer, with what its fingertips feel",
    )
    add(
        "--fingertips",
        nargs="+",
        default=[],
        metavar="NAME",
        help="names of the geoms, sites or bodies that feel heat, with --model",
    )
    add(
        "--objects",
        nargs="+",
        default=[],
        metavar="NAME=MATERIAL",
        help="objects and their materials, in addition to those that the scene describes, with --model",
    )
    add(
        "--recording",
        metavar="CSV",
        help="table to play instead of a simulation, as `grasp`, `press` or `device replay` writes it",
    )
    add(
        "--plant",
        metavar="URL",
        help="real gripper to drive instead of a simulation, serial://PORT?gripper=URL; allows one page at a time",
    )
    add(
        "--host",
        default="127.0.0.1",
        help="address to listen on; 127.0.0.1 lets only this machine connect",
    )
    add("--port", type=int, default=_PORT, help="TCP port to listen on; 0 for any that is free")
    add(
        "--visitors",
        type=int,
        default=4,
        help="number of pages that may be open at once, each with its own simulation",
    )
    add("--open", action="store_true", help="open the page in this machine's browser")
    render = add(
        "--render", metavar="FILE", help="write a grasp as .gif, .webp or .png and exit; needs no display"
    )
    add_old_name(parser, "--record", render)
    add("--seconds", type=float, default=6.0, help="length of the film, s, with --render")


def run(args: argparse.Namespace) -> int:
    """Serves until it is interrupted, or records."""
    output = Output(args.json)
    load_mujoco(output)
    if args.model is not None:
        return _scene(args, output)
    if args.fingertips or args.objects:
        raise InvalidValueError("--fingertips and --objects go with --model, a scene of your own")
    stock, choices = _start(args)
    if args.render is not None:
        return _record(args, output, stock, choices)
    if not 0 <= args.port <= 65535:
        raise InvalidValueError(f"port must be 0 to 65535, got {args.port}")
    if args.visitors < 1:
        raise InvalidValueError(f"visitors must be at least 1, got {args.visitors}")
    from thermograsp.studio.web import Access, Studio

    access = Access.to(args.host, os.environ.get(_TOKEN_VARIABLE, ""))
    studio = Studio(access, stock, choices, 1 if args.plant else args.visitors)

    with ExitStack() as leaving:

        def started(url: str) -> None:
            output.line(f"thermograsp studio: {url}  (Ctrl-C ends it)")
            output.document({"url": url})
            if args.open:
                webbrowser.open(leaving.enter_context(_leading_to(url)).as_uri())

        asyncio.run(studio.run(args.port, started))
    return 0


def _scene(args: argparse.Namespace, output: Output) -> int:
    """A scene of the user's, in MuJoCo's viewer or as a picture."""
    from thermograsp.cli.view.scene import opened_scene, picture, watch

    path = target(args.render, (".png",))
    model, data, touch = opened_scene(Path(args.model), args.fingertips, args.objects)
    if path is None:
        if not has_display():  # MuJoCo's viewer would end the process
            raise MissingDependencyError(
                "no display to open MuJoCo's viewer on; write a picture by --render FILE, or set DISPLAY to a running "
                "X server"
            )
        watch(model, data, touch)
        return 0
    picture(model, data, touch, positive("--seconds", args.seconds), path)
    output.line(f"wrote {path}")
    output.document({"written": str(path)})
    return 0


@contextmanager
def _leading_to(url: str) -> Iterator[Path]:
    """A page that leads there, of which others can't read a word: everybody sees what a browser is started with."""
    with tempfile.TemporaryDirectory(prefix="thermograsp-") as folder:  # ours alone
        page = Path(folder) / "studio.html"
        page.write_text(f'<meta http-equiv="refresh" content="0; url={url}">', encoding="utf-8")
        yield page


def _start(args: argparse.Namespace) -> tuple[Stock, Choices]:
    """What visitors may choose, and what they find chosen."""
    from thermograsp import thermal
    from thermograsp.agents import load_policy
    from thermograsp.envs import ObjectSpec
    from thermograsp.studio.control import Choices, Stock
    from thermograsp.studio.sources import PlayedGrasp

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
    if args.mesh is None and args.scale is not None:
        raise InvalidValueError("--scale is for meshes: give --mesh FILE too, or leave it out")
    if args.mesh is not None:
        scale = _SCALE if args.scale is None else args.scale
        stock = replace(stock, mesh=ObjectSpec(shape="mesh", mesh=args.mesh, scale=scale))
        wanted["shape"] = "mesh"
    choices = Choices().changed(wanted, stock)
    # What can't be read is refused here, not to each visitor.
    if args.policy is not None:
        load_policy(args.policy)
    if args.recording is not None and args.render is None:
        PlayedGrasp(choices, stock)
    return stock, choices


def _record(args: argparse.Namespace, output: Output, stock: Stock, choices: Choices) -> int:
    from thermograsp.studio.session import record_studio

    file = target(args.render, (".gif", ".webp", ".png"))
    assert file is not None
    if stock.recording is not None or stock.plant is not None:
        raise InvalidValueError("--render draws a simulation: leave --recording and --plant out")
    if positive("seconds", args.seconds) > 60.0:
        raise InvalidValueError(f"--render takes 60 s at most, got {args.seconds:g}")
    with output.progress(args.seconds) as advance:
        record_studio(file, choices, stock, args.seconds, lambda done: advance("grasping", done))
    output.line(f"wrote {args.render}")
    output.document({"materials": choices.materials, "mode": choices.mode, "record": args.render})
    return 0
