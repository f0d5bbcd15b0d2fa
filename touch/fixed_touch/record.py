"""Contacts from recorded sensordata.

B: worlds, F: fingertips, G: geoms of the objects, H: substeps, L: forces of a pair.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal.numerics import Array, as_integers, as_like, namespace_of
from ..contacts import FORCE_AT, PLACE_AT, SensorPlaces, TouchContacts
from ..scene import PadPlace


class RecordPlaces(NamedTuple):
    """Where sensordata holds the contacts. force, place: (F, G, L, 3) integers; whole: (F, G, L, 1), 0 where there is
    no sensor. bodies: (bodies, 7) integers of positions and quaternions; tip: (F,), geom: (G,) which of the bodies.
    offset: (G, 3) m and turn: (G, 3, 3) of the geoms in their bodies. size: of sensordata."""

    force: Array
    place: Array
    whole: Array
    bodies: Array
    tip: Array
    geom: Array
    offset: Array
    turn: Array
    size: int


def recorded_contacts(places: RecordPlaces | None, record: Array) -> TouchContacts:
    """The contacts of recorded sensordata (B, H, sensordata), or (B, sensordata) of one substep, of a model that
    touch.prepare has made. Raises InvalidValueError for another model or shape."""
    if places is None:
        raise InvalidValueError(
            "this model has no contact sensors for its fingertips and objects: make it by "
            "thermograsp.touch.prepare(spec, fingertips, objects), or fill a TouchContacts"
        )
    if getattr(record, "ndim", 0) not in (2, 3) or record.shape[-1] != places.size:
        found = tuple(record.shape) if hasattr(record, "shape") else type(record).__name__
        raise InvalidValueError(
            f"a record must have the shape (worlds, substeps, {places.size}), got {found}"
        )
    if record.ndim == 2:
        record = record[:, None]
    xp = namespace_of(record)
    poses = record[..., places.bodies]  # (B, H, bodies, 7)
    a, b, c, d = (poses[..., 3 + k] for k in range(4))
    rows = (
        (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
    )
    turn = xp.stack([xp.stack(row, -1) for row in rows], -2)
    position = poses[..., :3]
    of_geom = turn[:, :, places.geom]
    return TouchContacts(
        record[..., places.force] * places.whole,
        record[..., places.place] * places.whole,
        position[:, :, places.tip],
        turn[:, :, places.tip],
        position[:, :, places.geom] + (of_geom * places.offset[:, None, :]).sum(-1),
        (of_geom[..., :, :, None] * places.turn[:, None, :, :]).sum(-2),
    )


def record_places(places: SensorPlaces, pads: Sequence[PadPlace], geoms: int, like: Array) -> RecordPlaces:
    """Of pads on the first so many geoms, those of the objects, as integers of the library of `like`."""
    tips = len(pads)
    of_objects = [(f, g, at) for f, g, at in places.pairs.tolist() if g < geoms]
    most = max(Counter((f, g) for f, g, _ in of_objects).values(), default=1)
    address, count = np.full((tips, geoms, most), -1), np.zeros((tips, geoms), int)
    for f, g, at in of_objects:
        address[f, g, count[f, g]] = at
        count[f, g] += 1
    sides = np.maximum(address, 0)[..., None] + np.arange(3)
    bodies = places.poses[:, 0].tolist()
    rows = places.poses[:, [1, 1, 1, 2, 2, 2, 2]] + np.array([0, 1, 2, 0, 1, 2, 3])

    def integers(values: np.ndarray | Sequence[int]) -> Array:
        return as_integers(as_like(np.asarray(values, float), like))

    return RecordPlaces(
        integers(sides + FORCE_AT),
        integers(sides + PLACE_AT),
        as_like((address >= 0)[..., None].astype(float), like),
        integers(rows),
        integers([bodies.index(pad.body) for pad in pads]),
        integers([bodies.index(body) for _, body in places.geoms.tolist()]),
        as_like(places.offsets, like),
        as_like(places.turns.reshape(-1, 3, 3), like),
        places.size,
    )
