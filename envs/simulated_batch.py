"""What all simulated plants share: a batch of grippers, the objects in their reach, and what their fingertips are made
of.

B: environments, F = 2 fingertips.
"""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thermograsp.plant import Reading

from ..thermal import sensor
from .electronics import Electronics, ElectronicsState
from .heat import HeatState, HeatStep
from .mechanics import Mechanics, MechanicsState
from .mechanics_kernel import Motion
from .randomization import CAUSES, checked, draw
from .scene import ObjectSpec
from .simulation_config import SAMPLE_PERIOD, SimulationConfig
from .thermostats import Thermostats
from .things import Thing
from .truth import Episodes, Truth

if TYPE_CHECKING:
    from .face_temperature import FaceTemperatureState
    from .scene_heat import SceneHeatState

Scene = tuple[Thing, ...]
"""The objects in one gripper's reach."""


@dataclass(frozen=True, slots=True)
class PlantState:
    """Everything that decides the future of some environments of a simulated plant; picklable. own: what else the kind
    of plant remembers of each."""

    mechanics: MechanicsState
    heat: HeatState | SceneHeatState
    electronics: ElectronicsState
    thermostats: tuple[np.ndarray, ...]
    faces: FaceTemperatureState | None
    generators: tuple[np.random.Generator, ...]
    drawn: tuple[dict[str, float], ...]
    own: tuple[np.ndarray, ...]


