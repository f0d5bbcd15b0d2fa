"""The simulated plant of two objects beside each other, under a gripper that also moves along the table.

The objects lie along y, object 0 at y < 0 and object 1 at y > 0, alike in shape, colour, mass and friction.

B: environments, O = 2 objects, F = 2 fingertips, G: what can be asked.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from ..thermal import Material, sensor
from .pair_config import OBJECTS, PairConfig, pair_config
from .pair_truth import PAIR_TOLD, PairTruth
from .randomization import draw
from .scene import LATERAL_REACH, ObjectSpec
from .scene_heat import SceneHeat, SceneHeatStep
from .simulated_batch import SimulatedBatch
from .things import Thing
from .truth import Episodes

GAP = 0.03  # m between the two objects, wider than a pad


class PairPlant(SimulatedBatch):
    """A batch of simulated grippers, each over two objects; see thermograsp.plant.Plant."""

    def __init__(self, num_envs: int, pair: PairConfig) -> None:
        self.pair, self.config, config = pair, pair.simulation, pair.simulation
        possible = config.possible_things(sensor(config.sensor))
        for thing in possible:
            self._check_reach(thing.spec)
        specs = self._placed(possible[0].spec, np.zeros((OBJECTS, 3)))
        heat = SceneHeat(num_envs, OBJECTS, **config.heat)
        super().__init__(num_envs, config, specs, possible, heat, lateral=True)
        self._rest = np.zeros((num_envs, OBJECTS))
        self._right, self._asked = np.zeros(num_envs, int), np.zeros(num_envs, int)
        self._task: dict[str, np.ndarray] = {}

    @property
    def places(self) -> tuple[float, float]:
        """m along y of the two objects' middles, before what placement draws; of the first shape."""
        middle = (_depth(self._shapes[0]) + GAP) / 2
        return -middle, middle

    @property
    def one_of_each(self) -> list[Thing]:
        """An object of the first shape of each material, where nothing is randomised."""
        plain = draw((), np.random.default_rng(0))
        return [self.config.thing(self._stack, each, self._shapes[0], plain) for each in self._choices]

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Starts the rows anew: draws what is asked, where the right object lies, materials and placement."""
        if options:
            raise InvalidValueError(f"a pair of objects has no reset options, got {sorted(options)}")
        chosen = list(rows)
        for row, rng in zip(chosen, rngs, strict=True):
            self._draw(row, rng)
        centred = [
            [replace(t, spec=replace(t.spec, position=(0.0, 0.0), yaw=0.0)) for t in self.scenes[row]]
            for row in chosen
        ]
        self._place(chosen, centred)
        self._rest[chosen] = self.mechanics.object_pose[chosen, :, 2]
        self._relabel(chosen)
        rest, nothing = self.heat.rest(), np.zeros((self.num_envs, OBJECTS, 2, 3))
        truth = self._truth(self.mechanics.object_pose[:, :, 2], nothing, rest)
        return self._still(rest.fingertips, truth, PAIR_TOLD)._replace(lateral=self.mechanics.lateral)

    def step(self, command: Command) -> Reading:
        """One control step of all environments."""
        sideways = np.zeros(self.num_envs) if command.lateral_rate is None else command.lateral_rate
        motions = self.mechanics.slide(
            command.opening, command.force_limit, command.lift_rate, sideways, self.config.substeps
        )
        step = self.heat.advance(
            np.stack([motion.normal for motion in motions], axis=1),
            np.stack([motion.place for motion in motions], axis=1),
        )
        if not self._thermostats.ideal:
            self._regulate(step.fingertips)
        force = np.stack([motion.force for motion in motions], axis=1)
        heights = np.stack([motion.object_height for motion in motions], axis=1)
        motion = motions[0]._replace(force=force[:, 0] + force[:, 1])
        truth = self._truth(heights, force, step)
        reading = self._reading(motion, step.fingertips, truth, PAIR_TOLD, step.owner)
        return reading._replace(lateral=self.mechanics.lateral)

    @property
    def _own(self) -> tuple[np.ndarray, ...]:
        return self._rest, self._right, self._asked

    def _draw(self, row: int, rng: np.random.Generator) -> None:
        """An episode's task and objects."""
        config, count = self.config, len(self._choices)
        right = int(rng.integers(OBJECTS))
        asked = int(rng.integers(count))
        other = asked
        if self.pair.goal == "material":
            other = int(rng.integers(count - 1))
            other += other >= asked
        shape = self._shapes[int(rng.integers(len(self._shapes))) if len(self._shapes) > 1 else 0]
        places = rng.uniform(-1.0, 1.0, (OBJECTS, 3))
        drawn = self._begin(row, rng)
        pair: list[Thing] = []
        for number in range(OBJECTS):
            material: Material = self._choices[asked if number == right else other]
            celsius = self.pair.temperatures[int(number == right)]
            thing = replace(config, object_temperature=celsius).thing(self._stack, material, shape, drawn)
            pair.append(thing)
        specs = self._placed(pair[0].spec, places)
        self.scenes[row] = tuple(replace(t, spec=spec) for t, spec in zip(pair, specs, strict=True))
        self._right[row] = right
        self._asked[row] = asked if self.pair.goal == "material" else 0

    def _placed(self, spec: ObjectSpec, places: np.ndarray) -> tuple[ObjectSpec, ...]:
        """Both objects on the table. places: (O, 3) of x, y and angle in -1 .. 1 of what the config allows."""
        reach, turn = self.config.placement
        middle = (_depth(spec) + GAP) / 2
        return tuple(
            replace(
                spec,
                name=f"{spec.name}_{number}",
                position=(x * reach, side * middle + y * reach),
                yaw=spec.yaw + np.deg2rad(angle * turn),
            )
            for number, (side, (x, y, angle)) in enumerate(zip((-1, 1), places.tolist(), strict=True))
        )

    def _check_reach(self, spec: ObjectSpec) -> None:
        most = 2 * (LATERAL_REACH - self.config.placement[0]) - GAP
        if _depth(spec) > most:
            raise InvalidValueError(
                f"objects are {1e3 * _depth(spec):.1f} mm deep along y: two beside each other are in the gripper's "
                f"reach up to {1e3 * most:.1f} mm"
            )

    def _relabel(self, rows: Sequence[int]) -> None:
        del rows  # all are told anew
        goals = self.pair.goals
        self._episodes = Episodes(
            self.config.mode,
            material=_tuples([tuple(t.material.name for t in pair) for pair in self.scenes]),
            rung=_tuples([self.heat.rung(row) for row in range(self.num_envs)]),
            crushing_force=np.array([[t.crushing_force for t in pair] for pair in self.scenes]),
            randomized=self._randomized,
        )
        self._task = {
            "asked": np.array([goals[number] for number in self._asked], object),
            "right": self._right.copy(),
            "goal": np.eye(len(goals))[self._asked],
        }

    def _truth(self, heights: np.ndarray, force: np.ndarray, step: SceneHeatStep) -> PairTruth:
        celsius = step.objects["object_temperature"].copy()
        own = {"object_temperature": celsius, "object_temperatures": celsius, "object_force": force}
        lift, error = heights - self._rest, tuple(self.mechanics.failure)
        return PairTruth(step.fingertips, self._episodes, lift, error, self._task | own)


def _depth(spec: ObjectSpec) -> float:
    """m, extent along y at this yaw; of the bounding box for a mesh."""
    if spec.shape in ("sphere", "cylinder"):
        return spec.size[1]
    return spec.size[0] * abs(math.sin(spec.yaw)) + spec.size[1] * abs(math.cos(spec.yaw))


def _tuples(values: Sequence[tuple[str, ...]]) -> np.ndarray:
    """(B,) of tuples."""
    array = np.empty(len(values), object)
    for row, value in enumerate(values):
        array[row] = value
    return array


def pair_plant(url: str, num_envs: int, **config: Any) -> PairPlant:
    """The plant behind plant="simulated" of two objects. Keywords as pair_config's. Raises InvalidValueError for
    others."""
    try:
        pair = pair_config(**config)
    except TypeError as error:
        raise InvalidValueError(f"plant {url!r}: {error}") from None
    return PairPlant(num_envs, pair)
