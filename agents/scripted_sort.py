"""Scripted sorting: feel an object, decide from its voltage, and lift it or the other one.

B: environments, K: materials that can be asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermograsp.envs import sliding_action_of
from thermograsp.envs.limits import MAX_LATERAL_RATE, MAX_LIFT_RATE, MAX_OPENING
from thermograsp.envs.tasks import LIFTED
from thermograsp.thermal import press
from thermograsp.thermal.contact import conduction

FORCE = 10.0  # N
FEELING = 0.8  # s that both fingertips press before it decides
_MARGIN = 0.002  # m that the arm rises beyond what the task asks
_APPROACH = 0.1  # s, time constant of the arm's last millimetres
_NEAR = 0.002  # m from where the arm is to be
_WIDE = 0.95 * MAX_OPENING  # m, from which the arm may move
_LEFT_OVER = (
    1 / 3
)  # of what a fingertip still shows when it touches again, after FEELING: between glass and copper
GOING, PRESSING, _LIFTING = range(3)  # phases


class ScriptedSort:
    """Policy of the environments of a batch of Sort-v0; it uses what is observed, where the objects lie and what each
    material is expected to show.

    Where a material is asked it feels object 0, and lifts it if no other material's expected voltage is nearer than the
    asked one's; else it lifts object 1. Where the hotter one is asked it feels both and lifts the one of less voltage.
    """

    feeling = FEELING

    def __init__(self, batch: Any) -> None:
        rows, layout = batch.num_envs, batch.plant.layout
        self._dt = batch.dt
        self._places = np.array(layout.places)
        self._expected = expected_voltages(layout) if layout.pair.goal == "material" else None
        self._phase, self._side = np.zeros(rows, int), np.zeros(rows, int)
        self._pressed = np.zeros(rows)  # s without a break
        self._voltages = np.full((rows, 2), np.nan)  # V
        self._before = np.zeros(rows)  # V, at the touch

    def restart(self, rows: Sequence[int] | np.ndarray) -> None:
        """The rows begin a new episode."""
        self._phase[rows], self._side[rows], self._pressed[rows] = GOING, 0, 0.0
        self._voltages[rows], self._before[rows] = np.nan, 0.0

    def action(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        """Actions (B, 4) float32 for observations (B, ...)."""
        opening, height = (observation["gripper"][:, i].astype(float) for i in (0, 2))
        lateral = observation["lateral"][:, 0].astype(float)
        volts = observation["voltage"][:, :, -1].mean(axis=1)
        away = self._places[self._side] - lateral
        going = self._phase == GOING
        self._before = np.where(going, volts, self._before)
        self._phase[going & (abs(away) < _NEAR) & (opening > _WIDE)] = PRESSING
        pressing = np.all(observation["force"][:, :, 0] > FORCE / 2, axis=1) & (self._phase != GOING)
        self._pressed = np.where(pressing, self._pressed + self._dt, 0.0)
        for row in np.flatnonzero((self._phase == PRESSING) & (self._pressed >= self.feeling)).tolist():
            self._decide(row, volts[row] - _LEFT_OVER * self._before[row], observation["goal"][row])
        going = self._phase == GOING
        away = self._places[self._side] - lateral
        sideways = np.where(
            going & (opening > _WIDE), np.clip(away / _APPROACH, -MAX_LATERAL_RATE, MAX_LATERAL_RATE), 0
        )
        left = LIFTED + _MARGIN - height
        lift = np.where(self._phase == _LIFTING, np.clip(left / _APPROACH, 0.0, MAX_LIFT_RATE), 0.0)
        return np.stack(
            [
                sliding_action_of(MAX_OPENING if open_ else 0.0, FORCE, up, along)
                for open_, up, along in zip(going.tolist(), lift.tolist(), sideways.tolist(), strict=True)
            ]
        )

    def _decide(self, row: int, volts: float, goal: np.ndarray) -> None:
        """Lifts what it holds, or turns to the other object."""
        side = self._side[row]
        self._voltages[row, side] = volts
        if self._wanted(row, goal):
            self._phase[row] = _LIFTING
        else:
            self._phase[row], self._side[row] = GOING, 1 - side

    def _wanted(self, row: int, goal: np.ndarray) -> bool:
        """Whether the object that a row has just touched is to be lifted."""
        side, volts = self._side[row], self._voltages[row]
        if self._expected is not None:
            # An object that was not pressed is taken on trust: it must be the other one.
            return bool(side == 1 or goal[np.argmin(abs(self._expected - volts[side]))] > 0)
        return bool(not np.isnan(volts).any() and volts[side] < volts[1 - side])


def expected_voltages(layout: Any) -> np.ndarray:
    """(K,) V after FEELING at FORCE, of each material that a pair's layout can ask for, in their order."""
    volts = []
    config = layout.config
    for body in layout.one_of_each:
        face, conducts = conduction(body.law, FORCE, np.zeros(3))
        pressed = press(
            body.material,
            sensor=body.stack,
            conductance=float(conducts / face),
            area=float(face),
            object_size=body.plate,
            sensor_temperature=config.sensor_temperatures[0],
            object_temperature=body.temperature,
            seconds=FEELING,
            tolerance=config.tolerance,
        )
        volts.append(pressed.voltage[-1])
    return np.array(volts)
