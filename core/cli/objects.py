"""`thermograsp objects`: the library of everyday objects that environments take by name."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, load_mujoco

if TYPE_CHECKING:
    from thermograsp.envs import ObjectPreset

NAME = "objects"
HELP = "List the everyday objects that `thermograsp grasp --object` and the environments take by name."

_HEADER = ("object", "what", "material", "mm", "g", "degC", "N")
_LEGEND = "mm between the fingers, g with contents, degC at first, N on each pad that holds it with a margin"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="names of the objects to list (default: all)"
    )


def run(args: argparse.Namespace) -> int:
    """Prints the table."""
    output = Output(args.json)
    load_mujoco(output)
    from thermograsp.envs import library_object, objects

    chosen = [library_object(name) for name in args.names or objects()]
    rows = [_document(preset) for preset in chosen]
    output.table(_HEADER, [_row(preset, row) for preset, row in zip(chosen, rows, strict=True)])
    output.line(_LEGEND)
    output.document({"objects": rows})
    return 0


def _row(preset: ObjectPreset, row: Mapping[str, Any]) -> tuple[str, ...]:
    return (
        preset.name,
        preset.about,
        " + ".join((preset.material, *(part.material for part in preset.parts))),
        f"{1e3 * row['width_m']:.1f}",
        f"{1e3 * row['mass_kg']:.0f}",
        f"{preset.temperature:.0f}",
        f"{row['grip_force_N']:.1f}",
    )


def _document(preset: ObjectPreset) -> dict[str, Any]:
    spec = preset.spec()
    return {
        "name": preset.name,
        "about": preset.about,
        "material": preset.material,
        "shape": spec.shape,
        "width_m": spec.width,
        "size_m": list(spec.size),
        "mass_kg": spec.weight,
        "temperature_degC": preset.temperature,
        "grip_force_N": preset.grip_force,
        "contents": preset.contents.material if preset.contents else None,
        "parts": [part.material for part in preset.parts],
        "mesh": spec.mesh,
    }
