"""`thermograsp materials`: the table of materials, and comparisons with the sources of every number."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, add_materials_file, add_old_name
from thermograsp.errors import unknown_name

if TYPE_CHECKING:
    from thermograsp.thermal import Material

NAME = "materials"
HELP = "List materials, or compare some of them and show the sources of their numbers."

_SORTS = ("effusivity", "diffusivity", "conductivity", "density", "specific_heat", "name", "family")
_HEADER = ("material", "family", "k", "rho", "c", "effusivity", "diffusivity")
_LEGEND = (
    "k W/(m K), rho kg/m3, c J/(kg K), effusivity sqrt(k rho c) W s^0.5/(m2 K), diffusivity k/(rho c) mm2/s"
)
_UNITS = {
    "conductivity": "W_mK",
    "density": "kg_m3",
    "specific_heat": "J_kgK",
    "effusivity": "Ws05_m2K",
    "diffusivity": "m2_s",
    "youngs_modulus": "Pa",
    "poisson_ratio": "",
    "microhardness": "Pa",
    "roughness": "m",
    "asperity_slope": "",
    "friction": "",
    "crushing_stress": "Pa",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="names of the materials to compare (default: a list of all)"
    )
    add_old_name(parser, "--file", add_materials_file(parser))
    parser.add_argument(
        "--sort", default="effusivity", metavar="PROPERTY", help=f"property to sort by: {', '.join(_SORTS)}"
    )


def run(args: argparse.Namespace) -> int:
    """Prints the table."""
    from thermograsp import thermal

    known = thermal.load_materials(args.materials) if args.materials else thermal.materials()
    for name in args.names:
        if name not in known:
            raise unknown_name("material", name, known)
    if args.sort not in _SORTS:
        raise unknown_name("property", args.sort, _SORTS)
    chosen = sorted((known[name] for name in args.names or known), key=lambda one: getattr(one, args.sort))
    output = Output(args.json)
    output.table(_HEADER, [_row(one) for one in chosen])
    output.line(_LEGEND)
    if args.names:
        _sources(output, chosen)
    output.document({"materials": [_document(one) for one in chosen]})
    return 0


def _row(one: Material) -> tuple[str, ...]:
    return (
        one.name,
        one.family,
        f"{one.conductivity:.3g}",
        f"{one.density:.0f}",
        f"{one.specific_heat:.0f}",
        f"{one.effusivity:.0f}",
        f"{1e6 * one.diffusivity:.3g}",
    )


def _sources(output: Output, chosen: Sequence[Material]) -> None:
    """Each citation once, with what was taken from it."""
    taken: dict[str, dict[str, list[str]]] = {}
    for one in chosen:
        for prop, citation in one.sources.items():
            taken.setdefault(citation, {}).setdefault(one.name, []).append(prop)
    for citation, uses in taken.items():
        output.line(f"\n{citation}")
        for name, props in uses.items():
            output.line(f"  {name}: {', '.join(props)}")


def _document(one: Material) -> Mapping[str, Any]:
    values = {"name": one.name, "family": one.family}
    for prop, unit in _UNITS.items():
        value = getattr(one, prop)
        if value is not None:
            values[f"{prop}_{unit}" if unit else prop] = value
    return {**values, "sources": dict(one.sources)}
