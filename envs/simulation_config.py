"""What a simulated plant simulates: objects, materials, temperatures, sensor, and how accurately."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, non_negative, positive

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
)
from .gripper_shipped import SHIPPED_GRIPPER, GripperModel
from .mechanics import SUBSTEPS
from .observation import THERMOSTAT
from .randomization import Cause, Delay, Size, checked, draw
from .scene import ObjectSpec, scaled
from .solver_settings import SHIPPED, SolverSettings
from .things import Thing

if TYPE_CHECKING:
    from .face_temperature import FaceTemperature
    from .taxels import Taxels

SAMPLE_PERIOD = 0.01  # s, of the converter's clock, and the heat's


@dataclass(frozen=True, slots=True)
class SimulationConfig:
    """What is simulated. material: a name, a Material, a list to draw from per episode, or None for an object's own and
    else the ten seed materials. mode: T or O. objects: the object's shape, its name in the library, or a list to draw
    from per episode (density and friction are the material's where a shape gives none). scene: objects that are all
    there in place of one, the first is the one to grasp; where they have no material of their own it is drawn for each.
    tolerance: K that the thermal
    network keeps. air: W/(m2 K). Temperatures in °C, that of the sensors one or each fingertip's; an object with a
    temperature of its own has that, and the room is as warm as object_temperature unless ambient_temperature is given.
    thermostat: one of finite power (its setpoint is sensor_temperature, its ambient the room where that is given), None
    for an ideal one. placement: m and degree; the object lies within +- these of its own place, drawn per episode.
    randomize: what else differs from episode to episode, records of randomization.py. fingertips: how many carry a
    sensor (1: the left one). anywhere: heat knows where it enters boxes, cylinders and spheres, as it always does of
    meshes in mode T; without, each patch is the middle of a face. gripper: an MJCF file, an MjSpec or what load_gripper
    makes of them, None for the shipped one. solver: MuJoCo's time step and settings. substeps: of MuJoCo in a control
    step, which must be a whole number of 10 ms samples. threads: of MuJoCo, 0 for all. cache: keep thermal networks on
    disk. taxels: (n, m) of the map of pressure over each pad, None for none. face_temperature: (n, m) of the map of
    temperature over each sensor's face (T mode), None for none."""

    material: str | Material | Sequence[str | Material] | None = None
    mode: Mode = "T"
    objects: str | ObjectSpec | Sequence[str | ObjectSpec] | None = None
    scene: Sequence[str | ObjectSpec] | None = None
    tolerance: float = 0.05
    sensor: str | SensorStack = "seed"
    signal: str | SignalChain = "ads1115"
    air: float = 5.0
    sensor_temperature: float | tuple[float, float] = 36.0
    thermostat: Thermostat | None = None
    object_temperature: float = 24.0
    ambient_temperature: float | None = None
    placement: tuple[float, float] = (0.002, 2.0)
    randomize: Sequence[Cause] = ()
    fingertips: Literal[1, 2] = 2
    anywhere: bool = False
    gripper: Any = None
    solver: SolverSettings = SHIPPED
    substeps: int = SUBSTEPS
    threads: int = 1
    cache: bool = True
    taxels: tuple[int, int] | None = None
    face_temperature: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        if self.mode not in ("T", "O"):
            raise InvalidValueError(f"mode must be 'T' or 'O', got {self.mode!r}")
        if self.fingertips not in (1, 2):
            raise InvalidValueError(f"fingertips must be 1 or 2, got {self.fingertips!r}")
        positive("tolerance (K)", self.tolerance)
        non_negative("air (W/(m2 K))", self.air)
        for value in self.sensor_temperatures:
            if not THERMOSTAT[0] <= celsius("sensor_temperature", value) <= THERMOSTAT[1]:
                raise InvalidValueError(
                    f"sensor_temperature {value:g} °C: a fingertip reads {THERMOSTAT[0]:g} to {THERMOSTAT[1]:g} °C"
                )
        if self.thermostat is not None and len(set(self.sensor_temperatures)) > 1:
            raise InvalidValueError(
                f"sensor_temperature {self.sensor_temperature!r} °C: a thermostat of finite power has one setpoint; "
                "give one temperature, or thermostat=None"
            )
        celsius("object_temperature", self.object_temperature)
        if self.ambient_temperature is not None:
            celsius("ambient_temperature", self.ambient_temperature)
        for value in self.placement:
            non_negative("placement (m, degree)", value)
        checked(self.randomize)
        _ = self.tactile  # checks it
        if self.face_temperature is not None:
            self._check_face()
        if self.scene is not None and (self.objects is not None or self.mode == "O" or not len(self.scene)):
            raise InvalidValueError(
                f"scene of {len(self.scene)} objects, objects {self.objects!r}, mode {self.mode!r}: a scene has one "
                "object at least, stands in place of objects, and is of mode 'T'"
            )
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
        """Shapes that an episode draws from. Raises UnknownNameError; InvalidValueError for an empty list, and where
        their names or numbers of convex pieces differ, which all environments of a batch share."""
        if self.scene is not None:
            return self._all_there[:1]
        given = ObjectSpec() if self.objects is None else self.objects
        several = [given] if isinstance(given, str | ObjectSpec) else given
        listed = tuple(_from_library(one) if isinstance(one, str) else one for one in several)
        if len({(shape.name, shape.hulls) for shape in listed}) != 1:
            raise InvalidValueError(
                f"objects {[shape.name for shape in listed]} of {[shape.hulls for shape in listed]} convex pieces: "
                "give at least one, all of the same name and number of pieces"
            )
        return listed

    @property
    def others(self) -> tuple[ObjectSpec, ...]:
        """Of the scene, beside the first."""
        return self._all_there[1:]

    @property
    def _all_there(self) -> tuple[ObjectSpec, ...]:
        if self.scene is None:
            return ()
        from .other_objects import apart  # nothing that several objects need is loaded without them

        return apart([_from_library(one) if isinstance(one, str) else one for one in self.scene])

    @property
    def tactile(self) -> Taxels | None:
        """What maps the pressure over the pads. Raises InvalidValueError for taxels that are none."""
        if self.taxels is None:
            return None
        from .taxels import Taxels  # nothing that taxels need is loaded without them

        return Taxels(self.taxels)

    def face_maps(self, num_envs: int, stack: SensorStack) -> FaceTemperature | None:
        """What maps the temperature over the sensors' faces."""
        if self.face_temperature is None:
            return None
        from .face_temperature import FaceTemperature  # nothing that it needs is loaded without it

        return FaceTemperature(self.face_temperature, num_envs, stack, self.samples * SAMPLE_PERIOD)

    def _check_face(self) -> None:
        from .taxels import checked_taxels

        checked_taxels(self.face_temperature, "face_temperature")
        if self.mode == "O":
            raise InvalidValueError(
                "face_temperature in mode 'O': the fingertip's face is its thermostat there, whose temperature is the "
                "observation's thermostat; leave face_temperature out or use mode 'T'"
            )

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
    def heater(self) -> Thermostat | None:
        """The fingertips' thermostat in this room."""
        if self.thermostat is None or self.ambient_temperature is None:
            return self.thermostat
        return replace(self.thermostat, ambient=self.ambient_temperature)

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
        """The object, of that material or, where none was asked for, of its own: the material's density and friction
        where the shape gives none. Raises InvalidValueError for parts in mode O."""
        if spec.material is not None:
            chosen = material(spec.material) if self.material is None else chosen
            spec = replace(spec, material=chosen if spec.parts else None)
        if spec.parts:
            if self.mode == "O":
                raise InvalidValueError(
                    f"object {spec.name!r} has parts of other materials, which mode 'O' cannot tell: use mode 'T'"
                )
            spec = replace(spec, friction=spec.sliding_friction)
        elif spec.mass is None and spec.density is None:
            spec = replace(spec, density=chosen.density)
        if spec.friction is None and chosen.friction is not None:
            spec = replace(spec, friction=chosen.friction)
        spec = scaled(
            spec, drawn["size_factor"], mass=drawn["mass_factor"], friction=drawn["friction_factor"]
        )
        if self.mode == "O":
            spec = replace(spec, elements=(stack.width, stack.thickness))
        shift, room = drawn["object_temperature_shift"], self.ambient_temperature
        usual = self.object_temperature + shift
        return Thing(
            spec,
            chosen,
            usual if spec.temperature is None else spec.temperature + shift,
            self.mode,
            stack,
            self.fingertips,
            drawn["roughness_factor"],
            usual if room is None else room,
            self.anywhere,
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

    def gripper_for(self, things: Sequence[Thing]) -> GripperModel:
        """The gripper, read. Raises GripperError for what is none, and InvalidValueError for a thing that it cannot
        take."""
        if self.gripper is None:
            return SHIPPED_GRIPPER
        from .gripper_load import load_gripper  # nothing that another gripper needs is loaded without one

        gripper = load_gripper(self.gripper)
        for thing in things:
            gripper.wrist_at(thing.spec)
        return gripper

    @property
    def most_delay(self) -> int:
        """Samples by which voltages may be late."""
        causes = checked(self.randomize)
        return max((cause.most for cause in causes if isinstance(cause, Delay)), default=0)


def _from_library(name: str) -> ObjectSpec:
    from .library import library_object

    return library_object(name).spec()
