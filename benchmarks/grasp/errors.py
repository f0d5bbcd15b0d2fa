"""How well a grasp held, what its contact record is off by, and what that does to the temperature drop.

Shapes as in course.py. Nothing here depends on how fast the machine is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermograsp.bench.grasp.course import (
    FORCE,
    MATERIAL,
    PERIOD,
    Grasp,
    end_of,
)
from thermograsp.envs.bodies import ObjectSpec
from thermograsp.envs.footprint import GraspBody
from thermograsp.envs.sensing import FieldHeat, GraspHeat
from thermograsp.thermal import material, sensor

HELD, JAMS, DROPPED, EJECTED, BROKEN = "held", "jams", "dropped", "ejected", "breaks down"
FATES = (HELD, JAMS, DROPPED, EJECTED, BROKEN)
"""From best to worst. jams: held, but with more than a fifth too much or too little force in the end. dropped: not
between both fingertips in the end, or on the table. ejected: faster than 1 m/s above the table, which nothing reaches
that falls from the gripper. breaks down: MuJoCo warns of numbers that are not finite or of a matrix that it cannot
factor."""
METRICS = {"slip": "mm", "force": "N", "force_reference": "N", "jitter": "um", "drop": "K", "drop_late": "K"}
"""Errors and their units."""
FIRST, LATE = 0.05, 0.5
"""s after the touch, from which `drop` and `drop_late` are taken."""
_JAM, _FAST, _OFF = 0.2, 1.0, 0.001  # of the force; m/s; m over its rest that a held object is in the end
_SENSOR, _OBJECT = 36.0, 24.0  # degC
_SAMPLES = 2  # of heat in a control step


@dataclass(frozen=True, slots=True)
class Errors:
    """What B grasps of one shape amount to. fate: the worst of them. Where all are held, else nan:

    slip: mm, farthest that an object moved against the gripper from the end of lifting to the end.
    force: N, RMS over substeps, fingertips and grasps of the normal force less the command, from the end of lifting on.
    force_reference: N, RMS of the normal force's means over control steps less the reference's, all the time.
    jitter: um, RMS scatter within control steps of the contact's centroid less the reference's, from the end of
    lifting on. drop: K, largest difference of a temperature drop from the reference's at the same time, from 0.05 s
    after the touch on, median over grasps and fingertips; drop_late: the same from 0.5 s on.
    """

    fate: str
    slip: float = np.nan
    force: float = np.nan
    force_reference: float = np.nan
    jitter: float = np.nan
    drop: float = np.nan
    drop_late: float = np.nan


def fates(grasp: Grasp) -> list[str]:
    """The fate of every placement."""
    end = grasp.normal[end_of("shake") :].mean(axis=2)  # (K, B, T)
    speed = np.linalg.norm(np.diff(grasp.offset, axis=0), axis=-1) / PERIOD
    fast = ((speed > _FAST) & (grasp.height[1:] > 0)).any(axis=0)
    on_table = grasp.height[-1] - grasp.height[0] < _OFF
    lost = (end <= 0).any(axis=(0, 2)) | on_table
    jammed = (np.abs(end.mean(axis=0) - FORCE) > _JAM * FORCE).any(axis=1)
    kinds = zip(grasp.failed, fast, lost, jammed, strict=True)
    return [BROKEN if b else EJECTED if f else DROPPED if d else JAMS if j else HELD for b, f, d, j in kinds]


class HeatOfGrasps:
    """Temperature drops that follow from grasps of one shape: the environments' own heat step. A mesh has the heat of
    the box around it, since mechanics is what differs, and slips would make networks of ever more patches."""

    def __init__(self, spec: ObjectSpec, count: int, cache: bool = True) -> None:
        if spec.mesh:
            spec = replace(spec, shape="box", mesh=None)
        body = GraspBody(spec, material(MATERIAL), _OBJECT, "T", sensor("seed"))
        self._bodies = [body] * count
        heat_of = GraspHeat if spec.shape == "box" else FieldHeat
        self._heat = heat_of(
            count,
            tolerance=0.05,
            air=5.0,
            dt=PERIOD / _SAMPLES,
            samples=_SAMPLES,
            sensor_temperature=_SENSOR,
            cache=cache,
        )

    def drops(self, grasp: Grasp) -> np.ndarray:
        """(K, B, samples, T) K."""
        self._heat.reset(range(len(self._bodies)), self._bodies)
        steps = zip(np.maximum(grasp.normal, 0.0), grasp.place, strict=True)
        return np.array([self._heat.advance(normal, place).drop for normal, place in steps])


def errors(grasp: Grasp, reference: Grasp, heat: HeatOfGrasps, reference_drops: np.ndarray) -> Errors:
    """What the grasp is off by. reference_drops: heat.drops(reference)."""
    fate = max(fates(grasp), key=FATES.index)
    if fate != HELD:
        return Errors(fate)
    held = slice(end_of("settle"), None)
    moved = grasp.offset[-1] - grasp.offset[end_of("settle") - 1]
    means = grasp.normal.mean(axis=2) - reference.normal.mean(axis=2)
    every = reference.centroid.shape[2] // grasp.centroid.shape[2]
    scatter = (grasp.centroid - reference.centroid[:, :, ::every])[held]
    touched = (reference.normal > 0).any(axis=2)  # (K, B, T)
    since = PERIOD * np.cumsum(touched, axis=0)[:, :, None, :]
    off = np.abs(heat.drops(grasp) - reference_drops)
    return Errors(
        fate,
        slip=1e3 * float(np.linalg.norm(moved, axis=-1).max()),
        force=_rms(grasp.normal[held] - FORCE),
        force_reference=_rms(means),
        jitter=1e6 * float(np.sqrt(scatter.var(axis=2).sum(axis=-1).mean())),
        drop=float(np.median(np.where(since > FIRST, off, 0.0).max(axis=(0, 2)))),
        drop_late=float(np.median(np.where(since > LATE, off, 0.0).max(axis=(0, 2)))),
    )


def worst(found: Sequence[Errors]) -> Errors:
    """The worst fate, and where all are held the largest of every error."""
    fate = max((each.fate for each in found), key=FATES.index)
    largest = {name: max(getattr(each, name) for each in found) for name in METRICS}
    return replace(Errors(fate), **largest) if fate == HELD else Errors(fate)


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
