"""The simulated plant: MuJoCo mechanics, contact heat and the fingertips' electronics for a batch of environments."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from thermograsp.errors import InvalidValueError, finite, non_negative, positive
from thermograsp.plant import Command, Reading

from ..thermal import (
    SEED_MATERIALS,
    SIGNAL_CHAINS,
    Material,
    Mode,
    SensorStack,
    SignalChain,
    Thermostat,
    material,
    materials,
    sensor,
)
from .electronics import Electronics, ElectronicsState
from .heat import GraspHeat, HeatState, HeatStep
from .mechanics import SUBSTEPS, Mechanics, MechanicsState
from .randomization import CAUSES, Cause, Delay, Size, checked, draw
from .scene import ObjectSpec, scaled
from .solver_settings import SHIPPED, SolverSettings
from .thermostats import Thermostats
from .things import Thing
from .truth import Truth

SAMPLE_PERIOD = 0.01  # s, of the converter's clock, and the heat's


@dataclass(frozen=True, slots=True)
class SimulationConfig:
    """What is simulated. material: a name, a Material, a list to draw from per episode, or None for the ten seed
    materials. mode: T or O. objects: the object's shape, or a list to draw from per episode (density and friction
    are the material's where a shape gives none). tolerance: K that the thermal network keeps. air: W/(m2 K).
    Temperatures in °C, that of the sensors one or each fingertip's. thermostat: one of finite power (its setpoint is
    sensor_temperature), None for an ideal one. placement: m and degree; the object lies within +- these of the middle,
    drawn per episode. randomize: what else differs from episode to episode, records of randomization.py. fingertips:
    how many carry a sensor (1: the left one). solver: MuJoCo's time step and settings. substeps: of MuJoCo in a control
    step, which must be a whole number of 10 ms samples. threads: of MuJoCo, 0 for all. cache: keep thermal networks on
    disk."""

    material: str | Material | Sequence[str | Material] | None = None
    mode: Mode = "T"
    objects: ObjectSpec | Sequence[ObjectSpec] | None = None
    tolerance: float = 0.05
    sensor: str | SensorStack = "seed"
    signal: str | SignalChain = "ads1115"
    air: float = 5.0
    sensor_temperature: float | tuple[float, float] = 36.0
    thermostat: Thermostat | None = None
    object_temperature: float = 24.0
    placement: tuple[float, float] = (0.002, 2.0)
    randomize: Sequence[Cause] = ()
    fingertips: Literal[1, 2] = 2
    solver: SolverSettings = SHIPPED
    substeps: int = SUBSTEPS
    threads: int = 1
    cache: bool = True

    def __post_init__(self) -> None:
        if self.mode not in ("T", "O"):
            raise InvalidValueError(f"mode must be 'T' or 'O', got {self.mode!r}")
        if self.fingertips not in (1, 2):
            raise InvalidValueError(f"fingertips must be 1 or 2, got {self.fingertips!r}")
        positive("tolerance (K)", self.tolerance)
        non_negative("air (W/(m2 K))", self.air)
        for value in self.sensor_temperatures:
            finite("sensor_temperature (°C)", value)
        if self.thermostat is not None and len(set(self.sensor_temperatures)) > 1:
            raise InvalidValueError(
                f"sensor_temperature {self.sensor_temperature!r} °C: a thermostat of finite power has one setpoint; "
                "give one temperature, or thermostat=None"
            )
        finite("object_temperature (°C)", self.object_temperature)
        for value in self.placement:
            non_negative("placement (m, degree)", value)
        checked(self.randomize)
        period = self.substeps * self.solver.timestep
        if self.substeps < 1 or self.samples < 1 or abs(period - self.samples * SAMPLE_PERIOD) > 1e-9:
            raise InvalidValueError(
                f"{self.substeps} substeps of {self.solver.timestep:g} s make a control step of {period:g} s: "
                f"give a whole number of {SAMPLE_PERIOD:g} s samples"
            )

    @property
    def choices(self) -> tuple[Material, ...]:
        """Materials that an episode draws from. Raises UnknownNameError, and InvalidValueError for an empty list."""
        given = SEED_MATERIALS if self.material is None else self.material
        listed = [given] if isinstance(given, str | Material) else list(given)
        if not listed:
            raise InvalidValueError(
                f"material is an empty list: give one of {len(materials())} names, or None"
            )
        return tuple(material(name) for name in listed)

    @property
    def sensor_temperatures(self) -> tuple[float, float]:
        """°C of the left and the right thermostat. Raises InvalidValueError for what is neither one nor two."""
        given = np.ravel(self.sensor_temperature).tolist()
        if len(given) not in (1, 2):
            raise InvalidValueError(
                f"sensor_temperature must be one °C or two, got {self.sensor_temperature!r}"
            )
        return given[0], given[-1]

    @property
    def shapes(self) -> tuple[ObjectSpec, ...]:
        """Shapes that an episode draws from. Raises InvalidValueError for an empty list, and where their names or
        numbers of convex pieces differ, which all environments of a batch share."""
        given = ObjectSpec() if self.objects is None else self.objects
        listed = (given,) if isinstance(given, ObjectSpec) else tuple(given)
        if len({(shape.name, shape.hulls) for shape in listed}) != 1:
            raise InvalidValueError(
                f"objects {[shape.name for shape in listed]} of {[shape.hulls for shape in listed]} convex pieces: "
                "give at least one, all of the same name and number of pieces"
            )
        return listed

    @property
    def samples(self) -> int:
        """Of voltage and heat in a control step."""
        return round(self.substeps * self.solver.timestep / SAMPLE_PERIOD)

    @property
    def chain(self) -> SignalChain:
        """The electronics. Raises InvalidValueError for a name that is none."""
        if isinstance(self.signal, SignalChain):
            return self.signal
        if self.signal not in SIGNAL_CHAINS:
            raise InvalidValueError(f"signal must be one of {sorted(SIGNAL_CHAINS)}, got {self.signal!r}")
        return SIGNAL_CHAINS[self.signal]

    @property
    def heat(self) -> dict[str, Any]:
        """Keywords of what computes the heat."""
        return {
            "tolerance": self.tolerance,
            "air": self.air,
            "dt": SAMPLE_PERIOD,
            "samples": self.samples,
            "sensor_temperature": self.sensor_temperature,
            "cache": self.cache,
        }

    def thing(
        self, stack: SensorStack, chosen: Material, spec: ObjectSpec, drawn: Mapping[str, float]
    ) -> Thing:
        """The object of that material: the material's density and friction where the shape gives none."""
        if spec.mass is None and spec.density is None:
            spec = replace(spec, density=chosen.density)
        if spec.friction is None and chosen.friction is not None:
            spec = replace(spec, friction=chosen.friction)
        spec = scaled(
            spec, drawn["size_factor"], mass=drawn["mass_factor"], friction=drawn["friction_factor"]
        )
        if self.mode == "O":
            spec = replace(spec, elements=(stack.width, stack.thickness))
        return Thing(
            spec,
            chosen,
            self.object_temperature + drawn["object_temperature_shift"],
            self.mode,
            stack,
            self.fingertips,
            drawn["roughness_factor"],
        )

    def possible_things(self, stack: SensorStack) -> list[Thing]:
        """Of every shape and size that may come, so that one too large is refused at once and not in some later
        episode."""
        plain, first = draw((), np.random.default_rng(0)), self.choices[0]
        factors = (cause.factors for cause in checked(self.randomize) if isinstance(cause, Size))
        sizes = [1.0, *(factor for some in factors for factor in some)]
        return [
            self.thing(stack, first, shape, {**plain, "size_factor": size})
            for shape in self.shapes
            for size in sizes
        ]

    @property
    def most_delay(self) -> int:
        """Samples by which voltages may be late."""
        causes = checked(self.randomize)
        return max((cause.most for cause in causes if isinstance(cause, Delay)), default=0)


