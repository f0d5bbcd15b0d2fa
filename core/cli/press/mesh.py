"""`thermograsp press --mesh`: an object from a file, touched in the middle of one of its sides."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.thermal import Material, Press, Thermostat

SIDES = {
    "top": (0, 0, 1),
    "bottom": (0, 0, -1),
    "right": (1, 0, 0),
    "left": (-1, 0, 0),
    "back": (0, 1, 0),
    "front": (0, -1, 0),
}
"""Name -> outward direction, in the file's frame."""

_AREA = 81e-6  # m2
_SCALE, _SIDE = 1.0, "top"
PLATES = {
    "mode": "T",
    "shape": "square",
    "rung": "auto",
    "opposite": None,
    "surround": None,
    "surround_conductance": None,
    "object_size": (0.04, 0.04, 0.01),
}
"""Defaults of the keywords that only `press` has."""

KEYWORDS = (
    "sensor",
    "conductance",
    "force",
    "air",
    "sensor_temperature",
    "object_temperature",
    "seconds",
    "dt",
    "tolerance",
    "skin",
)
"""Those that `press` and `press_body` share."""


def add_mesh_arguments(parser: argparse.ArgumentParser) -> None:
    """--mesh, --scale and --side."""
    add = parser.add_argument
    add(
        "--mesh",
        metavar="FILE",
        help="mesh file of the object, pressed instead of a plate: .stl, .obj, .ply or .glb",
    )
    add("--scale", type=float, help=f"metres per unit of length in the mesh file (default: {_SCALE:g})")
    add(
        "--side",
        choices=tuple(SIDES),
        help=f"side of the mesh that is pressed, in its middle (default: {_SIDE})",
    )


def refuse_mesh_arguments(args: argparse.Namespace) -> None:
    """Raises InvalidValueError for what only meshes have, where a plate is pressed."""
    for name in ("scale", "side"):
        if getattr(args, name) is not None:
            raise InvalidValueError(f"--{name} is for meshes: give --mesh FILE too, or leave it out")


def press_mesh(args: argparse.Namespace, material: Material, thermostat: Thermostat | None) -> Press:
    """Presses the object in the file. Raises InvalidValueError for arguments that only plates have, and MeshError."""
    import numpy as np

    from thermograsp import thermal
    from thermograsp.envs.bodies import read_surface
    from thermograsp.errors import positive

    for name, default in PLATES.items():
        if getattr(args, name) != default:
            raise InvalidValueError(f"--{name.replace('_', '-')} is for plates: leave it out with --mesh")
    scale = _SCALE if args.scale is None else positive("scale", args.scale)
    towards = SIDES[_SIDE if args.side is None else args.side]
    surface = read_surface(args.mesh)
    vertices = surface.vertices * scale
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    outward = np.array(towards)
    x, y, z = ((low + high + outward * (high - low)) / 2).tolist()
    return thermal.press_body(
        thermal.solid(vertices, surface.faces, material),
        thermal.SurfacePatch((x, y, z), towards, _AREA if args.area is None else args.area),
        thermostat=thermostat,
        cache=not args.no_cache,
        **{name: getattr(args, name) for name in KEYWORDS},
    )
