"""What a fingertip touches of an object: the sensor's face, and each ring of the pad around it where heat knows one.

Boxes have closed forms, balls and cylinders tables of face and rings by force and place (thermal/pressed), and meshes
tables by force, made anew where they slip (slipped_mesh.py).

S: substeps, N: heat samples of a control step, F: fingertips.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ...thermal import material
from ...thermal.contact import (
    CONTACT_LAW,
    CURVED_TABLE,
    FLAT,
    FOOTPRINT_LAW,
    TABLE,
    TABLE_FORCES,
    beside_face,
    curved_contact,
    curved_table,
    curved_touch,
    flat_patch,
    footprint,
    gas_around,
    solid_conduction,
)
from ...thermal.padded import RINGS, ring_sides
from ...thermal.pressed import Ring, RoundRing
from ...touch.contacts import AREA, ASIDE, BESIDE, CLOSED, CONDUCTANCE, CURVED, FORCE, LENGTH, NORMAL, PLACE
from .grasp_body import PAD, GraspBody

_FIRST, _STEP = math.log(TABLE_FORCES[0]), math.log(TABLE_FORCES[1] / TABLE_FORCES[0])


class PadContact(NamedTuple):
    """What touch_pads takes of an object. law: (1,) FOOTPRINT_LAW of the face, and beside: (1,) CONTACT_LAW of a flat
    object under the pad. tables: (1 + RINGS, CURVED_TABLE) of face and rings on a ball or a cylinder, none of others.
    rings: (RINGS,) FOOTPRINT_LAW on a mesh, and lying: (9, 6) of it, see GraspBody.around_face. halves: (RINGS,) m,
    half the rings' outer sides. Without a pad there are none of rings, and halves is empty."""

    law: np.ndarray
    beside: np.ndarray
    tables: np.ndarray
    rings: np.ndarray
    lying: np.ndarray
    halves: np.ndarray


def pad_contact(body: GraspBody, step: tuple[int, ...] = (0, 0, 0, 0, 0)) -> PadContact:
    """Of an object that a fingertip is to touch. step: of a mesh, see slipped_mesh.py."""
    law, beside = np.zeros(1, FOOTPRINT_LAW), np.zeros(1, CONTACT_LAW)
    law[0], beside[0] = body.slipped_law(step) if any(step) else body.law, body.pad_law
    rings, sides = [], ()
    if body.surround is not None:
        made, sides = material(body.surround.material), ring_sides(body.stack.width, body.surround)
        rings = [Ring(made, *each) for each in pairwise((body.stack.width, *sides))]
    tables, laws, lying = np.zeros((0, CURVED_TABLE)), np.zeros(RINGS, FOOTPRINT_LAW), np.zeros((9, 6))
    if body.contact_shape in ("cylinder", "sphere"):
        radius, length = body.spec.size[0] / 2, body.spec.size[2]
        of_body = PAD, body.skin, body.material, radius, length if body.contact_shape == "cylinder" else None
        every = (curved_table(*of_body), *(_table(RoundRing(*of_body, ring)) for ring in rings))
        tables = np.stack(every)
    elif body.closed_mesh is not None:
        around, lying = body.around_face(step, rings)
        laws[: len(rings)] = around
    return PadContact(law, beside, tables, laws, np.ascontiguousarray(lying), np.array(sides) / 2)


@lru_cache(maxsize=128)
def _table(ring: RoundRing) -> np.ndarray:
    return ring.table()


@njit(cache=True, error_model="numpy")
def touch_pads(law, beside, tables, rings, lying, halves, normal, place, touches):
    """Fills touches (N, F, COLUMNS) of the pads that touch, as touch.contacts names its columns; a sample's sums are
    means over its substeps. normal: (S, 2) N. place: (2, 3) m, the pads' middles in the object's frame. The rest: a
    PadContact."""
    samples, tips, substeps = touches.shape[0], touches.shape[1], len(normal)
    at, areas, shares, through = np.empty(3), np.empty(RINGS), np.empty(4), np.empty(RINGS)
    touches[:] = 0.0
    for f in range(tips):
        square, along = 0.0, 0.0
        for i in range(3):
            between = place[1 - f, i] - place[f, i]
            square += between * between
            along += between * place[f, i]
        for i in range(3):
            at[i] = place[f, i]
            if law[0].shape != FLAT and square > 0.0:
                at[i] -= along / square * (place[1 - f, i] - place[f, i])
        for s in range(substeps):
            force = normal[s, f]
            if not force > 0.0:
                continue
            if len(tables) > 0:
                aside = math.sqrt(at[0] * at[0] + at[1] * at[1])
                conducts, area, long = curved_touch(tables[0], force, aside, at[2], shares)
                for ring in range(len(halves)):
                    through[ring], areas[ring], _ = curved_contact(tables[1 + ring], force, aside, at[2])
            elif law[0].shape == TABLE:
                area, load = footprint(law[0], force, at)
                conducts = solid_conduction(law[0], area, load, at, 0.0, 0.0)
                step = min(max((math.log(force) - _FIRST) / _STEP, 0.0), len(lying) - 1.0)
                k = min(int(step), len(lying) - 2)
                for side in range(4):
                    shares[side] = lying[k, 1 + side] + (step - k) * (
                        lying[k + 1, 1 + side] - lying[k, 1 + side]
                    )
                area *= lying[k, 5] + (step - k) * (lying[k + 1, 5] - lying[k, 5])
                long = (lying[k, 0] + (step - k) * (lying[k + 1, 0] - lying[k, 0])) * math.sqrt(area)
                for ring in range(len(halves)):
                    areas[ring], load = footprint(rings[ring], force, at)
                    through[ring] = solid_conduction(rings[ring], areas[ring], load, at, 0.0, 0.0)
            else:
                area, load = footprint(law[0], force, at)
                gas, spread = gas_around(law[0], force, at)
                conducts = solid_conduction(law[0], area, load, at, gas, spread) + gas
                long = 0.0
                if area > 0.0:
                    long = flat_patch(law[0], area, at, 2 * law[0].half_face, shares)
                if len(halves) > 0:
                    even = beside_face(beside[0], halves, force, at, areas)
                    for ring in range(len(halves)):
                        through[ring] = even * areas[ring]
            for k in range(s * samples // substeps, samples):  # as kernel.py's _share
                part = min((s + 1) * samples, (k + 1) * substeps) - max(s * samples, k * substeps)
                if part <= 0:
                    break
                touch, weight = touches[k, f], part / substeps
                if conducts > 0.0:
                    touch[CONDUCTANCE] += weight * conducts
                    touch[AREA] += weight * area
                    touch[LENGTH] += weight * area * long
                    touch[CLOSED] += weight
                    for side in range(4):
                        touch[ASIDE + side] += weight * area * shares[side]
                for ring in range(len(halves)):
                    if through[ring] > 0.0:
                        touch[BESIDE + 3 * ring] += weight * through[ring]
                        touch[BESIDE + 3 * ring + 1] += weight * areas[ring]
                        touch[BESIDE + 3 * ring + 2] += weight
                if law[0].shape != FLAT:
                    touch[CURVED] += weight
                touch[FORCE] += weight * force
                for i in range(3):
                    touch[PLACE + i] = place[f, i]
                    touch[NORMAL + i] = (place[1 - f, i] - place[f, i]) / math.sqrt(square)
