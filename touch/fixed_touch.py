"""The sense of heat of many worlds as a pure step of arrays: NumPy, PyTorch, JAX.

What `ThermalTouch.update` does with recorded contact sensors, for fingertips that touch each object at one place.

B: worlds, F: fingertips, O: objects, N = F O: pairs, G: geoms of the objects, H: substeps, L: forces of a pair, K:
states of all fields, R: states of a narrow contact.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, whole_number

from ..thermal import ArrayTables, Material, SignalChain, SignalState, array_step, measure_sample
from ..thermal.numerics import Array, as_integers, as_like, namespace_of
from .contacts import (
    FORCE_AT,
    PLACE_AT,
    ArrayContacts,
    SensorPlaces,
    TouchContacts,
    array_contacts,
)
from .heat import ArrayNarrow, FixedNetworks, JoinedHeat, array_narrow, network_tables
from .scene import BodyShape, PadPlace

MOST_NETWORKS = 4096
"""Of combinations of materials and ways to grasp objects that grasp_touch makes tables of."""
_SAME = 1e-9  # of a box's sides, by which they may differ and count as equal


class FixedTouchState(NamedTuple):
    """The state of heat and electronics in every world. heat: (B, K) of all fields. narrow: (B, N, R). signal: of the
    electronics, (B, F) each, and voltage: (B, F, samples) V as reported, oldest first. material: (B, O) integers, and
    first: (B, O) °C of the objects at a reset."""

    heat: Array
    narrow: Array
    signal: SignalState
    voltage: Array
    material: Array
    first: Array


class FixedTouchReading(NamedTuple):
    """After a step. voltage: (B, F, samples) V as the driver reports it, oldest first. temperature_drop: (B, F) K over
    the sensed layer. force (B, F) N normal on the pads, beside (B, F) N on the fingertips off their pads, and
    conductance (B, F, O) W/K: means over the step. touching: (B, F) number of the object that presses most, -1 for
    none. object_temperature: (B, O) °C, the objects' means. Of a world with a number that is not finite, these are not
    numbers until it is reset."""

    voltage: Array
    temperature_drop: Array
    force: Array
    beside: Array
    conductance: Array
    touching: Array
    object_temperature: Array


class RecordPlaces(NamedTuple):
    """Where sensordata holds the contacts. force, place: (F, G, L, 3) integers; whole: (F, G, L, 1), 0 where there is
    no sensor. bodies: (bodies, 7) integers of positions and quaternions; tip: (F,), geom: (G,) which of the bodies.
    offset: (G, 3) m and turn: (G, 3, 3) of the geoms in their bodies. size: of sensordata."""

    force: Array
    place: Array
    whole: Array
    bodies: Array
    tip: Array
    geom: Array
    offset: Array
    turn: Array
    size: int


@dataclass(frozen=True, slots=True, eq=False)
class FixedTouch:
    """Fingertips on fixed places of objects, in steps of dt s that are so many substeps of the simulation; made by
    ThermalTouch.fixed_touch. Methods are pure: they can be traced, compiled and vectorised.

    fingertips, objects: names. materials: those that each object may be of; a world's number counts along them.
    bodies (F,) that carry the pads and geoms (G,) of the objects, integers: their numbers in the model. origin: the
    states of the ThermalTouch's worlds, or of one of them. ambient: °C. states_of: (O, K), 1 at the states of each
    object, and mean: (O, K), 1 at the one of its mean temperature. first_kind: (N,) integers, the narrow contacts of
    the first materials."""

    dt: float
    substeps: int
    fingertips: tuple[str, ...]
    objects: tuple[str, ...]
    materials: tuple[tuple[Material, ...], ...]
    bodies: Array
    geoms: Array
    ambient: float
    chain: SignalChain
    origin: FixedTouchState
    seebeck: Array
    difference: Array
    tables: ArrayTables
    narrow: ArrayNarrow
    first_kind: Array
    held: Array
    mean: Array
    states_of: Array
    owner: Array
    of_object: Array
    reads: ArrayContacts
    record: RecordPlaces | None

    def start(self, worlds: int | None = None) -> FixedTouchState:
        """The ThermalTouch's worlds as they were, or so many copies of its one world. Raises InvalidValueError for
        another number of worlds than the ThermalTouch has."""
        rows = self.origin.heat.shape[0]
        count = rows if worlds is None else whole_number("worlds", worlds, 1)
        if rows not in (1, count):
            raise InvalidValueError(f"worlds must be {rows}, as many as the ThermalTouch has, got {worlds}")
        if rows == count:
            return self.origin
        every = as_integers(as_like(np.zeros(count), self.origin.heat))
        heat, narrow, signal, voltage, material, first = self.origin
        filtered, last = (each[every] for each in signal)
        return FixedTouchState(
            heat[every],
            narrow[every],
            SignalState(filtered, last),
            voltage[every],
            material[every],
            first[every],
        )

    def reset(
        self,
        state: FixedTouchState,
        worlds: Array | None = None,
        *,
        material: Array | None = None,
        temperature: Array | None = None,
    ) -> FixedTouchState:
        """The state with those worlds (B,) bool, None for all, at their first temperatures and the electronics at
        rest. material: (B, O) integers, what their objects are of from now on, and temperature: (B, O) °C, as which
        they begin; None leaves what they were. Raises InvalidValueError for other shapes; numbers are looked into
        where they are NumPy's."""
        xp, count = namespace_of(state.heat), state.heat.shape[0]
        made_of = state.material if material is None else self._material(material, state)
        first = state.first if temperature is None else self._first(temperature, state)
        excess = first - self.ambient
        held = [self.held[o][made_of[:, o]] for o in range(len(self.objects))]
        heat = sum((excess[:, o] * each)[:, None] * self.mean[o] for o, each in enumerate(held))
        none = 0.0 * self.seebeck + as_like(np.zeros((count, 1)), state.heat)
        resting = SignalState(none, none)
        _, volts = measure_sample(self.chain, resting, none, self.seebeck, self.dt)
        voltage = volts[..., None] + as_like(np.zeros(state.voltage.shape), state.heat)
        fresh = (heat, as_like(np.zeros(state.narrow.shape), state.heat), none, none, voltage, made_of, first)
        before = (state.heat, state.narrow, *state.signal, state.voltage, state.material, state.first)
        if worlds is not None:
            chosen = self._mask(worlds, state)
            fresh = tuple(
                xp.where(chosen[(slice(None),) + (None,) * (new.ndim - 1)], new, old)
                for new, old in zip(fresh, before, strict=True)
            )
        heat, narrow, filtered, last, voltage, made_of, first = fresh
        return FixedTouchState(heat, narrow, SignalState(filtered, last), voltage, made_of, first)

    def contacts(self, record: Array) -> TouchContacts:
        """The contacts of recorded sensordata (B, H, sensordata), or (B, sensordata) of one substep, of a model that
        touch.prepare has made. Raises InvalidValueError for another model or shape."""
        places = self.record
        if places is None:
            raise InvalidValueError(
                "this model has no contact sensors for its fingertips and objects: make it by "
                "thermograsp.touch.prepare(spec, fingertips, objects), or fill a TouchContacts"
            )
        if getattr(record, "ndim", 0) not in (2, 3) or record.shape[-1] != places.size:
            found = tuple(record.shape) if hasattr(record, "shape") else type(record).__name__
            raise InvalidValueError(
                f"a record must have the shape (worlds, substeps, {places.size}), got {found}"
            )
        if record.ndim == 2:
            record = record[:, None]
        xp = namespace_of(record)
        poses = record[..., places.bodies]  # (B, H, bodies, 7)
        a, b, c, d = (poses[..., 3 + k] for k in range(4))
        rows = (
            (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
            (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
            (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
        )
        turn = xp.stack([xp.stack(row, -1) for row in rows], -2)
        position = poses[..., :3]
        of_geom = turn[:, :, places.geom]
        return TouchContacts(
            record[..., places.force] * places.whole,
            record[..., places.place] * places.whole,
            position[:, :, places.tip],
            turn[:, :, places.tip],
            position[:, :, places.geom] + (of_geom * places.offset[:, None, :]).sum(-1),
            (of_geom[..., :, :, None] * places.turn[:, None, :, :]).sum(-2),
        )

    def posed(
        self, force: Array, place: Array, xpos: Array, xmat: Array, geom_xpos: Array, geom_xmat: Array
    ) -> TouchContacts:
        """Forces and places as in TouchContacts, in the poses that MuJoCo's data have of all bodies and geoms: (B, H,
        bodies, ...) and (B, H, geoms, ...)."""
        tips, tip_turns = xpos[:, :, self.bodies], xmat[:, :, self.bodies]
        geoms, geom_turns = geom_xpos[:, :, self.geoms], geom_xmat[:, :, self.geoms]
        return TouchContacts(
            force,
            place,
            tips,
            tip_turns.reshape((*tips.shape, 3)),
            geoms,
            geom_turns.reshape((*geoms.shape, 3)),
        )

    def advance(
        self, state: FixedTouchState, contacts: TouchContacts, noise: Array | float = 0.0
    ) -> tuple[FixedTouchState, FixedTouchReading]:
        """State and reading dt later. noise: (B, F) standard normal numbers; 0 for electronics without noise. Raises
        InvalidValueError for contacts of another shape."""
        self._check(state, contacts)
        xp = namespace_of(state.heat)
        expected, given = tuple(state.signal.last.shape), tuple(getattr(noise, "shape", ()))
        if given not in ((), expected):
            raise InvalidValueError(f"noise must be a number or have the shape {expected}, got {given}")
        material, worlds = state.material, state.heat.shape[0]
        found = self.reads.of_step(contacts, material[:, self.owner], self.of_object)
        pairs = (worlds, len(self.fingertips) * len(self.objects))
        conducts, area, length = (
            each.reshape(pairs) for each in (found.conductance, found.area, found.length)
        )
        shares = found.shares.reshape((*pairs, 4))
        network, kind = self._numbers(material)
        roots, behind, lag = self.narrow.behind(state.narrow, kind, area, length, shares)
        touching = conducts > 0
        joined = xp.where(
            touching, 1 / (1 / xp.where(touching, conducts, 1.0 + 0.0 * conducts) + lag), conducts
        )
        heat, heard = array_step(self.tables, network, state.heat, joined, self.difference - behind)
        drop = heard.drop[:, :: len(self.objects)]
        signal, volts = measure_sample(self.chain, state.signal, drop, self.seebeck, self.dt, noise)
        voltage = xp.concatenate((state.voltage[..., 1:], volts[..., None]), -1)
        after = FixedTouchState(
            heat, self.narrow.after(state.narrow, roots, heard.flow), signal, voltage, material, state.first
        )
        held = xp.stack([self.held[o][material[:, o]] for o in range(len(self.objects))], -1)
        most = found.force.argmax(-1)
        reading = FixedTouchReading(
            voltage,
            drop,
            found.force.sum(-1),
            found.beside,
            found.conductance,
            xp.where((found.force > 0).any(-1), most, 0 * most - 1),
            self.ambient + (heat[:, None] * self.mean).sum(-1) / held,
        )
        return after, reading

    def _numbers(self, material: Array) -> tuple[Array | int, Array]:
        """The networks (B,) and the narrow contacts' kinds (B, N) of worlds with those materials."""
        network = 0
        for o, choices in enumerate(self.materials):
            network = network * len(choices) + material[:, o]
        pairs = namespace_of(material).concatenate([material] * len(self.fingertips), -1)
        return (network if len(self.tables.decay) > 1 else 0), pairs + self.first_kind

    def _check(self, state: FixedTouchState, contacts: TouchContacts) -> None:
        if not isinstance(state, FixedTouchState):
            raise InvalidValueError(
                f"advance takes a FixedTouchState, got {type(state).__name__}: begin with the one of start()"
            )
        if not isinstance(contacts, TouchContacts):
            raise InvalidValueError(
                f"advance takes TouchContacts, got {type(contacts).__name__}: for recorded sensordata "
                "advance(state, fixed.contacts(record))"
            )
        worlds, tips, geoms = state.heat.shape[0], len(self.fingertips), self.geoms.shape[0]
        expected = {
            "force": (worlds, self.substeps, tips, geoms, "L", 3),
            "place": (worlds, self.substeps, tips, geoms, "L", 3),
            "tip_position": (worlds, self.substeps, tips, 3),
            "tip_turn": (worlds, self.substeps, tips, 3, 3),
            "geom_position": (worlds, self.substeps, geoms, 3),
            "geom_turn": (worlds, self.substeps, geoms, 3, 3),
        }
        forces = contacts.force.shape[4] if len(contacts.force.shape) == 6 else 0
        for name, shape in expected.items():
            found = tuple(getattr(contacts, name).shape)
            if found != tuple(forces if side == "L" else side for side in shape) or not forces:
                raise InvalidValueError(
                    f"contacts: {name} must have the shape {shape} (worlds, substeps of a step of {self.dt:g} s, ...), "
                    f"got {found}"
                )

    def _material(self, material: Array, state: FixedTouchState) -> Array:
        shape = tuple(state.material.shape)
        material = material if hasattr(material, "dtype") else np.asarray(material)
        if tuple(np.shape(material)) != shape:
            raise InvalidValueError(f"material must have the shape {shape}, got {tuple(np.shape(material))}")
        if isinstance(material, np.ndarray):  # tensors are not looked into
            counts = np.array([len(choices) for choices in self.materials])
            if material.dtype.kind not in "iu" or not ((material >= 0) & (material < counts)).all():
                raise InvalidValueError(
                    f"material must be whole numbers, of {dict(zip(self.objects, counts.tolist(), strict=True))} "
                    f"materials from 0 on, got {material if material.size < 20 else material.dtype}"
                )
            return as_integers(as_like(material, state.heat))
        return as_integers(material)

    def _first(self, temperature: Array, state: FixedTouchState) -> Array:
        temperature = temperature if hasattr(temperature, "dtype") else np.asarray(temperature)
        if tuple(np.shape(temperature)) != tuple(state.first.shape):
            raise InvalidValueError(
                f"temperature must have the shape {tuple(state.first.shape)} °C, got {tuple(np.shape(temperature))}"
            )
        if isinstance(temperature, np.ndarray):
            if not (np.isfinite(temperature) & (temperature > -273.15)).all():
                raise InvalidValueError(f"temperature must be finite °C above -273.15, got {temperature}")
            return as_like(temperature, state.heat)
        return temperature

    def _mask(self, worlds: Array, state: FixedTouchState) -> Array:
        count = state.heat.shape[0]
        worlds = worlds if hasattr(worlds, "dtype") else np.asarray(worlds)
        if tuple(np.shape(worlds)) != (count,) or "bool" not in str(getattr(worlds, "dtype", "")):
            raise InvalidValueError(
                f"worlds must be ({count},) booleans, got {getattr(worlds, 'dtype', type(worlds).__name__)} of shape "
                f"{tuple(np.shape(worlds))}"
            )
        return as_like(worlds, state.heat) > 0 if isinstance(worlds, np.ndarray) else worlds


def fixed_touch(
    model: mujoco.MjModel,
    pads: Sequence[PadPlace],
    shapes: Sequence[BodyShape],
    kinds: Sequence[Sequence[BodyShape]],
    materials: Sequence[Sequence[Material]],
    networks: FixedNetworks,
    *,
    substeps: int,
    ambient: float,
    chain: SignalChain,
    places: SensorPlaces | None,
    worlds: tuple[np.ndarray, np.ndarray],
    now: tuple[np.ndarray, np.ndarray, np.ndarray] | None,
    samples: int,
    like: Array,
) -> FixedTouch:
    """kinds: the objects once for each number of a material. worlds: (W, O) numbers of their materials, and °C at
    first. now: the electronics (F,), (F,) and voltages (F, samples) of the one world whose heat is as in `networks`;
    None for worlds at their first temperatures."""
    tips = tuple(pad.label for pad in pads)
    objects = tuple(shape.name for shape in shapes)
    of = [(o, geom) for o, shape in enumerate(shapes) for geom in shape.geoms]
    begin, at = networks.begin, np.arange(len(networks.state))
    mean = (at == begin[:-1, None]).astype(float)
    states_of = ((at >= begin[:-1, None]) & (at < begin[1:, None])).astype(float)

    def array(values: np.ndarray | Sequence[float]) -> Array:
        return as_like(np.asarray(values, float), like)

    def integers(values: np.ndarray | Sequence[int]) -> Array:
        return as_integers(array(values))

    count = len(worlds[0])
    nothing = np.zeros((count, len(tips)))
    origin = FixedTouchState(
        array(np.tile(networks.state, (count, 1))),
        array(np.tile(networks.narrow_state, (count, 1, 1))),
        SignalState(array(nothing), array(nothing)),
        array(np.zeros((count, len(tips), samples))),
        integers(worlds[0]),
        array(worlds[1]),
    )
    made = FixedTouch(
        networks.dt,
        substeps,
        tips,
        objects,
        tuple(map(tuple, materials)),
        integers([pad.body for pad in pads]),
        integers([geom for _, geom in of]),
        ambient,
        chain,
        origin,
        array([pad.stack.seebeck for pad in pads]),
        array(networks.difference),
        network_tables(networks.rates, networks.ports, networks.drop, networks.dt, like),
        array_narrow(
            networks.narrow, networks.narrow_number, networks.width, networks.decay, networks.dt, like
        ),
        integers(np.arange(len(tips) * len(objects)) * max(map(len, materials))),
        array(networks.held),
        array(mean),
        array(states_of),
        integers([o for o, _ in of]),
        array(np.eye(len(objects))[[o for o, _ in of]]),
        array_contacts(model, pads, kinds, like),
        None if places is None else _record(places, pads, len(of), like),
    )
    if now is None:
        return replace(made, origin=made.reset(origin))
    filtered, last, voltage = (array(each[None]) for each in now)
    return replace(made, origin=origin._replace(signal=SignalState(filtered, last), voltage=voltage))


def grasp_touch(
    model: mujoco.MjModel,
    pads: Sequence[PadPlace],
    shapes: Sequence[BodyShape],
    materials: Sequence[Sequence[Material]],
    *,
    dt: float,
    substeps: int,
    tolerance: float,
    ambient: float,
    air: float,
    chain: SignalChain,
    samples: int,
    like: Array,
) -> tuple[FixedTouch, int]:
    """Fingertips that touch every object in the middles of two opposite faces of its box, those that look alike in the
    model's first pose on the same one; and in how many ways. There are three, across the box's sides, or one where
    all objects are cubes. An object that has its own shape is touched where that is nearest to those middles.
    materials: of each object. A world's number is that of its material times the ways, plus the way. One sample each
    dt s of so many substeps. Raises InvalidValueError beside thermostats of finite power, heated sensors and glued
    elements, and for more combinations than MOST_NETWORKS."""
    cubes = all(shape.solid is None and np.ptp(shape.size) <= _SAME * shape.size.max() for shape in shapes)
    ways = 1 if cubes else 3
    combinations = math.prod(len(choices) * ways for choices in materials)
    if combinations > MOST_NETWORKS:
        raise InvalidValueError(
            f"objects: their materials and the sides that they may be grasped across combine in {combinations} ways, "
            f"more than {MOST_NETWORKS}: name fewer objects, or fewer materials of each"
        )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    looks = np.array([data.xmat[pad.body].reshape(3, 3) @ pad.axes[:, 0] for pad in pads])
    side = np.where(looks @ looks[0] < 0, -1.0, 1.0)
    poses = np.zeros((ways, len(pads), len(shapes), 6))
    for o, shape in enumerate(shapes):
        inward = side[:, None] * shape.axes.T[:ways, None]
        poses[:, :, o, :3] = shape.centre - inward * shape.size[:ways, None, None] / 2
        poses[:, :, o, 3:] = inward
    first = [shape.of(choices[0]) for shape, choices in zip(shapes, materials, strict=True)]
    heat = JoinedHeat(pads, (), first, worlds=1, dt=dt, tolerance=tolerance, film=air, ambient=ambient)
    most = max(map(len, materials))
    kinds = [
        tuple(
            shape.of(choices[min(v, len(choices) - 1)])
            for shape, choices in zip(shapes, materials, strict=True)
        )
        for v in range(most)
        for _ in range(ways)
    ]
    fixed = fixed_touch(
        model,
        pads,
        shapes,
        kinds,
        [[one for one in choices for _ in range(ways)] for choices in materials],
        heat.fixed_networks(0, materials, poses),
        substeps=substeps,
        ambient=ambient,
        chain=chain,
        places=None,
        worlds=(np.zeros((1, len(shapes)), int), np.full((1, len(shapes)), ambient)),
        now=None,
        samples=samples,
        like=like,
    )
    return fixed, ways


def _record(places: SensorPlaces, pads: Sequence[PadPlace], geoms: int, like: Array) -> RecordPlaces:
    tips = len(pads)
    of_objects = [(f, g, at) for f, g, at in places.pairs.tolist() if g < geoms]
    most = max(len(pad.geoms) for pad in pads)
    address, count = np.full((tips, geoms, most), -1), np.zeros((tips, geoms), int)
    for f, g, at in of_objects:
        address[f, g, count[f, g]] = at
        count[f, g] += 1
    sides = np.maximum(address, 0)[..., None] + np.arange(3)
    bodies = places.poses[:, 0].tolist()
    rows = places.poses[:, [1, 1, 1, 2, 2, 2, 2]] + np.array([0, 1, 2, 0, 1, 2, 3])

    def integers(values: np.ndarray | Sequence[int]) -> Array:
        return as_integers(as_like(np.asarray(values, float), like))

    return RecordPlaces(
        integers(sides + FORCE_AT),
        integers(sides + PLACE_AT),
        as_like((address >= 0)[..., None].astype(float), like),
        integers(rows),
        integers([bodies.index(pad.body) for pad in pads]),
        integers([bodies.index(body) for _, body in places.geoms.tolist()]),
        as_like(places.offsets, like),
        as_like(places.turns.reshape(-1, 3, 3), like),
        places.size,
    )


def pad_poses(
    model: mujoco.MjModel, data: mujoco.MjData | None, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]
) -> np.ndarray:
    """(F, O, 6): the pads' middles m and the ways they look in the frames of the objects' bodies, in the data's pose or
    the model's first."""
    now = mujoco.MjData(model) if data is None else data
    if data is None:
        mujoco.mj_kinematics(model, now)
    poses = np.zeros((len(pads), len(shapes), 6))
    for f, pad in enumerate(pads):
        turn = now.xmat[pad.body].reshape(3, 3)
        middle, normal = now.xpos[pad.body] + turn @ pad.position, turn @ pad.axes[:, 0]
        for o, shape in enumerate(shapes):
            turn = now.xmat[shape.body].reshape(3, 3)
            poses[f, o] = *((middle - now.xpos[shape.body]) @ turn), *(normal @ turn)
    return poses
