"""What a simulated plant simulates: objects, materials, temperatures, sensor, and how accurately."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from thermograsp.errors import (
    LONGEST,
    InvalidValueError,
    celsius,
    non_negative,
    numbers,
    positive,
    unknown_keyword,
    whole_number,
    within,
)

from ...thermal import (
    SEED_MATERIALS,
    SIGNAL_CHAINS,
    Material,
    Mode,
    SensorStack,
    SignalChain,
    Skin,
    Surface,
    Surround,
    Thermostat,
    material,
    materials,
)
from ...thermal.matter import skin as named_skin
from ...thermal.stack import HeatedStack, any_sensor, converter, heated_core
from ..bodies import ObjectSpec, scaled
from ..footprint import GraspBody
from ..grippers import SHIPPED_GRIPPER, GripperModel
from ..limits import SAMPLE_PERIOD, SUBSTEPS, THERMOSTAT
from ..mechanics import SHIPPED, SolverSettings
from .fingertips import AUTO, check_touched_by_pad, checked_heated, pad_around, usual_skin
from .objects import all_plain_boxes, check_objects, drawn_objects, scene_objects
from .randomization import Cause, Delay, Size, checked, draw
from .temperatures import check_drawn_temperatures, most_difference

if TYPE_CHECKING:
    from ..footprint import Taxels
    from ..readout import FaceTemperature

_ROOM = 0.002  # m between a sensor's face and a box's edge, from which on the edge is not felt


@dataclass(frozen=True)
class SimulationConfig:
    """What is simulated. material: a name, a Material, a list to draw from per episode, or None for an object's own and
    else the ten seed materials. mode: T or O. objects: the object's shape, its name in the library, or a list to draw
    from per episode (density and friction are the material's where a shape gives none). scene: objects that are all
    there in place of one, the first is the one to grasp; where they have no material of their own it is drawn for each.
    tolerance: K of temperature drop that the thermal network keeps; what air at the object's mean temperature adds is
    left out (docs/environments.md), and so is what the pad around the sensor does without `surround` (docs/physics.md).
    air: W/(m2 K).
    Temperatures in °C, that of the sensors one or each fingertip's; an object with a temperature of its own has that,
    and the room is as warm as object_temperature unless ambient_temperature is given. thermostat: one of finite power
    (its setpoint is sensor_temperature, its ambient the room where that is given), None for an ideal one. placement: m
    and degree; the object lies within +- these of its own place, drawn per episode. randomize: what else differs from
    episode to episode, records of randomization.py. fingertips: how many carry a sensor (1: the left one). anywhere:
    heat knows where it enters objects, in mode T; False: each patch, but those of meshes, is the middle of a face;
    "auto": so it is on boxes whose edges stay 2 mm away from the sensors' faces. Unless it is False, contacts of round
    objects and meshes have their true size at each force (docs/physics.md, The contact). gripper: an MJCF file, an
    MjSpec, what load_gripper makes of them, or a GripperModel; None for the shipped one. solver: MuJoCo's time step and
    settings. substeps: of MuJoCo in a control step, which must be a whole number of 10 ms samples. threads: of MuJoCo,
    0 for all. cache: keep thermal networks on disk. skin: over the fingertips, a name of thermal.SKINS or a Skin, None
    for bare ones, or "auto": bare where all objects are boxes whose material is `material`'s, in mode O, and where the
    sensor has a heater of its own, else filled_silicone. taxels: (n, m) of the map of pressure over each pad, None for
    none. face_temperature: (n, m) of the map of temperature over each sensor's face (T mode), None for none. surround:
    the pad around the sensor, which gives heat to the sensor and to objects: the name of its material or a Material for
    one as wide as the pad, or a Surround that is no wider; None for a sensor by itself. Heat flows and heat that an
    environment tells are then those of element and pad together; with it heat knows where it enters all but boxes,
    whatever `anywhere` says."""

    material: str | Material | Sequence[str | Material] | None = None
    mode: Mode = "T"
    objects: str | ObjectSpec | Sequence[str | ObjectSpec] | None = None
    scene: Sequence[str | ObjectSpec] | None = None
    tolerance: float = 0.05
    sensor: str | SensorStack | HeatedStack = "seed"
    signal: str | SignalChain = "ads1115"
    air: float = 5.0
    sensor_temperature: float | tuple[float, float] = 36.0
    thermostat: Thermostat | None = None
    object_temperature: float = 24.0
    ambient_temperature: float | None = None
    placement: tuple[float, float] = (0.002, 2.0)
    randomize: Sequence[Cause] = ()
    fingertips: Literal[1, 2] = 2
    anywhere: bool | Literal["auto"] = AUTO
    gripper: Any = None
    solver: SolverSettings = SHIPPED
    substeps: int = SUBSTEPS
    threads: int = 1
    cache: bool = True
    taxels: tuple[int, int] | None = None
    face_temperature: tuple[int, int] | None = None
    skin: str | Skin | None = AUTO
    surround: str | Material | Surround | None = None

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
        for value in numbers("placement (m, degree)", self.placement, 2):
            non_negative("placement (m, degree)", value)
        within("placement", self.placement[0], 0.0, LONGEST, "m")
        checked(self.randomize)
        check_objects(
            "objects", [self.objects] if isinstance(self.objects, str | ObjectSpec) else self.objects
        )
        check_objects("scene", self.scene)
        if isinstance(self.skin, str) and self.skin == AUTO:
            plain = all_plain_boxes(self.objects if self.scene is None else self.scene)
            object.__setattr__(self, "skin", usual_skin(self.mode, self.sensor, plain))
        else:
            object.__setattr__(self, "skin", named_skin(self.skin, self.mode))
        _ = self.tactile  # checks it
        if self.face_temperature is not None:
            self._check_face()
        if self.surround is not None:
            self._check_surround()
        if self.scene is not None and (self.objects is not None or self.mode == "O" or not len(self.scene)):
            raise InvalidValueError(
                f"scene of {len(self.scene)} objects, objects {self.objects!r}, mode {self.mode!r}: a scene needs "
                "at least one object and mode 'T', and it replaces `objects`"
            )
        if not isinstance(self.solver, SolverSettings):
            raise InvalidValueError(f"solver must be SolverSettings, got {self.solver!r}")
        if not isinstance(self.cache, bool | np.bool_):
            raise InvalidValueError(f"cache must be True or False, got {self.cache!r}")
        if isinstance(self.anywhere, bool | np.bool_):
            object.__setattr__(self, "anywhere", bool(self.anywhere))
        elif self.anywhere != AUTO:
            raise InvalidValueError(f"anywhere must be True, False or 'auto', got {self.anywhere!r}")
        whole_number("threads", self.threads)
        period = whole_number("substeps", self.substeps, 1) * self.solver.timestep
        if self.samples < 1 or abs(period - self.samples * SAMPLE_PERIOD) > 1e-9:
            raise InvalidValueError(
                f"{self.substeps} substeps of {self.solver.timestep:g} s make a control step of {period:g} s: "
                f"give a whole number of {SAMPLE_PERIOD:g} s samples"
            )

    @property
    def worn(self) -> Skin | None:
        """The fingertips' skin."""
        return named_skin(self.skin)

    @cached_property
    def around(self) -> Surround | None:
        """The pad around the sensor, with its depth. Raises UnknownNameError for a name that is none, and
        InvalidValueError for a pad that is none or that cannot be around the sensor."""
        return pad_around(self.surround, self.mode, any_sensor(self.sensor))

    def _check_surround(self) -> None:
        """Raises InvalidValueError for what has no pad around the sensor."""
        _ = self.around  # checks it
        for given, why in (
            (self.thermostat is not None, "a thermostat of finite power: leave thermostat out"),
            (self.face_temperature is not None, "a map of face_temperature: leave it out"),
        ):
            if given:
                raise InvalidValueError(f"surround {self.surround!r} does not go with {why}")
        check_touched_by_pad(self.surround, (*self.shapes, *self.others))

    @cached_property
    def by_fields(self) -> bool:
        """Whether heat flows in the fields of ThermalTouch, which know where it enters and how broad a contact is at
        each force: round objects and meshes without parts unless `anywhere` is False, and all that a pad around the
        sensor may touch beside the middle of boxes' faces."""
        sizes = (cause.extremes for cause in self.causes if isinstance(cause, Size))
        least = min((1.0, *(factor for some in sizes for factor in some)))
        every = (*(scaled(shape, least) for shape in self.shapes), *self.others)
        if self.surround is not None:
            return any(shape.shape != "box" or self._anywhere(shape) for shape in every)
        if self.anywhere is False or self.mode == "O" or any(shape.parts for shape in every):
            return False
        return any(shape.shape != "box" for shape in every)

    @property
    def _sensor(self) -> SensorStack | HeatedStack:
        """The sensor with its skin."""
        found, skin = any_sensor(self.sensor), self.worn
        return found if skin is None else skin.over(found)

    @property
    def heated(self) -> HeatedStack | None:
        """The sensor, where it has a heater of its own. Raises UnknownNameError for a name that is none, and
        InvalidValueError for what it cannot be together with."""
        return checked_heated(
            self._sensor,
            on_thermostat=self.mode == "O" or self.thermostat is not None,
            mapped=self.face_temperature is not None,
        )

    @property
    def room(self) -> float:
        """°C of the air."""
        return self.object_temperature if self.ambient_temperature is None else self.ambient_temperature

    @property
    def stack(self) -> SensorStack:
        """The layers of sensor and skin that networks know: all, or those in front of the sensor's heater."""
        heated = self.heated
        if heated is not None:
            return heated_core(heated, SAMPLE_PERIOD).element
        return self._sensor  # pyright: ignore[reportReturnType]

    @property
    def choices(self) -> tuple[Material, ...]:
        """Materials that an episode draws from. Raises UnknownNameError, and InvalidValueError for an empty list and
        for what is no list."""
        given = SEED_MATERIALS if self.material is None else self.material
        try:
            listed = [given] if isinstance(given, str | Material) else list(given)
        except TypeError:
            raise InvalidValueError(
                f"material must be a name, a Material or a list of them, got {given!r}"
            ) from None
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
            return self._scene_objects[:1]
        return drawn_objects(self.objects)

    @property
    def others(self) -> tuple[ObjectSpec, ...]:
        """The objects of the scene beside the first."""
        return self._scene_objects[1:]

    @property
    def _scene_objects(self) -> tuple[ObjectSpec, ...]:
        return () if self.scene is None else scene_objects(self.scene)

    @property
    def tactile(self) -> Taxels | None:
        """What maps the pressure over the pads. Raises InvalidValueError for taxels that are none."""
        if self.taxels is None:
            return None
        from ..footprint import Taxels  # nothing that taxels need is loaded without them

        return Taxels(self.taxels, self.worn)

    def face_maps(self, num_envs: int, stack: SensorStack) -> FaceTemperature | None:
        """What maps the temperature over the sensors' faces."""
        if self.face_temperature is None:
            return None
        from ..readout import FaceTemperature  # nothing that it needs is loaded without it

        return FaceTemperature(
            self.face_temperature, num_envs, stack, self.samples * SAMPLE_PERIOD, self.worn
        )

    def _check_face(self) -> None:
        from ..footprint import checked_taxels

        checked_taxels(self.face_temperature, "face_temperature")
        if self.mode == "O":
            raise InvalidValueError(
                "face_temperature in mode 'O': the fingertip's face is its thermostat there, whose temperature is the "
                "observation's thermostat; leave face_temperature out or use mode 'T'"
            )

    @property
    def samples(self) -> int:
        """How many samples of voltage and heat a control step has."""
        return round(self.substeps * self.solver.timestep / SAMPLE_PERIOD)

    @property
    def chain(self) -> SignalChain:
        """The electronics, in the range that the sensor needs. Raises InvalidValueError for a name that is none."""
        if isinstance(self.signal, SignalChain):
            return converter(any_sensor(self.sensor), self.signal)
        if self.signal not in list(SIGNAL_CHAINS):  # which may be of a kind that no dictionary takes
            raise InvalidValueError(f"signal must be one of {sorted(SIGNAL_CHAINS)}, got {self.signal!r}")
        return converter(any_sensor(self.sensor), SIGNAL_CHAINS[self.signal])

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

    def body(
        self, stack: SensorStack, chosen: Material, spec: ObjectSpec, drawn: Mapping[str, float]
    ) -> GraspBody:
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
        changes: dict[str, Any] = {}
        if not spec.parts and spec.mass is None and spec.density is None:
            changes["density"] = chosen.density
        if spec.friction is None and chosen.friction is not None:
            changes["friction"] = chosen.friction
        spec = replace(spec, **changes) if changes else spec
        spec = scaled(
            spec, drawn["size_factor"], mass=drawn["mass_factor"], friction=drawn["friction_factor"]
        )
        if self.mode == "O":
            spec = replace(spec, elements=(stack.width, stack.thickness))
        shift, room = drawn["object_temperature_shift"], self.ambient_temperature
        usual = self.object_temperature + shift
        return GraspBody(
            spec,
            chosen,
            usual if spec.temperature is None else spec.temperature + shift,
            self.mode,
            stack,
            self.fingertips,
            drawn["roughness_factor"],
            usual if room is None else room,
            self._anywhere(spec) and (self.surround is None or self.by_fields),
            self.any_size,
            self.worn,
            self.around,
        )

    def possible_bodies(self, stack: SensorStack) -> list[GraspBody]:
        """A body of every shape and size that may come, so that one too large or too low, or of a material whose
        touches are not known, is refused at once and not in some later episode."""
        if self.mode == "T":
            of_shapes = [
                shape.material for shape in (*self.shapes, *self.others) if shape.material is not None
            ]
            for touched in (*self.choices, *of_shapes):
                Surface.of(material(touched))
        given_temperatures = {shape.temperature for shape in (*self.shapes, *self.others)}
        starts = [self.object_temperature if start is None else start for start in given_temperatures]
        check_drawn_temperatures(self.randomize, starts, self.sensor_temperatures)
        plain, first = draw((), np.random.default_rng(0)), self.choices[0]
        factors = (cause.extremes for cause in self.causes if isinstance(cause, Size))
        sizes = [1.0, *(factor for some in factors for factor in some)]
        bodies = []
        for shape, size in product(self.shapes, sizes):
            try:
                bodies.append(self.body(stack, first, shape, {**plain, "size_factor": size}))
                bodies[-1].check_sensed()
            except InvalidValueError as error:
                if size == 1.0:
                    raise
                raise InvalidValueError(
                    f"object {shape.name!r} cannot be {size:g} times as large, which randomize's Size may draw: "
                    f"narrow its range ({error})"
                ) from error
        return bodies

    def gripper_for(self, bodies: Sequence[GraspBody]) -> GripperModel:
        """The gripper, read. Raises GripperError for what is none, and InvalidValueError for a body that it cannot
        take."""
        if self.gripper is None:
            return SHIPPED_GRIPPER
        gripper = self.gripper
        if not hasattr(gripper, "wrist_at"):  # no GripperModel: a file or a spec
            from ..grippers import load_gripper  # nothing that another gripper needs is loaded without one

            gripper = load_gripper(gripper)
        for body in bodies:
            gripper.wrist_at(body.spec)
        return gripper

    @property
    def most_delay(self) -> int:
        """Samples by which voltages may be late."""
        return max((cause.most for cause in self.causes if isinstance(cause, Delay)), default=0)

    @property
    def causes(self) -> tuple[Cause, ...]:
        """What randomize draws, in its order: sizes by steps where each needs a thermal network to be searched."""
        listed, any_size = checked(self.randomize), self.any_size
        return tuple(
            cause if any_size or not isinstance(cause, Size) else cause.in_steps() for cause in listed
        )

    @cached_property
    def any_size(self) -> bool:
        """Whether sizes are drawn, and each object may have any of them: its network comes from heat kernels."""
        drawn = next((cause for cause in self.randomize if isinstance(cause, Size)), None)
        if drawn is None or self.mode == "O" or self.surround is not None:
            return False
        return all(self._by_kernels(scaled(shape, min(drawn.extremes))) for shape in self.shapes)

    @cached_property
    def by_kernels(self) -> bool:
        """Whether the networks of all objects come from heat kernels."""
        places = self.mode == "T" and all(map(self._anywhere, self.shapes))
        return self.any_size or places and all(map(self._by_kernels, self.shapes))

    def _anywhere(self, spec: ObjectSpec) -> bool:
        """Whether heat knows where it enters that object."""
        if isinstance(self.anywhere, bool):
            return self.anywhere
        plain = spec.shape == "box" and not spec.parts and spec.reservoir is None
        if self.mode == "O" or not plain:
            return False
        body = GraspBody(spec, self.choices[0], self.object_temperature, self.mode, self.stack)
        if body.edge_room < self.placement[0] + _ROOM:
            return True
        drawn = any(isinstance(cause, Size) for cause in self.randomize) and self.surround is None
        return drawn and self._served(spec, anywhere=True) and not self._served(spec, anywhere=False)

    def _by_kernels(self, spec: ObjectSpec) -> bool:
        return self._served(spec, anywhere=self._anywhere(spec))

    def _served(self, spec: ObjectSpec, *, anywhere: bool) -> bool:
        """Whether heat kernels keep the tolerance of that object."""
        from ..sensing import served_anywhere, served_in_the_middle

        difference = self._most_difference(spec)
        if anywhere:
            return served_anywhere(spec, self.tolerance, difference)
        return served_in_the_middle(spec, self.stack, self.tolerance, difference)

    def _most_difference(self, shape: ObjectSpec) -> float:
        """K between a sensor and the object or the air, at most."""
        start = self.object_temperature if shape.temperature is None else shape.temperature
        if self.air == 0:
            return most_difference(self.randomize, self.sensor_temperatures, (start,))
        if self.ambient_temperature is None:
            return most_difference(self.randomize, self.sensor_temperatures, (start, self.room))
        return most_difference(self.randomize, self.sensor_temperatures, (start,), (self.room,))


def check_fields(plant: str, given: Iterable[str], *more: str) -> None:
    """Raises UnknownKeywordError for a name that is neither a field of SimulationConfig nor one of `more`."""
    known = {*more, *(field.name for field in fields(SimulationConfig))}
    for name in given:
        if name not in known:
            raise unknown_keyword(f"plant {plant!r}", name, known)
