"""A simulated grasp as the studio runs it: one row, or two of different materials side by side.

B: rows, S: samples of a control step.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from gymnasium.utils.seeding import np_random

from thermograsp.agents import Stopwatch, columns_of
from thermograsp.envs import GraspVectorEnv, Roughness
from thermograsp.envs.limits import TIPS
from thermograsp.envs.pictures import temperatures
from thermograsp.envs.tasks import TOUCHING
from thermograsp.figures import across
from thermograsp.studio.control import SPREAD, Choices, Controls, Driving, Stock
from thermograsp.studio.sources.shapes import poses_of, shapes_of
from thermograsp.thermal import TouchSetup
from thermograsp.thermal.network import Orders

_FOREVER = 1e6  # s: an episode lasts as long as its visitor looks
_UP = 1e-3  # m


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
    """`choices` set up, tried for a step and reset. dt: s. rows: B, called `names`. paced: whether a step takes as long
    as it lasts, as on hardware. running: whether there is more to come. batch, plant: what is simulated. Raises
    InvalidValueError, such as for a tolerance that no network keeps."""

    paced = False
    running = True

    def __init__(self, choices: Choices, stock: Stock) -> None:
        self._choices, self._stock = choices, stock
        self.names = choices.names
        self.rows = len(self.names)
        roughness = () if choices.roughness == 1.0 else (Roughness(choices.roughness, choices.roughness),)
        self._env = GraspVectorEnv(
            num_envs=self.rows,
            seconds=_FOREVER,
            material=None if choices.everyday else [stock.materials[name] for name in choices.materials],
            mode=choices.mode,
            objects=choices.object(stock),
            tolerance=choices.tolerance,
            object_temperature=choices.object_temperature,
            ambient_temperature=None if choices.ambient == choices.object_temperature else choices.ambient,
            sensor_temperature=choices.thermostat,
            randomize=roughness,
        )
        self.batch = self._env.batch
        self.plant: Any = self.batch.plant
        self.dt = self.batch.dt
        self._watch = Stopwatch()
        self._watch.put_on(self.batch, "step", "all")
        self._watch.put_on(self.plant.heat, "advance", "heat")
        self._model, self._data = (self.plant.mechanics.env_model(0), self.plant.mechanics.env_data(0))
        self._driving = Driving(self._env, stock.network)
        self.reset(choices.seed)
        self.step(Controls())  # what a first step compiles or loads is there before the grasp is shown
        self.reset(choices.seed)

    @property
    def time(self) -> float:
        """s since the reset."""
        return self._steps * self.dt

    @property
    def colours(self) -> tuple[float, float]:
        """°C, the range of the colours."""
        low, high = self._choices.colours
        first = [float(body.temperature) for body in self.plant.bodies]
        return min(low, *(celsius - 1.0 for celsius in first)), max(
            high, *(celsius + 1.0 for celsius in first)
        )

    def reset(self, seed: int) -> None:
        """Begins anew; both rows with the same place and noise."""
        for row, name in enumerate(self.names):
            chosen = {} if self._choices.everyday else {"material": self._stock.materials[name]}
            self._observation, self._reading = self.batch.reset([row], [np_random(seed)[0]], chosen)
        self._driving.restart(seed)
        self._endings, self._steps = [""] * self.rows, 0
        for label in self._watch.seconds:
            self._watch.seconds[label] = 0.0

    def step(self, controls: Controls) -> dict[str, np.ndarray]:
        """One control step; the columns (B, S) of `thermograsp grasp --csv`."""
        step = self.batch.step(self._driving.action(controls, self._observation, self._reading))
        self._observation, self._reading = step.observation, step.reading
        for row, error in enumerate(step.reading.error):
            reasons = [name for name, ended in step.outcome.reasons.items() if ended[row]]
            self._endings[row] = self._endings[row] or error or "".join(reasons[:1])
        self._steps += 1
        return columns_of([step.reading], self.dt, (self._steps - 1) * self.dt)

    def shapes(self) -> list[dict[str, Any]]:
        """See shapes.py; all rows have the same."""
        return shapes_of(self._model, self.plant.mechanics.names)

    def poses(self, row: int) -> list[list[float]]:
        """The poses of the row's bodies, now."""
        self.plant.mechanics.env_data(row, self._data)
        return poses_of(self._model, self._data)

    def message(self, row: int) -> dict[str, Any]:
        """What the page is to show of a row: its bodies' poses; celsius, °C by part; across, °C from thermostat to
        thermostat, see report.film.Still; how it ended, or its state; m of opening and height; the heat model's
        cost."""
        reading = self._reading
        self.plant.mechanics.env_data(row, self._data)
        celsius = temperatures(reading, self.plant.mechanics.names, row)
        celsius |= {f"thermostat_{tip}": float(reading.thermostat[row, k]) for k, tip in enumerate(TIPS)}
        return {
            "poses": poses_of(self._model, self._data),
            "celsius": {name: round(value, 3) for name, value in celsius.items()},
            "across": [round(value, 2) for value in across(reading, row)],
            "ending": self._endings[row],
            "state": self._state(row),
            "opening": round(float(reading.opening[row]), 6),
            "height": round(float(reading.height[row]), 6),
            "cost": asdict(self.cost(row)),
        }

    def _state(self, row: int) -> str:
        """In a word or two."""
        pressing = self._reading.force[row, :, 0].min() > TOUCHING
        lift = float(self._reading.truth["lift"][row])
        if not pressing:
            return "apart" if self._steps else "on the table"
        return f"held {1e3 * lift:.0f} mm up" if lift > _UP else "gripped"

    def cost(self, row: int) -> Cost:
        """The cost of the row's heat model."""
        rung = str(self._reading.truth["rung"][row])
        orders = Orders.parse(rung.partition(":")[2])  # of "network:..." or "body:..."
        spent, steps = self._watch.seconds, max(self._steps, 1)
        return Cost(
            rung,
            orders.states,
            orders.multiply_adds,
            spent["heat"] / steps,
            spent["all"] / steps,
        )

    def touch_setup(self, row: int) -> TouchSetup:
        """What an identifier may know of the row's touch."""
        body = self.plant.bodies[row]
        warm = self._choices.thermostat, 0.1
        return body.touch_setup(self.plant.config.chain, warm, SPREAD, self._choices.tolerance)

    def close(self) -> None:
        """Releases the plant."""
        self.batch.close()
