"""The simulated plant: MuJoCo mechanics, contact heat and the fingertips' electronics for a batch of environments.

B: environments, O: objects of a scene, F = 2 fingertips.
"""

from __future__ import annotations

import copy
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thermograsp.errors import InvalidValueError, whole_number
from thermograsp.notice import busy
from thermograsp.plant import Command, Reading

from ...thermal.stack import any_sensor
from ..footprint import GraspBody
from ..limits import SAMPLE_PERIOD
from ..mechanics import Mechanics, MechanicsState, Motion, refuse_overlap
from ..readout import Electronics, ElectronicsState, HeatedCores, Thermostats
from ..sensing import GraspHeat, HeatState, HeatStep, start_compiling
from .config import SimulationConfig, check_fields
from .layouts import EpisodeLabels, Layout, Scene, SceneLayout
from .randomization import CAUSES, draw
from .truth import INFO, Truth

if TYPE_CHECKING:
    from ..readout import FaceTemperature, FaceTemperatureState
    from ..sensing import FieldHeatState, SceneHeatState, SceneHeatStep


@dataclass(frozen=True, slots=True)
class PlantState:
    """Everything that decides the future of some environments of a simulated plant; picklable. centred: as in Episode.
    rest: (n, O) m, heights at which the objects lay. task: what the layout keeps of each episode. of: what it goes on
    with nowhere else, by keyword."""

    mechanics: MechanicsState
    heat: HeatState | SceneHeatState | FieldHeatState
    electronics: ElectronicsState
    thermostats: tuple[np.ndarray, ...]
    faces: FaceTemperatureState | None
    generators: tuple[np.random.Generator, ...]
    drawn: tuple[dict[str, float], ...]
    scenes: tuple[Scene, ...]
    centred: tuple[Scene, ...]
    rest: np.ndarray
    task: np.ndarray
    of: Mapping[str, Any]


