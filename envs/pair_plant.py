"""The simulated plant of two objects beside each other, under a gripper that also moves along the table.

The objects lie along y, object 0 at y < 0 and object 1 at y > 0, alike in shape, colour, mass and friction.

B: environments, O = 2 objects, F = 2 fingertips, G: what can be asked.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from ..thermal import Material, sensor
from .electronics import Electronics, ElectronicsState
from .mechanics import Mechanics, MechanicsState
from .pair_config import OBJECTS, PairConfig, pair_config
from .pair_truth import PAIR_TOLD, PairTruth
from .randomization import CAUSES, checked, draw
from .scene import LATERAL_REACH, ObjectSpec
from .scene_heat import SceneHeat, SceneHeatState, SceneHeatStep
from .simulation_config import SAMPLE_PERIOD
from .thermostats import Thermostats
from .things import Thing
from .truth import Episodes

if TYPE_CHECKING:
    from .face_temperature import FaceTemperatureState

GAP = 0.03  # m between the two objects, wider than a pad


@dataclass(frozen=True, slots=True)
class PairState:
    """Everything that decides the future of some environments; picklable."""

    mechanics: MechanicsState
    heat: SceneHeatState
    electronics: ElectronicsState
    thermostats: tuple[np.ndarray, ...]
    rest: np.ndarray
    right: np.ndarray
    asked: np.ndarray
    generators: tuple[np.random.Generator, ...]
    drawn: tuple[dict[str, float], ...]
    faces: FaceTemperatureState | None


class PairPlant:
    """A batch of simulated grippers, each over two objects; see thermograsp.plant.Plant."""

    def __init__(self, num_envs: int, pair: PairConfig) -> None:
        self.pair, self.config, self.num_envs = pair, pair.simulation, num_envs
        config = self.config
        self._choices, self._stack, self._shapes = config.choices, sensor(config.sensor), config.shapes
        self._causes = checked(config.randomize)
        possible = config.possible_things(self._stack)
        for thing in possible:
            self._check_reach(thing.spec)
        self.mechanics = Mechanics(
            self._placed(possible[0].spec, np.zeros((OBJECTS, 3))),
            num_envs,
            threads=config.threads,
            library=[thing.spec for thing in possible if thing.spec.mesh],
            settings=config.solver,
            gripper=config.gripper_for(possible),
            lateral=True,
            contacts=config.taxels is not None or config.face_temperature is not None,
        )
        self._taxels, self._faces = config.tactile, config.face_maps(num_envs, self._stack)
        self.dt = config.substeps * config.solver.timestep
        self.sample_rate = 1 / SAMPLE_PERIOD
        self.heat = SceneHeat(num_envs, OBJECTS, **config.heat)
        self.things: list[tuple[Thing, ...]] = [(possible[0],) * OBJECTS] * num_envs
        self._rngs = [np.random.default_rng(0)] * num_envs
        self._electronics = Electronics(
            num_envs, config.chain, self._stack.seebeck, SAMPLE_PERIOD, config.samples, config.most_delay
        )
        self._thermostats = Thermostats(num_envs, config.heater, config.sensor_temperatures, self.dt)
        self._drawn = [draw((), np.random.default_rng(0))] * num_envs
        self._rest = np.zeros((num_envs, OBJECTS))
        self._right, self._asked = np.zeros(num_envs, int), np.zeros(num_envs, int)
        # Replaced, never written to: readings keep them.
        nothing = np.full(num_envs, "", object)
        self._episodes = Episodes(config.mode, nothing, nothing, np.full(num_envs, np.inf), {})
        self._task: dict[str, np.ndarray] = {}

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment's scene."""
        return self.mechanics.model

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
        things = [self.things[row] for row in chosen]
        self.mechanics.reset(chosen, [tuple(thing.spec for thing in pair) for pair in things])
        self.heat.reset(
            chosen,
            [
                [replace(t, spec=replace(t.spec, position=(0.0, 0.0), yaw=0.0)) for t in pair]
                for pair in things
            ],
            self._thermostats.setpoints[chosen]
            + np.array([[self._drawn[row]["thermostat_error"]] for row in chosen]),
        )
        if self._faces is not None:
            self._faces.reset(chosen, things)
        self._thermostats.reset(chosen)
        self._rest[chosen] = self.mechanics.object_pose[chosen, :, 2]
        self._relabel()
        return self._still()

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
            first = self.heat.sensor_temperatures
            told = step.fingertips.told
            self.heat.set_thermostats(self._thermostats.step(told["drawn"], first))
            self._thermostats.tell(told)
        force = np.stack([motion.force for motion in motions], axis=1)
        heights = np.stack([motion.object_height for motion in motions], axis=1)
        error = tuple(self.mechanics.failure)
        return Reading(
            opening=motions[0].opening,
            opening_rate=motions[0].opening_rate,
            height=motions[0].height,
            force=force[:, 0] + force[:, 1],
            voltage=self._electronics.measure(step.fingertips.drop, self._rngs),
            thermostat=self._thermostats.measured,
            truth=self._truth(heights, force, step, error),
            error=error,
            told=PAIR_TOLD,
            lateral=self.mechanics.lateral,
            pressure=None if self._taxels is None else self._taxels.pressure(self.mechanics),
            face_temperature=None
            if self._faces is None
            else self._faces.step(self.mechanics, step.fingertips, step.owner),
        )

    def temperatures(self, row: int) -> tuple[float, ...]:
        """°C between which the row's heat stays: of its thermostats, objects, room and reservoirs."""
        objects = (celsius for thing in self.things[row] for celsius in thing.extremes)
        return (*self.heat.sensor_temperatures[row], *objects)

    def close(self) -> None:
        """Nothing is held."""

    def state(self, rows: Sequence[int]) -> PairState:
        """A copy of the rows' state."""
        chosen = list(rows)
        return PairState(
            self.mechanics.state(np.array(chosen)),
            self.heat.state(chosen),
            self._electronics.state(chosen),
            self._thermostats.state(chosen),
            self._rest[chosen],
            self._right[chosen],
            self._asked[chosen],
            tuple(copy.deepcopy(self._rngs[row]) for row in chosen),
            tuple(self._drawn[row] for row in chosen),
            None if self._faces is None else self._faces.state(chosen),
        )

    def set_state(self, rows: Sequence[int], state: PairState) -> tuple[np.random.Generator, ...]:
        """Puts the rows into a state; what follows is bit-identical to what followed it first. Returns the generators
        the rows now draw from."""
        chosen = list(rows)
        self.mechanics.set_state(state.mechanics, np.array(chosen))
        self.heat.set_state(chosen, state.heat)
        self._electronics.set_state(chosen, state.electronics)
        self._thermostats.set_state(chosen, state.thermostats)
        rngs = tuple(copy.deepcopy(rng) for rng in state.generators)
        for k, row in enumerate(chosen):
            pair = state.heat.rows.things[OBJECTS * k : OBJECTS * (k + 1)]
            specs = state.mechanics.objects[k]
            self.things[row] = tuple(replace(t, spec=s) for t, s in zip(pair, specs, strict=True))
            self._rngs[row], self._drawn[row] = rngs[k], state.drawn[k]
        if self._faces is not None and state.faces is not None:
            self._faces.set_state(chosen, state.faces, [self.things[row] for row in chosen])
        self._rest[chosen], self._right[chosen], self._asked[chosen] = state.rest, state.right, state.asked
        self._relabel()
        return rngs

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
        self._drawn[row] = drawn = draw(self._causes, rng)
        pair: list[Thing] = []
        for number in range(OBJECTS):
            material: Material = self._choices[asked if number == right else other]
            celsius = self.pair.temperatures[int(number == right)]
            thing = replace(config, object_temperature=celsius).thing(self._stack, material, shape, drawn)
            pair.append(thing)
        specs = self._placed(pair[0].spec, places)
        self.things[row] = tuple(replace(t, spec=spec) for t, spec in zip(pair, specs, strict=True))
        self._right[row] = right
        self._asked[row] = asked if self.pair.goal == "material" else 0
        self._rngs[row] = rng
        self._electronics.reset(row, drawn)

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

    def _relabel(self) -> None:
        """Names what the rows hold now."""
        names, goals = [CAUSES[type(cause)][0] for cause in self._causes], self.pair.goals
        self._episodes = Episodes(
            self.config.mode,
            material=_tuples([tuple(t.material.name for t in pair) for pair in self.things]),
            rung=_tuples([self.heat.rung(row) for row in range(self.num_envs)]),
            crushing_force=np.array([[t.crushing_force for t in pair] for pair in self.things]),
            randomized={name: np.array([drawn[name] for drawn in self._drawn]) for name in names},
        )
        self._task = {
            "asked": np.array([goals[number] for number in self._asked], object),
            "right": self._right.copy(),
            "goal": np.eye(len(goals))[self._asked],
        }

    def _truth(
        self, heights: np.ndarray, force: np.ndarray, step: SceneHeatStep, error: tuple[str, ...]
    ) -> PairTruth:
        celsius = step.objects["object_temperature"].copy()
        own = {"object_temperature": celsius, "object_temperatures": celsius, "object_force": force}
        return PairTruth(step.fingertips, self._episodes, heights - self._rest, error, self._task | own)

    def _still(self) -> Reading:
        """The reading before anything moves: nothing is touched, no voltage."""
        rows, error = self.num_envs, tuple(self.mechanics.failure)
        heights = self.mechanics.object_pose[:, :, 2]
        return Reading(
            opening=self.mechanics.opening,
            opening_rate=np.zeros(rows),
            height=self.mechanics.height,
            force=np.zeros((rows, 2, 3)),
            voltage=np.zeros((rows, self.config.samples, 2)),
            thermostat=self._thermostats.measured,
            truth=self._truth(heights, np.zeros((rows, OBJECTS, 2, 3)), self.heat.rest(), error),
            error=error,
            told=PAIR_TOLD,
            lateral=self.mechanics.lateral,
            pressure=None if self._taxels is None else self._taxels.nothing(rows),
            face_temperature=None if self._faces is None else self._faces.rest(self.heat.rest().fingertips),
        )


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
