"""The demonstration's grasps: all ten seed materials at once, in one mode."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from gymnasium.utils.seeding import np_random

from thermograsp.agents import Recording, Stopwatch, record
from thermograsp.envs import GraspBatch, GraspTask
from thermograsp.envs.limits import SUBSTEPS
from thermograsp.errors import MissingDependencyError
from thermograsp.figures import Film, Still
from thermograsp.thermal import SEED_MATERIALS, Mode, material

FILMED = "glass"
COLOURS = (23.0, 37.0)  # degC, the pictures' range
FORCE = 10.0  # N
GENTLE = 0.75  # of the force that crushes an object, where that is less
_STILLS = (0.0, 0.6, 1.1, 1.6, 2.4)  # s; the last picture is at the end
_WARM_UP = 0.6  # s, beyond the touch: what is compiled on first use is not measured


@dataclass(frozen=True, slots=True)
class Grasp:
    """One run and what the table says of its left fingertip; force, area and conductance as they are at the end."""

    mode: Mode
    recording: Recording
    effusivity: float

    @property
    def peak(self) -> int:
        """Sample of the largest temperature drop."""
        return int(np.argmax(self.recording.columns["temperature_drop_left_K"]))

    @property
    def summary(self) -> dict[str, float | str | bool]:
        """The table's row, by name_unit."""
        columns = self.recording.columns
        drop = columns["temperature_drop_left_K"]
        return {
            "material": self.recording.material,
            "mode": self.mode,
            "effusivity_Ws05_m2K": self.effusivity,
            "peak_temperature_drop_K": float(drop[self.peak]),
            "peak_after_touch_s": float(columns["time_s"][self.peak]) - self.recording.touch,
            "final_temperature_drop_K": float(drop[-1]),
            "peak_voltage_V": float(np.max(columns["voltage_left_V"])),
            "force_N": float(columns["force_left_N"][-1]),
            "contact_area_m2": float(columns["contact_area_left_m2"][-1]),
            "conductance_W_m2K": float(columns["conductance_left_W_m2K"][-1]),
            "rung": self.recording.rung,
            "success": self.recording.success,
        }


@dataclass(frozen=True, slots=True)
class ModeRun:
    """All materials in one mode. physics_steps_per_s: of MuJoCo, all grasps together, per second in the environment's
    step; heat_share and mechanics_share of that time. stills: pictures of FILMED; without them, why in no_picture."""

    mode: Mode
    grasps: tuple[Grasp, ...]
    physics_steps_per_s: float
    heat_share: float
    mechanics_share: float
    stills: tuple[Still, ...]
    no_picture: str


def run_mode(
    mode: Mode,
    seconds: float,
    seed: int,
    film: bool,
    advance: Callable[[str, float], None],
) -> ModeRun:
    """Grasps every material; grasp i is seeded with seed + i. advance: told what is done, 1 for each material's model
    and 10 for the grasps together."""
    task = GraspTask(hold_seconds=min(2.0, seconds / 4), seconds=seconds)
    names: list[str] = list(SEED_MATERIALS)
    batch = GraspBatch(len(names), task=task, material=names, mode=mode)
    seeds = [seed + row for row in range(len(names))]
    # chooses the heat models, the slow part on a machine that has none cached
    for row, name in enumerate(names):
        advance(f"{mode} mode: heat model of {name}", 1.0)
        batch.reset([row], [np_random(seeds[row])[0]], {"material": name})
    assert batch.reading is not None
    force = np.minimum(FORCE, GENTLE * batch.reading.truth["crushing_force"])
    record(batch, seeds, _WARM_UP, force, names)
    camera, no_picture = _film(batch, names, seconds) if film else (None, "")
    watch = Stopwatch()
    watch.put_on(batch, "step", "step")
    watch.put_on(batch.plant.heat, "advance", "heat")  # pyright: ignore[reportAttributeAccessIssue]
    watch.put_on(batch.plant.mechanics, "advance", "mechanics")  # pyright: ignore[reportAttributeAccessIssue]

    def watch_step(time: float, now: GraspBatch) -> None:
        advance(f"{mode} mode: grasping", 10 * now.dt / seconds if time else 0.0)
        if camera is not None:
            camera.watch(time, now)

    recordings = record(batch, seeds, seconds, force, names, watch_step)
    steps = round(seconds / batch.dt) * SUBSTEPS * len(names)
    batch.close()
    if camera is not None:
        camera.close()
    spent = watch.seconds
    return ModeRun(
        mode,
        tuple(Grasp(mode, one, material(one.material).effusivity) for one in recordings),
        steps / spent["step"],
        spent["heat"] / spent["step"],
        spent["mechanics"] / spent["step"],
        tuple(camera.stills) if camera else (),
        no_picture,
    )


def _film(batch: GraspBatch, names: list[str], seconds: float) -> tuple[Film | None, str]:
    times = [time for time in _STILLS if time < seconds - 0.5] + [seconds]
    low, high = COLOURS
    try:
        row = names.index(FILMED)
        return Film(batch.plant, times, row, size=(1280, 960), low=low, high=high), ""
    except MissingDependencyError as error:
        return None, str(error)