class SimulatedPlant:
    """A batch of simulated grippers, each over the objects of its scene; see thermograsp.plant.Plant. layout: draws the
    scenes; None for the config's objects or scene. scenes: each environment's objects."""

    def __init__(self, num_envs: int, config: SimulationConfig, layout: Layout | None = None) -> None:
        start_compiling(boxes=config.by_kernels, fields=config.by_fields)
        self.layout: Layout = SceneLayout(config) if layout is None else layout
        self.num_envs, self.config, self._stack = whole_number("num_envs", num_envs, 1), config, config.stack
        possible, objects = self.layout.possible, len(self.layout.specs)
        self._alone = objects == 1  # and its heat needs no owner of each fingertip
        self.heat: Any = self._heat()
        self.mechanics = Mechanics(
            self.layout.specs,
            num_envs,
            threads=config.threads,
            library=[body.spec for body in possible if body.spec.mesh],
            settings=config.solver,
            gripper=config.gripper_for(possible),
            lateral=self.layout.lateral,
            contacts=config.taxels is not None or config.face_temperature is not None,
        )
        if not self._alone:
            refuse_overlap(self.mechanics.env_model(0), self.mechanics.env_data(0), self.mechanics.names)
        self.dt = config.substeps * config.solver.timestep
        self.sample_rate = 1 / SAMPLE_PERIOD
        self.scenes: list[Scene] = [(possible[0],) * objects] * num_envs
        self._centred = list(self.scenes)
        self._taxels, self._faces = config.tactile, config.face_maps(num_envs, self._stack)
        heated, starts = config.heated, config.sensor_temperatures
        per_kelvin = self._stack.seebeck if heated is None else 1.0  # a divider's voltage comes as it is
        self._electronics = Electronics(
            num_envs, config.chain, per_kelvin, SAMPLE_PERIOD, config.samples, config.most_delay
        )
        if heated is None:
            before = self._stack if config.mode == "T" else None
            self._thermostats = Thermostats(num_envs, config.heater, starts, before, self.dt)
            self._rest_voltage = np.zeros(2)
        else:
            self._thermostats = HeatedCores(num_envs, heated, starts, config.room, self.dt)
            self._rest_voltage = heated.divider.voltage(np.array(starts))
        self._info = (*INFO, *self.layout.info, *(() if self._thermostats.ideal else ("over_temperature",)))
        self._causes, nothing = config.causes, np.random.default_rng(0)
        self._rngs: list[np.random.Generator] = [nothing] * num_envs
        self._drawn = [draw((), nothing)] * num_envs
        self._of = {
            **{
                name: getattr(config, name)
                for name in ("mode", "tolerance", "air", "substeps", "solver", "thermostat")
            },
            "sensor": any_sensor(config.sensor),
            "longest delay": config.most_delay,
        }
        self._rest = np.zeros((num_envs, objects))
        self._task = np.zeros((num_envs, self.layout.task_size), int)
        # Replaced, never written to: readings keep them.
        crushing = np.asarray(
            self.layout.labels(self.scenes[0], self._centred[0], ("",) * objects).crushing_force
        )
        self._labels = EpisodeLabels(
            np.full(num_envs, "", object),
            np.full(num_envs, "", object),
            np.full((num_envs, *crushing.shape), np.inf),
        )
        self._randomized: dict[str, np.ndarray] = {}

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment's scene."""
        return self.mechanics.model

    @property
    def bodies(self) -> list[GraspBody]:
        """The first object of each environment, which it is to grasp."""
        return [scene[0] for scene in self.scenes]

    @property
    def things(self) -> list[GraspBody]:
        """The old name of `bodies`; it goes with version 0.3."""
        warnings.warn("SimulatedPlant.things is now SimulatedPlant.bodies", DeprecationWarning, stacklevel=2)
        return self.bodies

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Starts the rows anew: draws objects and placement, opens the gripper. options: see the layout."""
        chosen = list(rows)
        for row, rng in zip(chosen, rngs, strict=True):
            episode = self.layout.draw(rng, options)
            self._rngs[row], self._drawn[row] = rng, episode.drawn
            self._electronics.reset(row, episode.drawn, self._rest_voltage)
            self.scenes[row], self._centred[row] = episode.scene, episode.centred
            self._task[row] = episode.task
        with busy(f"preparing {len(rows)} scene{'s' * (len(rows) > 1)}: shapes and thermal networks"):
            self._place(chosen)
        self._rest[chosen] = self.mechanics.object_pose[chosen, :, 2]
        self._relabel(chosen)
        rest, scene = self.heat.rest(), None
        if not self._alone:
            rest, scene = rest.fingertips, rest
        force = np.zeros((self.num_envs, self._rest.shape[1], 2, 3))
        truth = self._truth(self.mechanics.object_pose[:, :, 2], force, rest, scene)
        return Reading(
            opening=self.mechanics.opening,
            opening_rate=np.zeros(self.num_envs),
            height=self.mechanics.height,
            force=np.zeros((self.num_envs, 2, 3)),
            voltage=np.zeros((self.num_envs, self.config.samples, 2)) + self._rest_voltage,
            thermostat=self._thermostats.measured,
            truth=truth,
            error=self.mechanics.failure,
            info_names=self._info,
            lateral=self._lateral,
            pressure=None if self._taxels is None else self._taxels.nothing(self.num_envs),
            face_temperature=None if self._faces is None else self._faces.rest(rest),
        )

    def step(self, command: Command) -> Reading:
        """One control step of all environments."""
        motion, scene, owner = self._move(command), None, None
        if self._alone:
            step = self.heat.advance(motion.normal[:, 0], motion.place[:, 0])
        else:
            scene = self.heat.advance(motion.normal, motion.place)
            step, owner = scene.fingertips, scene.owner
        force = _summed(motion.force)
        if not self._thermostats.ideal:
            self._regulate(step, np.linalg.norm(force, axis=2))
        truth = self._truth(motion.object_height, motion.force, step, scene)
        return Reading(
            opening=motion.opening,
            opening_rate=motion.opening_rate,
            height=motion.height,
            force=force,
            voltage=self._electronics.measure(self._sent(step), self._rngs),
            thermostat=self._thermostats.measured,
            truth=truth,
            error=self.mechanics.failure,
            info_names=self._info,
            lateral=self._lateral,
            pressure=None if self._taxels is None else self._taxels.pressure(self.mechanics),
            face_temperature=None if self._faces is None else self._map_faces(self._faces, step, owner),
        )

    def _map_faces(self, faces: FaceTemperature, step: HeatStep, owner: np.ndarray | None) -> np.ndarray:
        """(B, F, n, m) °C. While a contact opens, more flows through a narrow one in a sample than at its end: without
        bounds the map would be hotter or colder at places than anything that takes part."""
        maps = faces.step(self.mechanics, step, owner)
        means = step.info["sensor_surface"], step.info["object_surface"]
        for row, each in enumerate(maps):
            every = (*self.temperatures(row), *means[0][row], *means[1][row])
            np.clip(each, min(every), max(every), out=each)
        return maps

    def temperatures(self, row: int) -> tuple[float, ...]:
        """°C between which the row's heat stays: of its thermostats, objects, room and reservoirs."""
        objects = (celsius for body in self.scenes[row] for celsius in body.extremes)
        return (*self.heat.sensor_temperatures[row], *objects)

    def close(self) -> None:
        """Nothing is held."""

    def state(self, rows: Sequence[int]) -> PlantState:
        """A copy of the rows' state."""
        chosen = list(rows)
        return PlantState(
            mechanics=self.mechanics.state(np.array(chosen)),
            heat=self.heat.state(chosen),
            electronics=self._electronics.state(chosen),
            thermostats=self._thermostats.state(chosen),
            faces=None if self._faces is None else self._faces.state(chosen),
            generators=tuple(copy.deepcopy(self._rngs[row]) for row in chosen),
            drawn=tuple(self._drawn[row] for row in chosen),
            scenes=tuple(self.scenes[row] for row in chosen),
            centred=tuple(self._centred[row] for row in chosen),
            rest=self._rest[chosen],
            task=self._task[chosen],
            of=self._of,
        )

    def set_state(self, rows: Sequence[int], state: PlantState) -> tuple[np.random.Generator, ...]:
        """Puts the rows into a state; what follows is bit-identical to what followed it first. Returns the generators
        the rows now draw from. Raises InvalidValueError for a state of other keywords, which says of which."""
        for name, ours in self._of.items():
            saved = state.of[name]
            if saved != ours:
                brief = isinstance(ours, str | float | int)  # all of a sensor's layers are not
                difference = f"is {saved!r} in place of {ours!r}" if brief else "is another one"
                raise InvalidValueError(
                    f"the state is of environments whose {name} {difference}: make these like those"
                )
        chosen = list(rows)
        self.mechanics.set_state(state.mechanics, np.array(chosen))
        self.heat.set_state(chosen, state.heat)
        self._electronics.set_state(chosen, state.electronics)
        self._thermostats.set_state(chosen, state.thermostats)
        rngs = tuple(copy.deepcopy(rng) for rng in state.generators)
        for k, row in enumerate(chosen):
            self.scenes[row], self._centred[row] = state.scenes[k], state.centred[k]
            self._rngs[row], self._drawn[row] = rngs[k], state.drawn[k]
        if self._faces is not None and state.faces is not None:
            self._faces.set_state(chosen, state.faces, state.scenes)
        self._rest[chosen], self._task[chosen] = state.rest, state.task
        self._relabel(chosen)
        return rngs

    @property
    def _lateral(self) -> np.ndarray | None:
        return self.mechanics.lateral if self.layout.lateral else None

    def _heat(self) -> Any:
        """What computes it; nothing that pads or several objects need is loaded without them."""
        rows, objects, settings = self.num_envs, len(self.layout.specs), self.config.heat
        if self.config.by_fields:
            from ..sensing import FieldHeat, FieldScenes

            return FieldHeat(rows, **settings) if self._alone else FieldScenes(rows, objects, **settings)
        if self._alone:
            return GraspHeat(rows, **settings)
        from ..sensing import SceneHeat

        return SceneHeat(rows, objects, **settings)

    def _move(self, command: Command) -> Motion:
        """One control step of the mechanics."""
        mechanics, substeps = self.mechanics, self.config.substeps
        arm = command.opening, command.force_limit, command.lift_rate
        if self.layout.lateral:
            sideways = np.zeros(self.num_envs) if command.lateral_rate is None else command.lateral_rate
            return mechanics.slide(*arm, sideways, substeps)
        return mechanics.advance_all(*arm, substeps)

    def _place(self, rows: list[int]) -> None:
        """Puts the rows' scenes on the table, all at its first temperature."""
        scenes, centred = [self.scenes[row] for row in rows], [self._centred[row] for row in rows]
        self.mechanics.reset(rows, [tuple(body.spec for body in scene) for scene in scenes])
        errors = np.array([[self._drawn[row]["thermostat_error"]] for row in rows])
        setpoints = self._thermostats.setpoints[rows] + errors
        if self._alone:
            self.heat.reset(rows, [scene[0] for scene in centred], setpoints)
        else:
            self.heat.reset(rows, centred, setpoints, waiting=self.layout.build_when_touched)
        if self._faces is not None:
            self._faces.reset(rows, scenes)
        self._thermostats.reset(rows)

    def _regulate(self, step: HeatStep, force: np.ndarray) -> None:
        """Lets thermostats of finite power, or heaters of the sensors' own, answer to the heat drawn from them, and
        tells of those that are too hot. force: (B, F) N on the pads."""
        first, drawn = self.heat.sensor_temperatures, step.info["drawn"]
        if isinstance(self._thermostats, HeatedCores):
            after = self._thermostats.step(drawn, first, step.drop[:, -1], force)
        else:
            after = self._thermostats.step(drawn, first)
        self.heat.set_thermostats(after)
        self._thermostats.tell(step.info)

    def _sent(self, step: HeatStep) -> np.ndarray:
        """(B, N, F) what the electronics take: K of drop, or V of heated sensors' dividers."""
        if isinstance(self._thermostats, HeatedCores):
            return np.ascontiguousarray(self._thermostats.voltage(step.drop))
        return step.drop

    def _relabel(self, rows: Sequence[int]) -> None:
        """Names what the rows hold now."""
        labels = EpisodeLabels(*(values.copy() for values in self._labels))
        for row in rows:
            rung = self.heat.rung(row)
            rungs = (rung,) if self._alone else rung
            found = self.layout.labels(self.scenes[row], self._centred[row], rungs)
            for values, value in zip(labels, found, strict=True):
                values[row] = value
        self._labels = labels
        names = [CAUSES[type(cause)][0] for cause in self._causes]
        self._randomized = {name: np.array([drawn[name] for drawn in self._drawn]) for name in names}

    def _truth(
        self, heights: np.ndarray, force: np.ndarray, step: HeatStep, scene: SceneHeatStep | None
    ) -> Truth:
        """What is known of a step. heights: (B, O) m. force: (B, O, F, 3) N."""
        heat, labels, lift = step.info, self._labels, heights - self._rest
        truth: Truth = {
            "mode": self.config.mode,
            "material": labels.material,
            "temperature_drop": step.drop[:, -1],
            "temperature_drops": step.drop,
            "contact_area": heat["area"],
            "conductance": heat["conductance"],
            "sensor_surface": heat["sensor_surface"],
            "object_surface": heat["object_surface"],
            "object_temperature": heat["object_temperature"],
            "heat_flow": heat["flow"],
            "heat_drawn": heat["drawn"],
            "heat": heat["heat"],
            "heat_imbalance": heat["imbalance"],
            "heat_exchanged": heat["exchanged"],
            "reservoir_temperature": heat["reservoir_temperature"],
            "over_temperature": heat["over_temperature"],
            "events": step.events,
            "rung": labels.rung,
            "lift": lift[:, 0],
            "crushing_force": labels.crushing_force,
            "randomized": self._randomized,
            "failed": self.mechanics.failed,
        }
        if scene is not None:
            truth["object_temperatures"] = scene.objects["object_temperature"].copy()
            truth["touched"] = scene.owner.copy()
        self.layout.extend(truth, self._task, lift, force)
        return truth


def _summed(force: np.ndarray) -> np.ndarray:
    """(B, F, 3) N on all objects, from (B, O, F, 3) one after the other."""
    total = force[:, 0]
    for number in range(1, force.shape[1]):
        total = total + force[:, number]
    return total


def simulated_plant(url: str, num_envs: int, **config: Any) -> SimulatedPlant:
    """The plant behind plant="simulated". Keywords as in SimulationConfig. Raises UnknownKeywordError for others."""
    check_fields(url, config)
    return SimulatedPlant(num_envs, SimulationConfig(**config))