class SimulatedBatch(ABC):
    """specs: the objects of each scene at first. possible: every object that may lie in one. heat: GraspHeat or
    SceneHeat. lateral: the arm slides along y. scenes: each environment's objects."""

    def __init__(
        self,
        num_envs: int,
        config: SimulationConfig,
        specs: Sequence[ObjectSpec],
        possible: Sequence[Thing],
        heat: Any,
        *,
        lateral: bool = False,
    ) -> None:
        self.num_envs, self.config, self.heat = num_envs, config, heat
        self._choices, self._shapes, self._stack = config.choices, config.shapes, sensor(config.sensor)
        self._causes = checked(config.randomize)
        self.mechanics = Mechanics(
            specs,
            num_envs,
            threads=config.threads,
            library=[thing.spec for thing in possible if thing.spec.mesh],
            settings=config.solver,
            gripper=config.gripper_for(possible),
            lateral=lateral,
            contacts=config.taxels is not None or config.face_temperature is not None,
        )
        self.dt = config.substeps * config.solver.timestep
        self.sample_rate = 1 / SAMPLE_PERIOD
        self.scenes: list[Scene] = [(possible[0],) * len(specs)] * num_envs
        self._taxels, self._faces = config.tactile, config.face_maps(num_envs, self._stack)
        self._electronics = Electronics(
            num_envs, config.chain, self._stack.seebeck, SAMPLE_PERIOD, config.samples, config.most_delay
        )
        self._thermostats = Thermostats(num_envs, config.heater, config.sensor_temperatures, self.dt)
        nothing = np.random.default_rng(0)
        self._rngs: list[np.random.Generator] = [nothing] * num_envs
        self._drawn = [draw((), nothing)] * num_envs
        names = np.full(num_envs, "", object)
        # Replaced, never written to: readings keep it.
        self._episodes = Episodes(config.mode, names, names, np.full(num_envs, np.inf), {})

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment's scene."""
        return self.mechanics.model

    def temperatures(self, row: int) -> tuple[float, ...]:
        """°C between which the row's heat stays: of its thermostats, objects, room and reservoirs."""
        objects = (celsius for thing in self.scenes[row] for celsius in thing.extremes)
        return (*self.heat.sensor_temperatures[row], *objects)

    def close(self) -> None:  # noqa: B027  a plant may hold something; this one does not
        """Nothing is held."""

    def state(self, rows: Sequence[int]) -> PlantState:
        """A copy of the rows' state."""
        chosen = list(rows)
        return PlantState(
            self.mechanics.state(np.array(chosen)),
            self.heat.state(chosen),
            self._electronics.state(chosen),
            self._thermostats.state(chosen),
            None if self._faces is None else self._faces.state(chosen),
            tuple(copy.deepcopy(self._rngs[row]) for row in chosen),
            tuple(self._drawn[row] for row in chosen),
            tuple(array[chosen] for array in self._own),
        )

    def set_state(self, rows: Sequence[int], state: PlantState) -> tuple[np.random.Generator, ...]:
        """Puts the rows into a state; what follows is bit-identical to what followed it first. Returns the generators
        the rows now draw from."""
        chosen = list(rows)
        self.mechanics.set_state(state.mechanics, np.array(chosen))
        self.heat.set_state(chosen, state.heat)
        self._electronics.set_state(chosen, state.electronics)
        self._thermostats.set_state(chosen, state.thermostats)
        rngs = tuple(copy.deepcopy(rng) for rng in state.generators)
        kept = state.heat.things if isinstance(state.heat, HeatState) else state.heat.rows.things
        for k, row in enumerate(chosen):
            specs = state.mechanics.objects[k]
            things = kept[k * len(specs) : (k + 1) * len(specs)]
            self.scenes[row] = tuple(replace(t, spec=spec) for t, spec in zip(things, specs, strict=True))
            self._rngs[row], self._drawn[row] = rngs[k], state.drawn[k]
        if self._faces is not None and state.faces is not None:
            self._faces.set_state(chosen, state.faces, [self.scenes[row] for row in chosen])
        for mine, theirs in zip(self._own, state.own, strict=True):
            mine[chosen] = theirs
        self._relabel(chosen)
        return rngs

    @property
    @abstractmethod
    def _own(self) -> tuple[np.ndarray, ...]:
        """(B, ...) each: what else the kind of plant remembers."""
        ...

    @abstractmethod
    def _relabel(self, rows: Sequence[int]) -> None:
        """Names what the rows hold now."""
        ...

    def _begin(self, row: int, rng: np.random.Generator) -> dict[str, float]:
        """An episode of a row draws from this generator from now on. Returns what randomization draws for it."""
        self._rngs[row] = rng
        self._drawn[row] = drawn = draw(self._causes, rng)
        self._electronics.reset(row, drawn)
        return drawn

    def _place(self, rows: list[int], centred: Sequence[Any], **waiting: Any) -> None:
        """Puts the rows' scenes on the table, all at its first temperature. centred: the same objects where they lie
        before placement moves them, as the heat's reset takes them. waiting: see there."""
        scenes = [self.scenes[row] for row in rows]
        self.mechanics.reset(rows, [tuple(thing.spec for thing in scene) for scene in scenes])
        errors = np.array([[self._drawn[row]["thermostat_error"]] for row in rows])
        self.heat.reset(rows, centred, self._thermostats.setpoints[rows] + errors, **waiting)
        if self._faces is not None:
            self._faces.reset(rows, scenes)
        self._thermostats.reset(rows)

    def _regulate(self, step: HeatStep) -> None:
        """Lets thermostats of finite power answer to the heat drawn from them, and tells of those that are too hot."""
        first = self.heat.sensor_temperatures
        self.heat.set_thermostats(self._thermostats.step(step.told["drawn"], first))
        self._thermostats.tell(step.told)

    @property
    def _randomized(self) -> dict[str, np.ndarray]:
        """(B,) by name of what differs between episodes."""
        names = [CAUSES[type(cause)][0] for cause in self._causes]
        return {name: np.array([drawn[name] for drawn in self._drawn]) for name in names}

    def _still(self, rest: HeatStep, truth: Truth, told: tuple[str, ...]) -> Reading:
        """The reading before anything moves: nothing is touched, no voltage. rest: what heat tells then."""
        rows = self.num_envs
        return Reading(
            opening=self.mechanics.opening,
            opening_rate=np.zeros(rows),
            height=self.mechanics.height,
            force=np.zeros((rows, 2, 3)),
            voltage=np.zeros((rows, self.config.samples, 2)),
            thermostat=self._thermostats.measured,
            truth=truth,
            error=truth.error,
            told=told,
            pressure=None if self._taxels is None else self._taxels.nothing(rows),
            face_temperature=None if self._faces is None else self._faces.rest(rest),
        )

    def _reading(
        self,
        motion: Motion,
        step: HeatStep,
        truth: Truth,
        told: tuple[str, ...],
        owner: np.ndarray | None = None,
    ) -> Reading:
        """The reading after a control step. motion: its force is that on all objects. owner (B, F): the object that
        each fingertip touches, where there are several."""
        return Reading(
            opening=motion.opening,
            opening_rate=motion.opening_rate,
            height=motion.height,
            force=motion.force,
            voltage=self._electronics.measure(step.drop, self._rngs),
            thermostat=self._thermostats.measured,
            truth=truth,
            error=truth.error,
            told=told,
            pressure=None if self._taxels is None else self._taxels.pressure(self.mechanics),
            face_temperature=None if self._faces is None else self._faces.step(self.mechanics, step, owner),
        )
