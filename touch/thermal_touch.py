"""The sense of heat of anyone's MuJoCo scene.

W: worlds, F: fingertips, O: objects, T = O + F: targets of a contact.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, celsius, non_negative, positive, unknown_name, whole_number

from ..thermal import ADS1115, Material, SignalChain
from ..thermal import material as named_material
from ..thermal.numerics import Array
from ..thermal.readout import chain_numbers
from ..thermal.stack import converter
from .ahead import start_compiling
from .contacts import ContactReader, sensor_places
from .draw import draw_fingertips
from .fixed_touch import FixedTouch, fixed_touch, pad_poses
from .given import (
    checked_record,
    chosen_worlds,
    named_chain,
    require_mapping,
    seeds_of,
    set_temperatures,
)
from .heard import BROKEN, DUE, ELSEWHERE, FULL, NOTHING, SPENT, Hearing, RecordHearing, hear_record, hearer
from .heat import FixedPlaces, HeatBalance, HeatState, JoinedHeat
from .readings import SAMPLES, Electronics, Layout, Noise, TouchReading
from .scene import (
    LONGEST,
    Fingertip,
    Objects,
    PadPlace,
    bodies,
    glued_elements,
    materials_by_world,
    own_shapes,
    pads,
    refuse_overlap,
    refuse_sleep,
    samples_in,
    warn_of_contact_filters,
    warn_of_fixed_bodies,
    warn_of_wide_faces,
    whole_steps,
)
from .watch import PadWatch, PinchWatch

_NOBODY = object()
"""In place of an MjData. None would do for update(None) too."""
_SHOWN_CHARACTERS = 200  # characters of what a message tells
_ON_TIME = 1e-3  # of a step, by which the data's time may be off for each step since the last update


@dataclass(frozen=True, slots=True, eq=False)
class TouchState:
    """What a ThermalTouch remembers, picklable. It holds at `time` (W,) s and no other; started: whether an update or
    a reset has said what time it is. first: (W, O) °C, what a reset begins with. of: whose state it is, by name."""

    time: np.ndarray
    started: bool
    heat: HeatState
    first: np.ndarray
    signal: tuple[np.ndarray, np.ndarray, np.ndarray]
    sums: tuple[np.ndarray, np.ndarray, np.ndarray, int]
    period: tuple[np.ndarray, np.ndarray, int]
    generators: tuple[dict, ...]
    reading: TouchReading
    of: Mapping[str, object]


class ThermalTouch:
    """Fingertips that feel heat in a MuJoCo model of any make; nothing in it is changed.

    fingertips: label -> name of a geom, site or body, or a Fingertip. objects: name of a body or geom -> material or
    ThermalBody, or of many worlds a list of one for each; those that the MJCF describes (<custom><text
    name="thermograsp:NAME" data="aluminium 5.0"/>) need not be named. dt: s between readings, whole steps of the model.
    tolerance: K of temperature drop that the heat models are made for; the pad around a sensor, which changes the drop
    by more, is in them where a Fingertip has a surround (docs/physics.md). ambient: °C, and air: W/(m2 K), of the air
    round the objects. chain: the electronics, a SignalChain or one of thermal.SIGNAL_CHAINS. seed: of their noise,
    until the first reset. worlds: how many, of recorded contact sensors (touch.prepare); None for the one of an MjData.
    World w's noise is that of seed + w.

    Heat is advanced once per sample of the converter, a hundredth of a second or the nearest whole part of dt. What two
    fingertips feel through an object follows its box, or its own shape where it is a closed mesh (BodyShape).
    Raises UnknownNameError for names and InvalidValueError for values that cannot be.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        *,
        fingertips: Mapping[str, str | Fingertip],
        objects: Objects | None = None,
        dt: float = 0.02,
        tolerance: float = 0.05,
        ambient: float = 24.0,
        air: float = 5.0,
        chain: SignalChain | str = ADS1115,
        seed: int | None = None,
        worlds: int | None = None,
    ) -> None:
        if not isinstance(model, mujoco.MjModel):
            raise InvalidValueError(f"model must be a mujoco.MjModel, got {type(model).__name__}")
        for name, value, least in (("worlds", worlds, 1), ("seed", seed, 0)):
            if value is not None:
                whole_number(name, value, least)
        require_mapping("fingertips", fingertips, '{"thumb": "thumb_pad"}')
        require_mapping("objects", objects or {}, '{"can": "aluminium"}')
        self._model, self._step = model, float(model.opt.timestep)
        celsius("ambient (°C)", ambient)
        non_negative("air (W/(m2 K))", air)
        positive("tolerance (K)", tolerance)
        self._substeps = whole_steps(positive("dt (s)", dt), self._step)
        self._samples = samples_in(self._substeps, dt)
        self._sample_steps = self._substeps // self._samples
        self._shapes = bodies(model, objects, ambient)
        self._pads = pads(model, fingertips, self._shapes)
        warn_of_fixed_bodies(model, fingertips, self._pads, self._shapes)
        warn_of_contact_filters(model, self._pads, self._shapes)
        warn_of_wide_faces(model, self._pads)
        refuse_sleep(model, self._pads, self._shapes)
        self._shapes = own_shapes(model, self._shapes, self._pads)
        self._glued = glued_elements(model, self._shapes, ambient)
        self._many, count = worlds is not None, int(worlds or 1)
        start_compiling(recorded=self._many)
        self._materials = [tuple(shape.material for shape in self._shapes)] * count
        self._first = np.tile([shape.temperature for shape in self._shapes], (count, 1))
        self._ambient, self._chain = ambient, named_chain(chain)
        self._identity = {
            "fingertips": self.fingertips,
            "objects": self.objects,
            "elements": self.elements,
            "worlds": worlds,
            "dt": dt,
            "tolerance": tolerance,
            "sensors": tuple(pad.heated or pad.stack for pad in (*self._pads, *self._glued)),
            "thermostats": tuple((pad.temperature, pad.thermostat) for pad in self._pads),
            "surrounds": tuple(pad.surround for pad in self._pads),
            "shapes": tuple("box" if shape.solid is None else "own" for shape in self._shapes),
            "contents": tuple(shape.contents for shape in self._shapes),
            "ambient": ambient,
            "air": air,
            "chain": self._chain,
        }
        self._made_for = self._measures(model)
        self._sensors = sensor_places(model, self._pads, self._shapes) if self._many else None
        self._reader = ContactReader(model, self._pads, self._shapes, count)
        self._heat = JoinedHeat(
            self._pads,
            self._glued,
            self._shapes,
            worlds=count,
            dt=dt / self._samples,
            tolerance=tolerance,
            film=air,
            ambient=ambient,
        )
        sample = dt / self._samples
        chains = [_numbers(self._chain, pad, sample) for pad in (*self._pads, *self._glued)]
        first = np.random.SeedSequence().entropy if seed is None else seed
        heat, reader = self._heat, self._reader
        self._sent = heat.sent.copy() if heat.backed else heat.drop
        names = *self.objects, *self.fingertips, ""
        self._electronics = Electronics(
            np.tile(np.concatenate(chains), count),
            Layout(
                *(len(self._pads), len(chains), len(self._shapes), names, self._many),
                tuple(o for o, shape in enumerate(self._shapes) if shape.contents is not None),
            ),
            Noise([first + w for w in range(count)], len(chains)),  # pyright: ignore[reportOperatorIssue]
            touches=reader.touches,
            beside=reader.beside,
            sent=self._sent,
            drop=heat.drop,
            warmth=heat.warmth,
            inner=heat.inner,
            substeps=self._substeps,
            ambient=ambient,
        )
        self._time, self._started = np.zeros(count), False
        self._taken = np.zeros(1, np.int64)  # samples of the next reading
        self._steps = np.array([self._step, _ON_TIME * self._step])
        self._heard: object = _NOBODY  # the last update's data, which are of this model
        self._fresh = (
            True  # nothing has been updated since the start: whether pads are inside objects is not known
        )
        # the data whose steps one call hears, and what it takes; nobody's until all is known, and after each change
        self._near: object = _NOBODY
        self._hearing: Hearing | None = None
        self._recorded: RecordHearing | None = None
        self._near_at = 0
        self._hear_step: Any = None  # what hears a step of these data
        self._make(range(count), *materials_by_world(objects or {}, self._shapes, count, ambient))
        self._heat.reset(range(count), self._first)
        self._rest(range(count))
        self._watch = PadWatch(self._pads, dt)
        self._pinch = PinchWatch(self._pads, [shape.name for shape in self._shapes], dt)
        self._read(self._time)

    @property
    def fingertips(self) -> tuple[str, ...]:
        """The fingertips' labels, in the order of a reading's rows."""
        return tuple(pad.label for pad in self._pads)

    @property
    def objects(self) -> tuple[str, ...]:
        """The objects' names."""
        return tuple(shape.name for shape in self._shapes)

    @property
    def elements(self) -> tuple[str, ...]:
        """The labels of elements that are glued on objects, "OBJECT:NUMBER", in the order of a reading's rows of
        elements."""
        return tuple(element.label for element in self._glued)

    @property
    def most_voltage(self) -> float:
        """V that no voltage of a reading exceeds, of either sign: 1, or more where a heated sensor's divider is
        supplied with more."""
        heated = (pad.heated for pad in (*self._pads, *self._glued))
        return max(1.0, *(0.0 if sensor is None else sensor.divider.supply for sensor in heated))

    @property
    def model(self) -> mujoco.MjModel:
        """The model that it was made for."""
        return self._model

    @property
    def balance(self) -> HeatBalance | tuple[HeatBalance, ...]:
        """Where heat has gone since the last reset; a tuple of many worlds'."""
        every = tuple(self._heat.balance(w) for w in range(len(self._time)))
        return every if self._many else every[0]

    @property
    def reading(self) -> TouchReading:
        """The last reading."""
        return self._reading

    def update(self, data: mujoco.MjData | np.ndarray) -> TouchReading:
        """To be called after every mj_step: notes its contacts. Returns the reading of the last whole dt.

        data: MjData, or of many worlds the recorded sensordata (W, substeps, sensors) or of one substep (W, sensors).

        Where steps were taken without it, the contacts of the last of them stand for all. The first call counts one
        step alone, unless `reset(data)` was called before the steps that it is to count. Called again at the same time
        it changes nothing. Raises InvalidValueError for data of another model or of an earlier time, and
        SimulationError for forces that are not finite; of many worlds, those `failed` until they are reset."""
        if data is self._near:
            heard = self._hear_step(self._near_at)
            if heard == NOTHING:
                return self._reading
            if heard != ELSEWHERE:
                return self._finish(heard)
        if self._sensors is not None:
            return self._hear(data)
        passed, reader = self._passed(data), self._reader
        while passed > 0:
            room = self._sample_steps - reader.substeps
            taken = min(passed, room)
            reader.read(data, taken)
            passed -= taken
            if taken == room:
                self._sample()
        self._listen()
        return self._reading

    def reset(
        self,
        data: mujoco.MjData | None = None,
        *,
        seed: int | Sequence[int] | None = None,
        temperatures: Mapping[str, float | np.ndarray] | None = None,
        worlds: Sequence[int] | np.ndarray | None = None,
        objects: Objects | None = None,
    ) -> TouchReading:
        """Puts everything at its first temperature, at the data's time (without, at that of the next update). seed: of
        the electronics' noise, one for each world or the first world's; None goes on with it. temperatures: °C of
        objects by name, for this time, one or one for each of these worlds. worlds: which, by number or as (W,)
        booleans; None for all. objects: what some are made of and how warm they start from now on, in these worlds, in
        the constructor's form: one of them or a list of one for each."""
        rows = chosen_worlds(worlds, len(self._time))
        if not self.fits(self._model):
            raise InvalidValueError(
                "the model's geoms have other sizes or places than when this ThermalTouch was made: make another one"
            )
        if data is not None:
            if self._many:
                raise InvalidValueError("many worlds have no MjData: reset(worlds=...)")
            if not isinstance(data, mujoco.MjData):
                raise InvalidValueError(f"reset takes the simulation's MjData, got {type(data).__name__}")
            self._check(data)
        require_mapping("temperatures", temperatures or {}, '{"can": 60.0}')
        require_mapping("objects", objects or {}, '{"can": "aluminium"}')
        names = self.objects
        made_of, warm = materials_by_world(objects or {}, self._shapes, len(rows), self._ambient)
        first = self._first[rows]
        for name, warmth in warm.items():
            first[:, names.index(name)] = warmth
        set_temperatures(first, temperatures or {}, names)
        if seed is not None:
            for w, number in zip(rows, seeds_of(seed, rows), strict=True):
                self._electronics.noise.seed(w, number)
        # a grasp that simply goes on has been heard since before it sank in
        goes_on = data is not None and data is self._heard and data.time == self._time.item()
        self._fresh, self._near = self._fresh or not goes_on, _NOBODY
        self._make(rows, made_of, warm)
        self._heat.reset(rows, first)
        reader = self._reader
        reader.touches[rows], reader.beside[rows], reader.broken[rows] = 0.0, 0.0, False
        if len(rows) == len(self._time):
            reader.clear()
            self._taken[0] = 0
        self._time[rows] = 0.0 if data is None else float(data.time)
        if not self._many:
            self._started = data is not None
        self._rest(rows)
        self._read(self._time)
        return self._reading

    def fixed_places(self, like: Array, *, world: int = 0) -> FixedPlaces:
        """Returns the fingertips on the places where they have touched so far, as they are now, for a pure step of
        arrays: `advance(state, conductance)`, once per sample of the converter; contacts there are of the sensor's
        whole face. like: an array of floating-point numbers whose kind (NumPy, PyTorch, JAX), dtype and device are
        taken. Raises InvalidValueError where nothing has been touched, and beside thermostats of finite power, heated
        sensors and glued elements."""
        (row,) = chosen_worlds([world], len(self._time))
        return self._heat.fixed_places(row, like)

    def fixed_touch(
        self,
        like: Array,
        *,
        materials: Mapping[str, str | Material | Sequence[str | Material]] | None = None,
        world: int = 0,
        data: mujoco.MjData | None = None,
    ) -> FixedTouch:
        """Returns the fingertips on every object, each on one place of it, for a pure step of arrays that takes
        contacts: `advance(state, contacts)`, once per sample of the converter. A place is where the fingertip has
        touched the object, or else where the pad would, in the pose of `data` or the model's first. Contacts of
        fingertips with one another are left aside.

        like: an array of floating-point numbers whose kind (NumPy, PyTorch, JAX), dtype and device are taken.
        materials: by object, those that it may be of; without, those that it is of in the worlds. A ThermalTouch of
        many worlds in which nothing has touched starts all of them, at their first temperatures; otherwise world
        `world` is what starts, as it is now. Raises UnknownNameError, and InvalidValueError beside thermostats of
        finite power, heated sensors and glued elements."""
        (row,) = chosen_worlds([world], len(self._time))
        given = {
            name: (choices,) if isinstance(choices, str | Material) else choices
            for name, choices in (materials or {}).items()
        }
        of = {name: tuple(map(named_material, choices)) for name, choices in given.items()}
        for name in of:
            if name not in self.objects:
                raise unknown_name("object", name, self.objects)
        every = [
            tuple(dict.fromkeys((*of.get(name, ()), *(choices[o] for choices in self._materials))))
            for o, name in enumerate(self.objects)
        ]
        most = max(map(len, every))
        kinds = [
            tuple(
                shape.of(choices[min(v, len(choices) - 1)])
                for shape, choices in zip(self._shapes, every, strict=True)
            )
            for v in range(most)
        ]
        fresh = not self._heat.touched
        rows = range(len(self._time)) if fresh else [row]
        numbers = [
            [choices.index(m) for choices, m in zip(every, self._materials[w], strict=True)] for w in rows
        ]
        places = None
        if hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
            with suppress(InvalidValueError):  # a model that touch.prepare has not made
                places = sensor_places(self._model, self._pads, self._shapes)
        tips, electronics = len(self._pads), self._electronics
        sensors = slice(row * electronics.voltage.shape[1], None)
        now = (
            None
            if fresh
            else (
                electronics.filtered[sensors][:tips, 0],
                electronics.last[sensors][:tips, 0],
                electronics.voltage[row, :tips],
            )
        )
        return fixed_touch(
            self._model,
            self._pads,
            self._shapes,
            kinds,
            every,
            self._heat.fixed_networks(
                row, every, pad_poses(self._model, data, self._pads, self._shapes)[None]
            ),
            substeps=self._sample_steps,
            ambient=self._ambient,
            chain=self._chain,
            places=places,
            worlds=(np.array(numbers), self._first[list(rows)]),
            now=now,
            samples=SAMPLES,
            like=like,
        )

    def draw(self, scene: mujoco.MjvScene, data: mujoco.MjData, *, world: int = 0) -> int:
        """Adds what each fingertip feels to a scene of MuJoCo's viewer (viewer.user_scn) or Renderer (renderer.scene):
        a plate on its pad, blue where it loses heat and red where it gains, and a bar of its voltage. To be called
        after the scene was updated. Returns how many geoms were added."""
        self._check(data)
        reading = self._reading
        drops, volts = reading.temperature_drop, reading.voltage[..., -1]
        if self._many:
            drops, volts = drops[world], volts[world]
        return draw_fingertips(scene, data, self._pads, drops, volts)

    def state(self) -> TouchState:
        """Returns a copy of the whole state, to go with a saved state of the simulation."""
        reader, electronics = self._reader, self._electronics
        return TouchState(
            self._time.copy(),
            self._started,
            self._heat.state(),
            self._first.copy(),
            (electronics.filtered.copy(), electronics.last.copy(), electronics.voltage.copy()),
            (reader.touches.copy(), reader.beside.copy(), reader.broken.copy(), reader.substeps),
            (electronics.pressed.copy(), electronics.off.copy(), int(self._taken[0])),
            tuple(electronics.noise.state(w) for w in range(len(self._time))),
            self._reading,
            dict(self._identity),
        )

    def set_state(self, state: TouchState) -> None:
        """Goes on from a state taken by `state` of a ThermalTouch made alike. Raises InvalidValueError for others."""
        reader, electronics = self._reader, self._electronics
        if not isinstance(state, TouchState):
            raise InvalidValueError(f"set_state takes what state() returned, got {type(state).__name__}")
        for name, expected in self._identity.items():
            if (saved := state.of.get(name)) != expected:
                difference = f"{saved!r} in place of {expected!r}"
                differ = (
                    f"are {difference}" if len(difference) < _SHOWN_CHARACTERS else "differ"
                )  # a sensor's layers would fill a page
                raise InvalidValueError(
                    f"the state is of another ThermalTouch, whose {name} {differ}: make this one alike"
                )
        self._near = _NOBODY
        self._time[:], self._started, self._reading = state.time, state.started, state.reading
        self._heat.set_state(state.heat)
        self._materials, self._first[:] = list(state.heat.materials), state.first
        self._reader.set_materials(range(len(self._time)), self._materials)
        reader.touches[:], reader.beside[:], reader.broken[:], reader.substeps = state.sums
        electronics.filtered[:], electronics.last[:], electronics.voltage[:] = state.signal
        electronics.pressed[:], electronics.off[:], self._taken[0] = state.period
        for w, saved in enumerate(state.generators):
            electronics.noise.set_state(w, saved)

    def _make(
        self, rows: Sequence[int], materials: dict[str, list[Material]], temperatures: dict[str, np.ndarray]
    ) -> None:
        """What objects of those worlds are made of, and how warm they start, (rows,) °C, from the next reset on."""
        if not materials:
            return
        names = self.objects
        for name, value in temperatures.items():
            self._first[rows, names.index(name)] = value
        for i, w in enumerate(rows):
            self._materials[w] = tuple(
                materials[name][i] if name in materials else known
                for name, known in zip(names, self._materials[w], strict=True)
            )
        chosen = [self._materials[w] for w in rows]
        self._heat.set_materials(rows, chosen)
        self._reader.set_materials(rows, chosen)

    def _rest(self, rows: Sequence[int]) -> None:
        """Those worlds' electronics as if at rest for as long as a reading reaches back."""
        for w in rows:
            self._electronics.rest(
                w, self._heat.sent[w]
            )  # nothing, or what a divider sends of a sensor at rest
        self._electronics.start_anew(rows)

    def _hear(self, record: mujoco.MjData | np.ndarray) -> TouchReading:
        assert self._sensors is not None
        found, done = checked_record(record, len(self._time), self._sensors.size), 0
        at, count, reader = found.ctypes.data, found.shape[1], self._reader
        while done < count:
            sensing = reader.sensing(self._sensors, count)
            recorded = self._recorded
            if recorded is None or self._near is not self._sensors:
                self._recorded = recorded = self._record_hearing(sensing)
                self._near = self._sensors
            heard = hear_record(recorded.address, at, done, count)
            done = recorded.heard
            if heard != NOTHING:
                self._finish(heard)
        return self._reading

    def _record_hearing(self, sensing: int) -> RecordHearing:
        """For records, until something else than `hear_record` changes what is heard."""
        reader = self._reader
        return RecordHearing(
            (self._time, self._steps, reader.counted, self._taken),
            (sensing, *self._heat.hearing(reader.touches), self._electronics.address),
            (self._sample_steps, self._samples),
        )

    def _passed(self, data: mujoco.MjData | np.ndarray) -> int:
        """Substeps since the last call."""
        if data is not self._heard:
            if not isinstance(data, mujoco.MjData):
                raise InvalidValueError(
                    f"update takes the simulation's MjData, got {type(data).__name__}; for recorded sensordata say how "
                    "many worlds: ThermalTouch(..., worlds=n)"
                )
            self._check(data)
            self._heard = data
        now = data.time
        if not np.isfinite(now):
            raise InvalidValueError(f"the data's time is {now}: the simulation broke down; reset both")
        if self._fresh and data.xmat[-1].any():  # zeros where nothing has been computed yet
            refuse_overlap(self._model, data, self._pads, self._shapes)
            self._fresh = False
        if not self._started:
            self._time[0], self._started = now - self._step, True
        elapsed = (now - self._time.item()) / self._step
        passed = round(elapsed)
        if passed < 0 or abs(elapsed - passed) > _ON_TIME * max(passed, 1):
            if self._model.opt.timestep != self._step:
                raise InvalidValueError(
                    f"the model's timestep is {self._model.opt.timestep:g} s, and was {self._step:g} s when this "
                    "ThermalTouch was made: make another one"
                )
            raise InvalidValueError(
                f"the data are at {now:g} s, the last update was at {self._time[0]:g} s, steps of {self._step:g} s: "
                "call touch.reset(data) after the simulation was reset, or touch.set_state for a saved one"
            )
        if passed * self._step > LONGEST:
            raise InvalidValueError(
                f"the data are at {now:g} s, the last update was at {self._time[0]:g} s, more than {LONGEST:g} s ago: "
                "call touch.reset(data), or update more often"
            )
        self._time[0] = now
        return passed

    def _check(self, data: mujoco.MjData) -> None:
        model = getattr(data, "model", self._model)
        if model is not self._model and self._measures(model) != self._measures(self._model):
            raise InvalidValueError(
                "the data belong to another model than this ThermalTouch: make one for theirs, "
                "thermograsp.ThermalTouch(data.model, ...)"
            )

    def fits(self, model: mujoco.MjModel) -> bool:
        """Whether fingertips and objects of a model, in which numbers may have been changed, are still as large and
        where they were when this was made."""
        return self._measures(model) == self._made_for

    def _measures(self, model: mujoco.MjModel) -> tuple[object, ...]:
        """By which a copy of a model is known from another one, where fingertips and objects are not alike;
        `MjModel.signature` came after MuJoCo 3.3.0."""
        counts = model.nq, model.nv, model.nu, model.na, model.nbody, model.ngeom
        if model.ngeom != self._model.ngeom:
            return counts
        used = [geom for each in (*self._pads, *self._shapes) for geom in each.touched]
        geoms = model.geom_type, model.geom_size, model.geom_pos, model.geom_quat
        return model.names, counts, *(each[used].tobytes() for each in geoms)

    def _sample(self) -> None:
        """A whole sample has passed: heat, then the converter."""
        reader, heat = self._reader, self._heat
        self._near = _NOBODY  # heat may have made its arrays anew
        heat.advance(reader.touches, reader.substeps)
        reader.substeps = 0
        if heat.backed:
            self._sent[:] = heat.sent
        self._taken += 1
        due = bool(self._taken[0] == self._samples)
        self._electronics.sample(due)
        if due:
            self._taken[0] = 0
            self._read(self._time)

    def _listen(self) -> None:
        """From now on one call hears a step of the last update's data, where MuJoCo's bindings say where they are."""
        data, reader, electronics = self._heard, self._reader, self._electronics
        if not isinstance(data, mujoco.MjData) or self._fresh or data is self._near:
            return
        self._near = _NOBODY
        memory = reader.memory(data)
        if memory.clock is None:
            return
        self._hearing = Hearing(
            (self._time, self._steps, reader.counted, self._taken),
            (
                *(*memory.clock, memory.address, reader.address),
                *(*self._heat.hearing(reader.touches), electronics.address),
            ),
            (self._sample_steps, self._samples),
        )
        self._near, self._near_at, self._hear_step = data, self._hearing.address, hearer()

    def hearing(self, data: mujoco.MjData) -> int:
        """The address of what `hear` takes of a step of these data, until anything else is called; 0 where a step is
        more than that. For `heard`."""
        return self._near_at if data is self._near else 0

    def heard(self, data: mujoco.MjData, found: int) -> int:
        """What is left to do after a step of which `hear` has returned `found`, or, where `hearing` was 0, ELSEWHERE:
        `update` in two parts, for who takes the first in compiled code. Returns the `hearing` of the next step."""
        if found == ELSEWHERE:
            self.update(data)
        else:
            self._finish(found)
        return self.hearing(data)

    def due(self, time: float) -> None:
        """Makes the reading that was due at that time s, the last one so far, where `hear` has returned DUE. Behind the
        last of several steps once does for all of them."""
        self._read(np.array([time]))

    def _finish(self, heard: int) -> TouchReading:
        """What is left to do where `hear` found something to do."""
        if heard == BROKEN:
            raise self._reader.failure(float(self._time[0]))
        if heard == FULL:
            self._sample()
            self._listen()
            return self._reading
        if heard & SPENT:
            self._electronics.noise.refill()
        if heard & DUE:
            self._read(self._time)
        return self._reading

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_hear_step": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """A copy, whose arrays are elsewhere."""
        self.__dict__.update(state)
        self._near, self._hearing, self._recorded = _NOBODY, None, None

    def _read(self, time: np.ndarray) -> None:
        self._reading = self._electronics.reading(time, self._reader.broken)
        self._watch.see(self._reading)
        self._pinch.see(self._heat)


def _numbers(chain: SignalChain, pad: PadPlace, sample: float) -> np.ndarray:
    """Of the chain as it takes the pad's sensor: a drop in K, or the voltage of a divider as it is."""
    if pad.heated is None:
        return chain_numbers(chain, pad.stack.seebeck, sample)
    return chain_numbers(converter(pad.heated, chain), 1.0, sample)
