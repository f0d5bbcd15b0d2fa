"""Our fingertips on a batch that is simulated elsewhere: normal forces in, voltages out, in that batch's own arrays.

    tips = array_fingertips("glass", dt=0.01, like=force)          # once; force: (B, F) N, a tensor on any device
    state = tips.start(len(force))
    state, voltage, reading = tips.step(state, tips.conductance(force))

A row that comes to another object takes its fingertips' warmth along. The object that it comes to is at its first
temperature, and the one that it leaves is forgotten.

B: rows, F: fingertips, T: different objects, K: states of the largest network, J: numbers that carry F fingertips.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Literal, NamedTuple

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, length, non_negative, positive

from ..contact import (
    ContactArea,
    Joint,
    Pad,
    Surface,
    contact_conductance,
    element_joint,
    face_joint,
    flat_contact,
    skinned,
    stack_joints,
)
from ..matter import Material, Mode, SensorStack, Skin, material
from ..matter import sensor as sensor_preset
from ..matter import skin as named_skin
from ..network import Demand, network_for
from ..numerics import Array, as_integers, as_like, namespace_of
from ..plates import Geometry
from ..readout import (
    ADS1115,
    SignalChain,
    SignalState,
    measure_sample,
)
from .carry import carry_steps
from .rows import HeatReading, heat_tables
from .step import array_step
from .tables import ArrayTables, array_tables

Size = tuple[float, float, float]
_LAW = tuple(field.name for field in fields(Joint))
LEAST_DIFFERENCE = 12.0  # K for which the tolerance is meant at least
MOST_FORCE = 1e3
"""N on a pad, 2.5 MPa, up to which conductance grows: far above what any gripper of this size presses with."""


class FingertipState(NamedTuple):
    """The state of many fingertips: heat and electronics. heat: (B, K), of the networks. difference: (B, F) K, what
    sensor less object was at the start. signal: of the electronics, (B, F) each. which: (B,) integers, the object that
    each row touched last."""

    heat: Array
    difference: Array
    signal: SignalState
    which: Array


@dataclass(frozen=True, slots=True)
class ArrayFingertips:
    """Fingertips and the objects they may touch, for steps of dt s. Methods are pure: they can be traced, compiled,
    vectorised and differentiated. tables, rungs: the objects' networks and their names. leave, enter: (T, K, J) and
    (T, J, K), what carries fingertips from one network to another (carry_steps). contact: Joint of arrays (T,). area:
    (T,) m2 of the sensor's face in contact and share: (T,) of the pad's force on it. sensor_temperature,
    object_temperature: °C at the start. chain, seebeck V/K: the electronics."""

    dt: float
    fingertips: int
    tables: ArrayTables
    rungs: tuple[str, ...]
    leave: Array
    enter: Array
    contact: Joint
    area: Array
    share: Array
    sensor_temperature: float
    object_temperature: float
    chain: SignalChain
    seebeck: float

    def start(self, rows: int, object_temperature: Array | None = None) -> FingertipState:
        """The state with everything at its first temperature, for so many rows. object_temperature: (rows,) °C where it
        differs."""
        like = self.tables.decay
        still = as_like(np.zeros((rows, self.fingertips)), like)
        first = self.object_temperature if object_temperature is None else object_temperature[..., None]
        heat = as_like(np.zeros((rows, like.shape[-1])), like)
        difference = still + (self.sensor_temperature - first)
        return FingertipState(heat, difference, SignalState(still, still), as_integers(still[..., 0]))

    def restart(
        self, state: FingertipState, rows: Array, object_temperature: Array | None = None
    ) -> FingertipState:
        """The state with the given rows (B,) bool at the start again."""
        fresh = self.start(state.heat.shape[0], object_temperature)
        where = namespace_of(state.heat).where

        def chosen(new: Array, old: Array) -> Array:
            return where(rows[..., None], new, old)

        return FingertipState(
            chosen(fresh.heat, state.heat),
            chosen(fresh.difference, state.difference),
            SignalState(*map(chosen, fresh.signal, state.signal)),
            where(rows, fresh.which, state.which),
        )

    def conductance(self, force: Array, which: Array | int | None = None) -> Array:
        """W/K of each flat contact, of the force's shape, from the normal force N on its pad; 0 where that is not above
        0, not a number where it is not finite. force: (B, ..., F), so that substeps can have an axis and the mean be
        taken over it. which: as in step.

        Above MOST_FORCE the law of spots that touch means nothing any more: a larger force counts as that one."""
        chosen = self._object(which, force.shape[0])

        def converted(table: Array) -> Array:
            """An entry a row, with axes of length 1 behind the rows' for the force's others."""
            entry = table[chosen]
            return entry[(...,) + (None,) * (force.ndim - entry.ndim)]

        law = Joint(**{name: converted(getattr(self.contact, name)) for name in _LAW})
        area, share = converted(self.area), converted(self.share)
        xp = namespace_of(force)
        touching, known = force > 0, xp.isfinite(force)
        # A contact apart is evaluated at 1 N and masked: its gradient is 0, where that of the law is infinite.
        pressure = xp.where(touching & known, force, 1.0).clip(max=MOST_FORCE) * (share / area)
        conducts = contact_conductance(law, pressure) * area * touching
        return xp.where(known, conducts, math.nan)

    def step(
        self,
        state: FingertipState,
        conductance: Array,
        which: Array | int | None = None,
        noise: Array | float = 0.0,
    ) -> tuple[FingertipState, Array, HeatReading]:
        """(state, voltage (B, F) V as the driver reports it, reading) dt later.

        conductance: (B, F) W/K, constant over the step: the mean where it varies. which: (B,) integers, each row's
        object; or one int for all; may be left out where there is one object, else that raises InvalidValueError. A row
        whose object is another one than in its last step meets that at its first temperature; its fingertips stay as
        warm as they were. noise: (B, F) standard normal numbers; 0 for electronics without noise.
        """
        number, heat, last = self._object(which, state.heat.shape[0]), state.heat, state.which
        if len(self.rungs) > 1:
            number = as_integers(last * 0 + number)
            between = (heat[..., None] * self.leave[last]).sum(-2)
            carried = (between[..., None] * self.enter[number]).sum(-2)
            heat = namespace_of(heat).where((number != last)[..., None], carried, heat)
            last = number
        heat, reading = array_step(self.tables, number, heat, conductance, state.difference)
        signal, voltage = measure_sample(self.chain, state.signal, reading.drop, self.seebeck, self.dt, noise)
        return FingertipState(heat, state.difference, signal, last), voltage, reading

    def _object(self, which: Array | int | None, rows: int) -> Array | int:
        if which is None:
            if len(self.rungs) > 1:
                raise InvalidValueError(
                    f"which of the {len(self.rungs)} objects each row touches must be given"
                )
            return 0
        if isinstance(which, int | np.integer | np.ndarray):  # tensors are not looked into
            numbers = np.asarray(which)
            if numbers.dtype.kind not in "iu" or not ((numbers >= 0) & (numbers < len(self.rungs))).all():
                raise InvalidValueError(
                    f"which must be whole numbers from 0 to {len(self.rungs) - 1}, an object of each row, got "
                    f"{which if numbers.size < 20 else numbers.dtype}"
                )
            if numbers.shape not in ((), (rows,)):
                raise InvalidValueError(
                    f"which must be one number or one for each of the {rows} rows, got shape {numbers.shape}"
                )
        return which


def array_fingertips(
    materials: str | Material | Sequence[str | Material],
    *,
    dt: float,
    like: Array,
    mode: Mode = "T",
    object_size: Size | list[Size] = (0.04, 0.04, 0.04),
    fingertips: Literal[1, 2] = 2,
    sensor: str | SensorStack = "seed",
    skin: str | Skin | None = None,
    chain: SignalChain = ADS1115,
    tolerance: float = 0.05,
    air: float = 5.0,
    sensor_temperature: float = 36.0,
    object_temperature: float = 24.0,
) -> ArrayFingertips:
    """Fingertips for boxes that they touch in the middle of a face, computed as `like`: an array of floating-point
    numbers whose kind (NumPy, PyTorch, JAX), dtype and device are taken.

    materials: of the objects; where there are several, `which` of the methods tells row by row. dt: s, a step, after
    which a voltage is sampled. mode: T or O. object_size: m, width, depth and, between the fingertips, thickness; a
    list of these where the objects differ. fingertips: 1, or 2 on opposite faces. sensor: a preset or a stack. skin:
    over the fingertips (T mode), a name of thermal.SKINS or a Skin, None for bare ones. chain: the electronics.
    tolerance: K of temperature drop that the networks keep from 0.05 to 20 s after a touch, in air too. air: W/(m2 K)
    on the objects. sensor_temperature, object_temperature: °C. Networks are built once and kept on disk. Raises
    UnknownNameError, and InvalidValueError for a value that none can have, or a tolerance that no network keeps.
    """
    positive("dt (s)", dt)
    non_negative("air (W/(m2 K))", air)
    positive("tolerance (K)", tolerance)
    difference = celsius("sensor_temperature (°C)", sensor_temperature)
    difference -= celsius("object_temperature (°C)", object_temperature)
    if mode not in ("T", "O") or fingertips not in (1, 2):
        raise InvalidValueError(
            f"mode must be 'T' or 'O' and fingertips 1 or 2, got {mode!r} and {fingertips!r}"
        )
    named = [materials] if isinstance(materials, str | Material) else list(materials)
    sizes = object_size if isinstance(object_size, list) else [object_size] * len(named)
    if not named or len(sizes) != len(named):
        raise InvalidValueError(f"give one object_size or a list of one per material, got {object_size!r}")
    sizes = [_size(size) for size in sizes]
    stack, worn = sensor_preset(sensor), named_skin(skin, mode)
    if worn is not None:
        stack = worn.over(stack)
    demand = Demand(tolerance, max(abs(difference), LEAST_DIFFERENCE))
    systems, joints, areas = [], [], []
    for of, size in zip(map(material, named), sizes, strict=True):
        faces, newton = _contact(stack, worn, of, mode, size)
        touched = min(float(newton.face), stack.face_area)
        geometry = Geometry(stack, of, mode, touched, "square", size, fingertips)
        systems.append(network_for(geometry, demand, air=air).system)
        joints.append(faces)
        areas.append((newton.face, newton.face_force))
    leave, enter = carry_steps(systems, max(len(system.rates) for system in systems))
    law = stack_joints(joints)
    # Faces that never yield are all elastic: the law does not look at their hardness, but infinity spoils gradients.
    law = replace(law, hardness=np.where(np.isinf(law.hardness), law.elastic_hardness, law.hardness))
    area, share = np.array(areas, dtype=float).T
    return ArrayFingertips(
        dt=dt,
        fingertips=fingertips,
        tables=array_tables(heat_tables(systems, [air] * len(systems), dt), like),
        rungs=tuple(f"network:{system.orders}" for system in systems),
        leave=as_like(leave, like),
        enter=as_like(enter, like),
        contact=Joint(**{name: as_like(getattr(law, name), like) for name in _LAW}),
        area=as_like(area, like),
        share=as_like(share, like),
        sensor_temperature=sensor_temperature,
        object_temperature=object_temperature,
        chain=chain,
        seebeck=stack.seebeck,
    )


def _size(size: Size) -> Size:
    """Width, depth and thickness m. Raises InvalidValueError for what is none."""
    if not isinstance(size, Sequence | np.ndarray) or len(size) != 3:
        raise InvalidValueError(
            f"object_size must be (width, depth, thickness) in m, or a list of these, got {size!r}: a cube of 0.04 m "
            "is (0.04, 0.04, 0.04)"
        )
    width, depth, thickness = (length("object_size (m)", each) for each in size)
    return width, depth, thickness


def _contact(
    stack: SensorStack, skin: Skin | None, of: Material, mode: Mode, size: Size
) -> tuple[Joint, ContactArea]:
    """The faces that meet, and the contact at 1 N: flat ones keep their area and their share of the force."""
    if min(size[:2]) < stack.width:
        raise InvalidValueError(
            f"object_size must be (width, depth, thickness) in m, no narrower than the sensor's face of "
            f"{stack.width:g} m, got {size!r}"
        )
    pad = skinned(Pad(face=stack.width), skin)
    if mode == "O":  # the thermostat meets the element that is glued to the object
        return element_joint(), flat_contact(pad, 1.0, (stack.width, stack.width))
    return face_joint(skin, Surface.of(of)), flat_contact(pad, 1.0, size[:2])
