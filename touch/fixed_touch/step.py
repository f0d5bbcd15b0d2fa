"""The sense of heat of many worlds as a pure step of arrays: NumPy, PyTorch, JAX.

What `ThermalTouch.update` does with recorded contact sensors, for fingertips that touch each object at one place.

B: worlds, F: fingertips, O: objects, N = F O: pairs, G: geoms of the objects, H: substeps, L: forces of a pair, K:
states of all fields, R: states of a narrow contact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, whole_number

from ...thermal import ArrayTables, Material, SignalChain, SignalState, array_step, measure_sample
from ...thermal.numerics import Array, as_integers, as_like, namespace_of
from ..contacts import ArrayContacts, TouchContacts
from ..heat import ArrayNarrow, array_ripple
from .checked import check_step, checked_material, checked_temperature, checked_worlds
from .record import RecordPlaces, recorded_contacts
from .state import FixedTouchReading, FixedTouchState


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
        choices = dict(zip(self.objects, map(len, self.materials), strict=True))
        made_of = state.material if material is None else checked_material(material, state, choices)
        first = state.first if temperature is None else checked_temperature(temperature, state)
        excess = first - self.ambient
        held = [self.held[o][made_of[:, o]] for o in range(len(self.objects))]
        heat: Array = sum((excess[:, o] * each)[:, None] * self.mean[o] for o, each in enumerate(held))
        none = 0.0 * self.seebeck + as_like(np.zeros((count, 1)), state.heat)
        resting = SignalState(none, none)
        _, volts = measure_sample(self.chain, resting, none, self.seebeck, self.dt)
        voltage = volts[..., None] + as_like(np.zeros(state.voltage.shape), state.heat)
        fresh = (heat, as_like(np.zeros(state.narrow.shape), state.heat), none, none, voltage, made_of, first)
        before = (state.heat, state.narrow, *state.signal, state.voltage, state.material, state.first)
        if worlds is not None:
            chosen = checked_worlds(worlds, state)
            fresh = tuple(
                xp.where(chosen[(slice(None),) + (None,) * (new.ndim - 1)], new, old)
                for new, old in zip(fresh, before, strict=True)
            )
        heat, narrow, filtered, last, voltage, made_of, first = fresh
        return FixedTouchState(heat, narrow, SignalState(filtered, last), voltage, made_of, first)

    def contacts(self, record: Array) -> TouchContacts:
        """The contacts of recorded sensordata (B, H, sensordata), or (B, sensordata) of one substep, of a model that
        touch.prepare has made. Raises InvalidValueError for another model or shape."""
        return recorded_contacts(self.record, record)

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
        check_step(state, contacts, substeps=self.substeps, geoms=self.geoms.shape[0], dt=self.dt)
        xp = namespace_of(state.heat)
        expected, given = tuple(state.signal.last.shape), tuple(getattr(noise, "shape", ()))
        if given not in ((), expected):
            raise InvalidValueError(f"noise must be a number or have the shape {expected}, got {given}")
        material, worlds = state.material, state.heat.shape[0]
        found = self.reads.of_step(contacts, material[:, self.owner], self.of_object)
        pairs = (worlds, len(self.fingertips) * len(self.objects))
        conducts, area, length, closed, pulses = (
            each.reshape(pairs)
            for each in (found.conductance, found.area, found.length, found.closed, found.pulses)
        )
        shares = found.shares.reshape((*pairs, 4))
        network, kind = self._numbers(material)
        touching = conducts > 0
        narrow = self.narrow.behind(
            state.narrow, kind, touching, area, length, shares, array_ripple(closed, pulses)
        )
        joined = xp.where(
            touching, 1 / (1 / xp.where(touching, conducts, 1.0 + 0.0 * conducts) + narrow.series), conducts
        )
        heat, heard = array_step(
            self.tables, network, state.heat, joined, self.difference - narrow.behind, narrow.mutual
        )
        drop = heard.drop[:, :: len(self.objects)]
        signal, volts = measure_sample(self.chain, state.signal, drop, self.seebeck, self.dt, noise)
        voltage = xp.concatenate((state.voltage[..., 1:], volts[..., None]), -1)
        after = FixedTouchState(
            heat, self.narrow.after(state.narrow, narrow, heard.flow), signal, voltage, material, state.first
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
