"""How warm the sensor's face is where an object touches it and where none does: maps of temperature, drawn small."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import to_hex

from thermograsp.envs import GraspEnv, ObjectSpec, action_of
from thermograsp.envs.footprint import PAD
from thermograsp.envs.pictures import temperature_colour
from thermograsp.figures.pressure_maps import FORCE, map_figure

PARTS = (18, 18)
RANGE = (24.0, 36.0)  # °C, of the colours, from the object's at first to the thermostat's
MATERIAL = "aluminium"
_SECONDS = 2.4  # of closing and holding
_OBJECTS = {
    "cube": ObjectSpec(),
    "cube, off to one side": ObjectSpec(position=(0.0, 0.018)),
    "bar, 5 mm wide": ObjectSpec(size=(0.04, 0.005, 0.04)),
    "ball": ObjectSpec(shape="sphere"),
}


@dataclass(frozen=True, slots=True)
class Touch:
    """What the left fingertip feels of an object held with FORCE: pressure (n, m) Pa over the pad and celsius (n, m) °C
    over the sensor's face, row 0 at the fingertip's end."""

    name: str
    pressure: np.ndarray
    celsius: np.ndarray


def touches() -> list[Touch]:
    """Things of MATERIAL at 24 °C, held for a second and a half."""
    return [_touched(name, spec) for name, spec in _OBJECTS.items()]


def face_section(shown: Sequence[Touch]) -> str:
    """A section of the demonstration's page."""
    low, high = RANGE
    return (
        "<section><h2>How warm the sensor’s face is</h2>"
        f'<p class="note">Temperature over the face of the left heat flux sensor, {1e3 * PAD.face:.0f} mm wide, on '
        f"things of {MATERIAL} at 24 °C: with <code>face_temperature=(18, 18)</code> an observation. Dark is "
        f"{low:.0f} °C, bright {high:.0f} °C. The thermostat behind it has 36 °C; what touches cools its place.</p>"
        f'<div class="maps">{"".join(_map(touch) for touch in shown)}</div></section>'
    )


def _touched(name: str, spec: ObjectSpec) -> Touch:
    env = GraspEnv(
        material=MATERIAL,
        objects=spec,
        skin=None,  # the same fingertip for every shape
        taxels=(20, 20),
        face_temperature=PARTS,
        placement=(0.0, 0.0),
        seconds=2 * _SECONDS,
    )
    seen, _ = env.reset(seed=0)
    for _ in range(round(_SECONDS / env.dt)):
        seen, *_ = env.step(action_of(opening=0.0, force_limit=FORCE, lift_rate=0.0))
    env.close()
    return Touch(name, seen["pressure"][0], seen["face_temperature"][0])


def _map(touch: Touch) -> str:
    rows, columns = touch.celsius.shape
    upright = touch.celsius[::-1]  # the wrist's side on top
    colours = temperature_colour(upright, *RANGE)
    squares = "".join(
        f'<rect x="{j}" y="{i}" width="1.02" height="1.02" fill="{to_hex(colours[i, j])}"/>'
        for i in range(rows)
        for j in range(columns)
    )
    squares = f'<g shape-rendering="crispEdges">{squares}</g>'
    reads = f"{upright.min():.1f} to {upright.max():.1f} °C"
    return map_figure(touch.name, "Temperature over the sensor's face", (rows, columns), squares, "", reads)
