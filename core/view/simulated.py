"""A simulated grasp as the studio runs it: one row, or two of different materials side by side.

B: rows, S: samples of a control step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium.utils.seeding import np_random

from thermograsp.envs import GraspVectorEnv, Roughness, action_of
from thermograsp.envs.grasp_task import TOUCHING
from thermograsp.envs.mechanics import MAX_LIFT_RATE
from thermograsp.envs.picture import temperatures
from thermograsp.envs.scene import TIPS
from thermograsp.plant import Reading
from thermograsp.report.film import across
from thermograsp.report.policies import Policy, policy
from thermograsp.report.recording import columns_of
from thermograsp.report.scripted import ScriptedGrasp
from thermograsp.report.stopwatch import Stopwatch
from thermograsp.thermal import TouchSetup
from thermograsp.thermal.states import Orders
from thermograsp.view.choices import Choices, Controls, Stock
from thermograsp.view.shapes import poses_of, shapes_of

_FOREVER = 1e6  # s: an episode lasts as long as its visitor looks
_APPROACH = 0.1  # s, time constant of the sliders' arm
_UP = 1e-3  # m
_NETWORK = "network:"


@dataclass(frozen=True, slots=True)
class Cost:
    """What a row's heat model takes. rung: its name. states: of the network. multiply_adds: of one sample's step.
    heat, all: s of computing for a control step of all rows, measured so far."""

    rung: str
    states: int
    multiply_adds: int
    heat: float
    all: float


class SimulatedGrasp:
    """`choices` set up and reset. dt: s. rows: B. paced: whether a step takes as long as it lasts, as on hardware.
    Raises InvalidValueError, such as for a tolerance that no network keeps."""

    paced = False
    running = True  # until its end, for what has one

    def __init__(self, choices: Choices, stock: Stock) -> None:
        self._choices, self._stock = choices, stock
        self.rows = len(choices.materials)
        roughness = () if choices.roughness == 1.0 else (Roughness(choices.roughness, choices.roughness),)
        self._env = GraspVectorEnv(
            num_envs=self.rows,
            seconds=_FOREVER,
            material=[stock.materials[name] for name in choices.materials],
            mode=choices.mode,
            objects=choices.object(stock),
            tolerance=choices.tolerance,
            object_temperature=choices.object_temperature,
            sensor_temperature=choices.thermostat,
            randomize=roughness,
        )
        self._batch = self._env.batch
        self._plant: Any = self._batch.plant
        self.dt = self._batch.dt
        self._watch = Stopwatch()
        self._watch.put_on(self._batch, "step", "all")
        self._watch.put_on(self._plant.heat, "advance", "heat")
        self._model, self._data = (self._plant.mechanics.env_model(0), self._plant.mechanics.env_data(0))
        self._drivers: dict[tuple[str, float], Policy | ScriptedGrasp] = {}
        self.endings = [""] * self.rows
        self.steps = 0
        self.reset(choices.seed)

    def reset(self, seed: int) -> None:
        """Begins anew; both rows with the same place and noise."""
        for row, name in enumerate(self._choices.materials):
            chosen = {"material": self._stock.materials[name]}
            self._seen, self._reading = self._batch.reset([row], [np_random(seed)[0]], chosen)
        self._drivers.clear()
        self.endings, self.steps, self._seed = [""] * self.rows, 0, seed
        for label in self._watch.seconds:
            self._watch.seconds[label] = 0.0

    def step(self, controls: Controls) -> dict[str, np.ndarray]:
        """One control step; the columns (B, S) of `thermograsp grasp --csv`."""
        step = self._batch.step(self._action(controls))
        self._seen, self._reading = step.observation, step.reading
        for row, error in enumerate(step.reading.error):
            reasons = [name for name, ended in step.outcome.reasons.items() if ended[row]]
            self.endings[row] = self.endings[row] or error or "".join(reasons[:1])
        self.steps += 1
        return columns_of([step.reading], self.dt, (self.steps - 1) * self.dt)

    @property
    def reading(self) -> Reading:
        """The last one."""
        return self._reading

    def shapes(self) -> list[dict[str, Any]]:
        """See shapes.py; all rows have the same."""
        return shapes_of(self._model, self._plant.mechanics.names)

    def poses(self, row: int) -> list[list[float]]:
        """Of the row's bodies, now."""
        self._plant.mechanics.env_data(row, self._data)
        return poses_of(self._model, self._data)

    def celsius(self, row: int) -> dict[str, float]:
        """°C by part."""
        parts = temperatures(self._reading, row)
        parts |= {f"thermostat_{tip}": float(self._reading.thermostat[row, k]) for k, tip in enumerate(TIPS)}
        return {name: round(value, 3) for name, value in parts.items()}

    def across(self, row: int) -> list[float]:
        """°C from thermostat to thermostat: see report.film.Still."""
        return [round(value, 2) for value in across(self._reading, row)]

    def state(self, row: int) -> str:
        """What the row does, in a word or two."""
        pressing = self._reading.force[row, :, 0].min() > TOUCHING
        lift = float(self._reading.truth["lift"][row])
        if not pressing:
            return "apart" if self.steps else "on the table"
        return f"held {1e3 * lift:.0f} mm up" if lift > _UP else "gripped"

    def cost(self, row: int) -> Cost:
        """Of the row's heat model."""
        rung = str(self._reading.truth["rung"][row])
        orders = Orders.parse(rung.removeprefix(_NETWORK)) if rung.startswith(_NETWORK) else None
        spent, steps = self._watch.seconds, max(self.steps, 1)
        return Cost(
            rung,
            orders.states if orders else 0,
            orders.multiply_adds if orders else 0,
            spent["heat"] / steps,
            spent["all"] / steps,
        )

    def touch_setup(self, row: int) -> TouchSetup | None:
        """What an identifier may know of the row's touch."""
        thing = self._plant.things[row]
        return TouchSetup(
            stack=thing.stack,
            mode=thing.mode,
            area=thing.geometry.area,
            object_size=thing.plate,
            fingertips=2,
            chain=self._plant.config.chain,
            object_temperature=(self._choices.object_temperature, 3.0),
            sensor_temperature=(self._choices.thermostat, 0.1),
        )

    def close(self) -> None:
        """Releases the plant."""
        self._batch.close()

    def _action(self, controls: Controls) -> np.ndarray:
        if controls.driver == "sliders":
            rate = np.clip(
                (controls.height - self._reading.height) / _APPROACH, -MAX_LIFT_RATE, MAX_LIFT_RATE
            )
            opening, force = np.full(self.rows, controls.opening), np.full(self.rows, controls.force)
            return action_of(opening, force, rate).T.copy()  # pyright: ignore[reportArgumentType]
        return self._driver(controls).action(self._seen)

    def _driver(self, controls: Controls) -> Policy | ScriptedGrasp:
        key = (controls.driver, controls.force if controls.driver == "scripted" else 0.0)
        if key not in self._drivers:
            self._drivers.clear()
            if controls.driver == "scripted":
                self._drivers[key] = ScriptedGrasp(self.rows, self.dt, controls.force)
            else:
                own = controls.driver == "trained" and self._stock.network
                chosen = policy(self._env, own or controls.driver)
                chosen.restart(range(self.rows), [self._seed] * self.rows)
                self._drivers[key] = chosen
        return self._drivers[key]