@dataclass(frozen=True, slots=True)
class PlantState:
    """Everything that decides the future of some environments of a simulated plant; picklable."""

    mechanics: MechanicsState
    heat: HeatState
    electronics: ElectronicsState
    thermostats: tuple[np.ndarray, ...]
    rest: np.ndarray
    generators: tuple[np.random.Generator, ...]
    drawn: tuple[dict[str, float], ...]


class SimulatedPlant:
    """A batch of simulated grippers; see thermograsp.plant.Plant. B: environments."""

    def __init__(self, num_envs: int, config: SimulationConfig) -> None:
        self.config = config
        self.num_envs = num_envs
        self._choices, self._stack = config.choices, sensor(config.sensor)
        self._causes = checked(config.randomize)
        plain = draw((), np.random.default_rng(0))
        self._shapes = config.shapes
        possible = config.possible_things(self._stack)
        first = possible[0]
        self.mechanics = Mechanics(
            (first.spec,),
            num_envs,
            threads=config.threads,
            library=[thing.spec for thing in possible if thing.spec.mesh],
            settings=config.solver,
        )
        self.dt = config.substeps * config.solver.timestep
        self.sample_rate = 1 / SAMPLE_PERIOD
        self.heat = GraspHeat(num_envs, **config.heat)
        self.things: list[Thing] = [first] * num_envs
        self._rngs: list[np.random.Generator] = [np.random.default_rng(0)] * num_envs
        self._electronics = Electronics(
            num_envs, config.chain, self._stack.seebeck, SAMPLE_PERIOD, config.samples, config.most_delay
        )
        self._drawn = [plain] * num_envs
        self._thermostats = Thermostats(num_envs, config.thermostat, config.sensor_temperatures, self.dt)
        self._rest = np.zeros(num_envs)
        # Replaced, never written to: readings keep them.
        self._material, self._rung = np.full(num_envs, "", object), np.full(num_envs, "", object)
        self._crushing_force = np.full(num_envs, np.inf)
        self._randomized: dict[str, np.ndarray] = {}

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment's scene."""
        return self.mechanics.model

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Starts the rows anew: draws material and placement, opens the gripper. options: material, for this
        episode."""
        unknown = set(options) - {"material"}
        if unknown:
            raise InvalidValueError(f"unknown reset options {sorted(unknown)}: material is known")
        choices = self._choices
        if "material" in options:
            choices = replace(self.config, material=options["material"]).choices
        reach, turn = self.config.placement
        for row, rng in zip(rows, rngs, strict=True):
            chosen = choices[int(rng.integers(len(choices)))]
            x, y, angle = rng.uniform(-1.0, 1.0, 3)
            shape = self._shapes[int(rng.integers(len(self._shapes))) if len(self._shapes) > 1 else 0]
            turned = shape.yaw + np.deg2rad(angle * turn)
            spec = replace(shape, position=(x * reach, y * reach), yaw=turned)
            self._drawn[row] = drawn = draw(self._causes, rng)
            self.things[row] = self.config.thing(self._stack, chosen, spec, drawn)
            self._rngs[row] = rng
            self._electronics.reset(row, drawn)
        things = [self.things[row] for row in rows]
        self.mechanics.reset(rows, [(thing.spec,) for thing in things])
        self.heat.reset(
            rows,
            [replace(t, spec=replace(t.spec, position=(0.0, 0.0), yaw=0.0)) for t in things],
            self._thermostats.setpoints[list(rows)]
            + np.array([[self._drawn[row]["thermostat_error"]] for row in rows]),
        )
        chosen = list(rows)
        self._thermostats.reset(chosen)
        self._rest[chosen] = self.mechanics.object_pose[chosen, 0, 2]
        self._relabel(chosen)
        return self._still()

    def step(self, command: Command) -> Reading:
        """One control step of all environments."""
        motion = self.mechanics.advance(
            command.opening, command.force_limit, command.lift_rate, self.config.substeps
        )
        step = self.heat.advance(motion.normal, motion.place)
        if not self._thermostats.ideal:
            first = self.heat.sensor_temperatures
            self.heat.set_thermostats(self._thermostats.step(step.told["drawn"], first))
        error = tuple(self.mechanics.failure)
        return Reading(
            opening=motion.opening,
            opening_rate=motion.opening_rate,
            height=motion.height,
            force=motion.force,
            voltage=self._electronics.measure(step.drop, self._rngs),
            thermostat=self._thermostats.measured,
            truth=self._truth(motion.object_height, step, error),
            error=error,
        )

    def temperatures(self, row: int) -> tuple[float, ...]:
        """°C that the row's thermostats and object started from."""
        return (*self.heat.sensor_temperatures[row], self.things[row].temperature)

    def close(self) -> None:
        """Nothing is held."""

    def state(self, rows: Sequence[int]) -> PlantState:
        """A copy of the rows' state."""
        chosen = list(rows)
        return PlantState(
            self.mechanics.state(np.array(chosen)),
            self.heat.state(chosen),
            self._electronics.state(chosen),
            self._thermostats.state(chosen),
            self._rest[chosen],
            tuple(copy.deepcopy(self._rngs[row]) for row in chosen),
            tuple(self._drawn[row] for row in chosen),
        )

    def set_state(self, rows: Sequence[int], state: PlantState) -> tuple[np.random.Generator, ...]:
        """Puts the rows into a state; what follows is bit-identical to what followed it first. Returns the generators
        the rows now draw from."""
        chosen = list(rows)
        self.mechanics.set_state(state.mechanics, np.array(chosen))
        self.heat.set_state(chosen, state.heat)
        self._electronics.set_state(chosen, state.electronics)
        rngs = tuple(copy.deepcopy(rng) for rng in state.generators)
        for k, row in enumerate(chosen):
            self.things[row] = replace(state.heat.things[k], spec=state.mechanics.objects[k][0])
            self._rngs[row] = rngs[k]
            self._drawn[row] = state.drawn[k]
        self._thermostats.set_state(chosen, state.thermostats)
        self._rest[chosen] = state.rest
        self._relabel(chosen)
        return rngs

    def _relabel(self, rows: Sequence[int]) -> None:
        """Names what the rows hold now, in arrays of their own."""
        self._material, self._rung = self._material.copy(), self._rung.copy()
        self._crushing_force = self._crushing_force.copy()
        names = [CAUSES[type(cause)][0] for cause in self._causes]
        self._randomized = {name: np.array([drawn[name] for drawn in self._drawn]) for name in names}
        for row in rows:
            thing = self.things[row]
            self._material[row], self._rung[row] = thing.material.name, self.heat.rung(row)
            self._crushing_force[row] = thing.crushing_force

    def _truth(self, object_height: np.ndarray, step: HeatStep, error: tuple[str, ...]) -> Truth:
        return Truth(
            heat=step,
            mode=self.config.mode,
            material=self._material,
            rung=self._rung,
            crushing_force=self._crushing_force,
            lift=object_height - self._rest,
            error=error,
            randomized=self._randomized,
        )

    def _still(self) -> Reading:
        """The reading before anything moves: nothing is touched, no voltage."""
        rows, error = self.num_envs, tuple(self.mechanics.failure)
        return Reading(
            opening=self.mechanics.opening,
            opening_rate=np.zeros(rows),
            height=self.mechanics.height,
            force=np.zeros((rows, 2, 3)),
            voltage=np.zeros((rows, self.config.samples, 2)),
            thermostat=self._thermostats.measured,
            truth=self._truth(self.mechanics.object_pose[:, 0, 2], self.heat.rest(), error),
            error=error,
        )


def simulated_plant(url: str, num_envs: int, **config: Any) -> SimulatedPlant:
    """The plant behind plant="simulated". Keywords as in SimulationConfig. Raises InvalidValueError for others."""
    try:
        settings = SimulationConfig(**config)
    except TypeError as error:
        raise InvalidValueError(f"plant {url!r}: {error}") from None
    return SimulatedPlant(num_envs, settings)
