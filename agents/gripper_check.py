"""A test of a gripper: it grasps and lifts an object of glass and one of aluminium, and its sensors tell them apart."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from thermograsp.agents.recording import record
from thermograsp.envs import (
    GraspBatch,
    GraspTask,
    Gripper,
    ObjectSpec,
)
from thermograsp.envs.tasks import LIFTED
from thermograsp.errors import positive

MATERIALS = ("glass", "aluminium")
WIDTH = 0.04  # m, of the object where the gripper opens that wide
MOST_SLIP = 0.0005  # m, along the pads while held
REPORTED_AFTER = 1.0  # s of contact, at which the temperature drops are reported
_ROOM, _GAP = (
    0.008,
    0.003,
)  # m that the gripper opens beyond the object, and that it closes beyond it, where it can
_SECONDS = 6.0
_SETTLED = 1.0  # s at the end over which forces and slip are taken
_OFF = (
    0.25  # share by which a pad's force may miss the limit: the object's weight and friction on slanted ways
)
_LEAST_DROP = 0.3  # K
_FORCE = 10.0  # N

Shape = Literal["box", "cylinder", "sphere"]


@dataclass(frozen=True, slots=True)
class Trial:
    """One grasp. material. force: N on the left and the right pad, mean while held. slip: m that the object moved in
    the hand while held. drop: K of the left and the right sensor after a second of contact, NaN where there was none.
    lifted: m at the end. problem: what went wrong and what to do, "" for nothing."""

    material: str
    force: tuple[float, float]
    slip: float
    drop: tuple[float, float]
    lifted: float
    problem: str


@dataclass(frozen=True, slots=True)
class GripperCheck:
    """gripper: the report. limit: N that was commanded. shape, width (m): of the objects. trials: one a material.
    problem: of all together, "" where the gripper is fit."""

    gripper: Gripper
    limit: float
    shape: str
    width: float
    trials: tuple[Trial, ...]
    problem: str

    @property
    def passed(self) -> bool:
        """Whether every grasp held and felt what it should."""
        return not self.problem

    def document(self) -> dict[str, Any]:
        """For machines."""
        return {
            "gripper": self.gripper.document(),
            "passed": self.passed,
            "problem": self.problem,
            "limit_N": self.limit,
            "shape": self.shape,
            "width_m": self.width,
            "trials": [
                {
                    "material": t.material,
                    "force_N": t.force,
                    "slip_m": t.slip,
                    "drop_K": t.drop,
                    "lifted_m": t.lifted,
                    "problem": t.problem,
                }
                for t in self.trials
            ],
        }


def check_gripper(gripper: Gripper, *, shape: Shape = "box", force: float | None = None) -> GripperCheck:
    """Grasps, lifts and holds an object of 40 mm (less where the gripper opens less), of each material. force: N, the
    limit; not given, 10 N, or what the gripper can where that is less. Raises InvalidValueError."""
    limit = (
        min(_FORCE, gripper.strongest)
        if force is None
        else min(positive("force (N)", force), gripper.strongest)
    )
    width = max(min(WIDTH, gripper.widest - _ROOM), gripper.narrowest + _GAP)
    target = ObjectSpec(shape=shape, size=(width, width, width if shape == "sphere" else WIDTH))
    batch = GraspBatch(
        len(MATERIALS),
        task=GraspTask(seconds=2 * _SECONDS),
        gripper=gripper,
        objects=target,
        placement=(0.0, 0.0),
    )
    watch = _Watch()
    try:
        recordings = record(batch, [0] * len(MATERIALS), _SECONDS, limit, list(MATERIALS), watch)
        dt = batch.dt
    finally:
        batch.close()
    trials = []
    for row, recording in enumerate(recordings):
        trial = watch.trial(row, recording.material, dt)
        problem = recording.ending and f"{recording.ending} while it was held" or _problem(trial, limit)
        trials.append(Trial(trial.material, trial.force, trial.slip, trial.drop, trial.lifted, problem))
    return GripperCheck(gripper, limit, shape, width, tuple(trials), _verdict(trials))


class _Watch:
    """What the trials are judged by: after every control step forces (B, F) N, temperature drops (B, F) K, heights (B,)
    m of the arm and positions (B, 3) m of the objects."""

    def __init__(self) -> None:
        self.forces: list[np.ndarray] = []
        self.drops: list[np.ndarray] = []
        self.heights: list[np.ndarray] = []
        self.places: list[np.ndarray] = []

    def __call__(self, time: float, batch: GraspBatch) -> None:
        reading = batch.reading
        assert reading is not None
        if time > 0:
            self.forces.append(reading.force[:, :, 0].copy())
            self.drops.append(np.array(reading.truth["temperature_drop"]))
            self.heights.append(reading.height.copy())
            self.places.append(batch.plant.mechanics.object_pose[:, 0, :3])  # pyright: ignore[reportAttributeAccessIssue]

    def trial(self, row: int, material: str, dt: float) -> Trial:
        """Of one environment."""
        forces, drops = np.array(self.forces)[:, row], np.array(self.drops)[:, row]
        places, heights = np.array(self.places)[:, row], np.array(self.heights)[:, row]
        held = max(1, round(_SETTLED / dt))
        inside = places - np.array([0.0, 0.0, 1.0]) * heights[:, None]
        slip = float(np.linalg.norm(inside[-1] - inside[-held]))
        drop = (math.nan, math.nan)
        both = np.flatnonzero((forces > 0).all(axis=1))
        if len(both) and both[0] + round(REPORTED_AFTER / dt) < len(drops):
            left, right = drops[both[0] + round(REPORTED_AFTER / dt)].tolist()
            drop = left, right
        left, right = forces[-held:].mean(axis=0).tolist()
        return Trial(material, (left, right), slip, drop, float(places[-1, 2] - places[0, 2]), "")


def _problem(trial: Trial, limit: float) -> str:
    if max(trial.force) <= 0 and math.isnan(trial.drop[0]):
        return "the pads did not meet the object: name the fingertips' bodies (--fingertips) or the closing actuators"
    if trial.lifted < 0.9 * LIFTED or min(trial.force) <= 0:
        return (
            "the object was not lifted: name other fingertips, or where their pads are (load_gripper's pads)"
        )
    if trial.slip > MOST_SLIP:
        return f"the object slipped by {1e3 * trial.slip:.2f} mm: the pads do not lie flat on it; try parallel_at"
    if max(abs(one - limit) for one in trial.force) > _OFF * limit:
        return (
            f"the pads press with {trial.force[0]:.1f} and {trial.force[1]:.1f} N at a limit of {limit:.1f} N"
        )
    if not min(trial.drop) > _LEAST_DROP:
        return (
            "a sensor felt nothing: its face is not on the object; name other fingertips, or place the pads"
        )
    return ""


def _verdict(trials: list[Trial]) -> str:
    problem = next((f"{trial.material}: {trial.problem}" for trial in trials if trial.problem), "")
    poor, good = (min(trial.drop) for trial in trials)
    if not problem and not good > poor:
        problem = "aluminium did not feel colder than glass: the sensors' faces do not lie on the object"
    return problem
