"""`thermograsp view`: the browser studio, on a local web page."""

from __future__ import annotations

import argparse
import asyncio
from typing import Any

from thermograsp.cli.opengl import load_mujoco
from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError

NAME = "view"
HELP = "Open the studio: a web page with the gripper in 3-D, live curves and all controls."

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
    add("--mode", default="T", help="T: element on the thermostat (default), O: on the object")
    add(
        "--host",
        default="127.0.0.1",
        help="address to listen on (default 127.0.0.1, this machine only); any other one gets a random token",
    )
    add("--port", type=int, default=_PORT, help=f"to listen on, 0 for any that is free (default {_PORT})")
    add("--visitors", type=int, default=4, help="pages at once, each with its own simulation (default 4)")
    add("--open", action="store_true", help="open the page in the browser of this machine")


def run(args: argparse.Namespace) -> int:
    """Serves until it is interrupted."""
    output = Output(args.json)
    load_mujoco(output)
    from thermograsp.view.access import Access
    from thermograsp.view.choices import Choices, Stock
    from thermograsp.view.server import Studio

    if not 0 <= args.port <= 65535:
        raise InvalidValueError(f"port must be 0 to 65535, got {args.port}")
    if args.visitors < 1:
        raise InvalidValueError(f"visitors must be at least 1, got {args.visitors}")
    stock = Stock()
    wanted: dict[str, Any] = {"materials": args.material, "mode": args.mode}
    studio = Studio(Access.to(args.host), stock, Choices().changed(wanted, stock), args.visitors)

    def started(url: str) -> None:
        output.line(f"thermograsp studio: {url}  (Ctrl-C ends it)")
        output.document({"url": url})
        if args.open:
            import webbrowser

            webbrowser.open(url)

    asyncio.run(studio.run(args.port, started))
    return 0
