"""What the pads feel of an object's shape: maps of pressure, drawn small."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from thermograsp.envs import Mechanics, ObjectSpec, library_object
from thermograsp.envs.footprint import PAD, Taxels
from thermograsp.figures.look import readable

TAXELS = (20, 20)
FORCE = 10.0  # N
_SECONDS = 1.4  # of closing, until nothing moves any more
_OBJECTS = ("drinks_can", "copper_tube", "egg", "wrench")
_EDGE = "cube, off to one side"
_AWAY = 0.016  # m


@dataclass(frozen=True, slots=True)
class Press:
    """The left pad's map (n, m) Pa of an object held with FORCE, row 0 at the fingertip's end."""

    name: str
    pressure: np.ndarray

    @property
    def force(self) -> float:
        """N, the map's sum."""
        return float(self.pressure.mean() * PAD.width**2)


def presses() -> list[Press]:
    """A cube, the same partly beside the pad, and some objects of the library, each held until it is still."""
    cube = ObjectSpec()
    specs = {"cube": cube, _EDGE: ObjectSpec(position=(0.0, _AWAY))}
    specs |= {name: library_object(name).spec() for name in _OBJECTS}
    taxels = Taxels(TAXELS)
    return [Press(name, _held(taxels, spec)) for name, spec in specs.items()]


def pressure_section(shown: Sequence[Press]) -> str:
    """A section of the demonstration's page."""
    return (
        "<section><h2>What the pads feel of a shape</h2>"
        f'<p class="note">Pressure over the left pad, {1e3 * PAD.width:.0f} mm wide, at {FORCE:.0f} N: with '
        "<code>taxels=(20, 20)</code> an observation. Full colour is each map’s highest pressure; the small square is "
        "the heat flux sensor’s face. The pad is an elastic foundation, and a map adds up to the force.</p>"
        f'<div class="maps">{"".join(_map(press) for press in shown)}</div></section>'
    )


def _held(taxels: Taxels, spec: ObjectSpec) -> np.ndarray:
    mechanics = Mechanics((spec,), contacts=True)
    for _ in range(round(_SECONDS / 0.02)):
        mechanics.advance(np.zeros(1), np.full(1, FORCE), np.zeros(1))
    return taxels.pressure(mechanics)[0, 0]


def _map(press: Press) -> str:
    rows, columns = press.pressure.shape
    highest = press.pressure.max()
    shares = press.pressure[::-1] / highest  # the wrist's side on top
    squares = "".join(
        f'<rect x="{j}" y="{i}" width="1" height="1" fill-opacity="{shares[i, j]:.2f}"/>'
        for i, j in np.argwhere(shares > 0.005)
    )
    side = columns * PAD.face / PAD.width
    corner = (columns - side) / 2
    return map_figure(
        press.name,
        "Pressure over the pad",
        (rows, columns),
        f'<g class="press">{squares}</g>',
        f'<rect class="face" x="{corner:.2f}" y="{corner:.2f}" width="{side:.2f}" height="{side:.2f}"/>',
        f"{1e-3 * highest:.0f} kPa",
    )


def map_figure(name: str, what: str, shape: tuple[int, int], squares: str, over: str, reads: str) -> str:
    """A map of `shape` (rows, columns) on the object of that name. squares: the map, and over: what lies on its
    outline, as SVG. reads: its figures."""
    (rows, columns), name = shape, escape(readable(name))
    return (
        f'<figure><svg viewBox="-0.5 -0.5 {columns + 1} {rows + 1}" role="img" aria-label="{escape(what)} on the '
        f'{name}">{squares}<rect class="pad" width="{columns}" height="{rows}"/>{over}</svg>'
        f'<figcaption class="reads"><span>{name}</span><span>{reads}</span></figcaption></figure>'
    )
