"""The numbers handed to the plugin: fingertips, objects, laws and tables in one row of float64, as numbers.c reads it.

F: fingertips, O: objects, G: geoms of the objects, N = G + F: what a pad may meet, T = O + F: targets, M: patterns.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import prod

import mujoco
import numpy as np

from ...thermal.contact import FIRST_FORCE, FORCE_STEP, LEAST_CURVED, LOG_LEAST, LOG_MOST, SEPARATION
from ...thermal.kernels import ALONG, GRAM, GRASP, JUMPS, NODES, OF_GRASP, TIMES, TO_MOMENTS, before
from ...thermal.network import POLES, WEIGHTS
from ...thermal.numerics import HIGH, LOW
from ..contacts import BOND, GluedContacts, bends, curves, pair_laws
from ..heat import (
    Pinched,
    TipField,
    Wall,
    crossing_rate,
    face_modes,
    kinds_of,
    narrow_tables,
    resolution,
    tip_field,
    untouched,
    wall_of,
)
from ..scene import BodyShape, PadPlace
from .backs import back_rows

_VERSION = 20


def packed(
    model: mujoco.MjModel,
    pads: Sequence[PadPlace],
    glued: Sequence[PadPlace],
    shapes: Sequence[BodyShape],
    *,
    steps: int,
    tolerance: float,
    film: float,
    ambient: float,
) -> str:
    """The attribute "numbers". steps: of the model in a sample of heat. tolerance: K. film: W/(m2 K) of the air at
    `ambient` °C. glued: the elements on objects, sensors behind the fingertips'."""
    level, sensors = resolution(tolerance), (*pads, *glued)
    fields = [tip_field(pad, level) for pad in sensors]
    tips = [field.tip for field in fields]
    most = max(1, *(len(tip.side.rates) for tip in tips))
    owner = [o for o, shape in enumerate(shapes) for _ in shape.geoms]
    roles = np.concatenate([np.full(len(pad.geoms), f) for f, pad in enumerate(pads)])
    # a piece has the number of the geom behind it, which is the last of that number: the one that is felt
    parts = np.cumsum([0, *(len(shape.geoms) for shape in shapes)])
    for first, shape in zip(parts, shapes, strict=False):
        numbers = [0] * len(shape.pieces) + list(range(len(shape.geoms)))
        roles = np.concatenate((roles, len(pads) + first + np.array(numbers)))
    timestep = float(model.opt.timestep)
    nodes, backs = back_rows(sensors, fields, timestep * steps, ambient)
    found = pair_laws(model, pads, shapes)
    laws, curved, tilts, views, viewed = found.laws, found.curved, found.tilts, found.views, found.viewed
    tables = found.all_tables
    across = [(pad, side) for pad in sensors for side in _across(shapes, sensors, pad.stack.width)]
    narrow, ripples, spread = narrow_tables(across, level, timestep * steps)
    spread = spread.reshape(-1, 6, 2)
    glued_contacts = GluedContacts(pads, glued, len(shapes), 1)
    header = (
        *(_VERSION, len(sensors), len(shapes), len(owner), level.patterns, level.rates, most, steps),
        *(timestep, timestep * steps, level.least, len(roles), len(tables), views.shape[1], nodes, len(pads)),
        len(narrow),
    )
    every = (
        header,
        roles,
        owner,
        *((*pad.position, *pad.axes.T.ravel(), *pad.half_sides, pad.stack.width) for pad in sensors),
        kinds_of(sensors),
        *(_box(shape, film, ambient) for shape in shapes),
        _columns(laws),
        curved,
        views,
        viewed,
        found.radii,
        tilts,
        tables,
        narrow,
        ripples,
        np.column_stack((spread[:, 0, 0], spread[..., 1])),
        *(face_modes(pad, level) for pad in sensors),
        bends(pads),
        curves(model, pads, shapes),
        [
            (each.glued or 0, small, BOND * each.stack.width**2)
            for each, small in zip(glued, glued_contacts.small, strict=True)
        ],
        _columns(glued_contacts.laws),
        [0.0 if pad.glued is None else shapes[pad.glued].temperature - ambient for pad in sensors],
        [pad.stack.seebeck for pad in sensors],
        *backs,
        [tip.area for tip in tips],
        [_row(tip.side.rates, most) for tip in tips],
        *(_row(port, most) for field in fields for side in _faces(field, glued) for port in side.T),
        *([_row(tip.side.outputs[name], most) for tip in tips] for name in ("drop", "element")),
        [_row(field.uniform, most) for field in fields],
        *(tip.basis for tip in tips),
        *(tip.weight for tip in tips),
        level.decay,
        *(TIMES, TO_MOMENTS[OF_GRASP], GRASP, NODES, JUMPS, ALONG, GRAM),
        *(_pairs(POLES), _pairs(WEIGHTS)),
        (FIRST_FORCE, FORCE_STEP, LEAST_CURVED),
        *(SEPARATION, (2 / (HIGH - LOW), (HIGH + LOW) / (HIGH - LOW), LOG_LEAST, LOG_MOST)),
    )
    return np.concatenate([np.ravel(part) for part in every]).astype(">f8").tobytes().hex()


def _across(
    shapes: Sequence[BodyShape], sensors: Sequence[PadPlace], width: float
) -> Iterator[Wall | Pinched | PadPlace]:
    """What a sensor of that width m touches across each of the three axes of every target, and then where all of it is
    pressed from behind."""
    for shape in shapes:
        for by in (0.0, 1.0):
            yield from (wall_of(shape.material, 1.0, side, width, by) for side in shape.size.tolist())
    for sensor in sensors:
        yield from (sensor,) * 6


def _box(shape: BodyShape, film: float, ambient: float) -> tuple[float, ...]:
    bare, matter = untouched(shape, film), shape.material
    diffusivity = matter.conductivity / matter.volumetric_heat_capacity
    return (
        *(*shape.size, *shape.extent, *shape.centre, *shape.axes.ravel()),
        *(matter.conductivity, matter.volumetric_heat_capacity),
        *(bare.rates[0], crossing_rate(shape), (shape.temperature - ambient) * bare.heat[0]),
        before(diffusivity) / matter.volumetric_heat_capacity,
    )


def _faces(field: TipField, glued: Sequence[PadPlace]) -> tuple[np.ndarray, ...]:
    """The ports of a sensor's network: for what it is on, and where there are elements for what is on it."""
    return (field.tip.side.ports, field.face) if glued else (field.tip.side.ports,)


def _columns(laws: np.ndarray) -> np.ndarray:
    """(laws, numbers) of records."""
    parts = [laws[name] for name in laws.dtype.names or ()]
    return np.concatenate([part.reshape(laws.size, prod(part.shape[laws.ndim :])) for part in parts], axis=1)


def _row(values: np.ndarray, length: int) -> np.ndarray:
    """With zeros behind it."""
    return np.pad(values, (0, length - len(values)))


def _pairs(values: np.ndarray) -> np.ndarray:
    """Real and imaginary parts in turn."""
    return np.stack((values.real, values.imag), axis=1)
