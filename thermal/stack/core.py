"""A heated sensor as simulations take it: its front as an element, and what is behind the heater's place as a core.

From the heater's place on, the layers in front are a SensorStack, of which networks know how heat spreads. The core is
what lies behind: layers, backing and heater, uniform over the face, a chain of lumps whose last is the heater's place.
Networks take that place as warm as it is at the step's start and say how much heat they drew; the core then goes on,
exact for heat that is constant over the step. What the element will take of the core's change, it is given at once (a
capacity beside the core's own) and is not charged for when it has taken it: heat is conserved, and turns taken by two
light bodies do not grow.

B: rows (fingertips), N: nodes of the core.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from thermograsp.errors import InvalidValueError, positive

from ..matter import Layer, SensorStack
from .cells import Chain, layers_chain
from .design import HeatedStack, Place
from .laws import HeaterMemory, Held

_LEAST_PIECE = 1e-6  # of a layer's thickness: what a cut leaves beside it is no layer
_SLOPE = np.array([24.5, 25.5])  # °C, between which a divider's slope is taken


@dataclass(frozen=True, slots=True, eq=False)
class HeatedCore:
    """A heated sensor ready to be stepped. sensor: what it is. element: in front of the heater; its sensed layer lies
    between heater and readout, its `seebeck` is the divider's slope at 25 °C. readout: node of the core that is read,
    None where the reading is the heater's place less the drop over the sensed layer. dt: s. decay: (N, N), heat: (N,)
    K/W of the heater's place over a step, room: (N,) K per K of the surroundings. answering: J/K of the element's
    that is stepped with the core. chain: what is behind the heater's place, per area. behind: its layers, the heater's
    place last, of which as many as `ahead` are between readout and heater."""

    sensor: HeatedStack
    element: SensorStack
    readout: int | None
    dt: float
    decay: np.ndarray
    heat: np.ndarray
    room: np.ndarray
    answering: float
    chain: Chain
    behind: tuple[Layer, ...]
    ahead: int

    @property
    def leak(self) -> float:
        """W/K, from the heater's place to the surroundings, once all behind it is settled."""
        return (
            self.element.face_area / (1 / self.chain.loss + self._resistance[self.chain.back])
            if self.chain.loss
            else 0.0
        )

    @property
    def _resistance(self) -> np.ndarray:
        """(N,) m2 K/W between a node and the heater's place; what is behind the back has its own."""
        between = np.append(np.cumsum(1 / self.chain.links[::-1])[::-1], 0.0)
        return np.minimum(between, between[self.chain.back])

    def settled(self, temperature: np.ndarray, ambient: float) -> CoreState:
        """Heated for long so that the heater's place is at temperature (B,) °C with nothing touched; surroundings at
        ambient °C."""
        power = self.leak / self.element.face_area * (temperature - ambient)  # below 0 where that is warmer
        nodes = temperature[:, None] - power[:, None] * self._resistance
        start = temperature if self.readout is None else nodes[:, self.readout]
        memory = HeaterMemory.begin(np.maximum(power, 0.0), start)
        return CoreState(nodes, np.zeros(len(nodes)), start.copy(), *memory)

    def step(
        self, state: CoreState, drawn: np.ndarray, drop: np.ndarray, force: np.ndarray, ambient: float
    ) -> CoreState:
        """The state dt later. drawn: (B,) W taken from the heater's place. drop: (B,) K over the sensed layer at
        the end, the heater's place as warm as at the start. force: (B,) N on the fingertip at the start."""
        law, memory = self.sensor.law, state.memory
        nodes = state.nodes
        if not isinstance(law, Held):
            power, memory = law.power_now(memory, force, state.reading, self.dt)
            heat = power * self.element.face_area - drawn + self.answering / self.dt * state.change
            # column by column, so that rounding does not depend on what else a batch holds
            nodes = heat[:, None] * self.heat + ambient * self.room
            for column, before in zip(self.decay.T, state.nodes.T, strict=True):
                nodes = nodes + before[:, None] * column
        reading = state.temperature - drop if self.readout is None else nodes[:, self.readout]
        return CoreState(nodes, nodes[:, -1] - state.temperature, reading, *memory)


@dataclass(frozen=True, slots=True)
class CoreState:
    """The state of many heated sensors. nodes: (B, N) °C, the heater's place last. change: (B,) K, its last step's.
    reading: (B,) °C at the readout. The others as in HeaterMemory."""

    nodes: np.ndarray
    change: np.ndarray
    reading: np.ndarray
    before: np.ndarray
    cut: np.ndarray
    integral: np.ndarray
    previous: np.ndarray
    setpoint: np.ndarray

    @property
    def temperature(self) -> np.ndarray:
        """(B,) °C of the heater's place."""
        return self.nodes[:, -1]

    @property
    def memory(self) -> HeaterMemory:
        """The heater's."""
        return HeaterMemory(self.before, self.cut, self.integral, self.previous, self.setpoint)


@lru_cache(maxsize=64)
def heated_core(sensor: HeatedStack, dt: float) -> HeatedCore:
    """The sensor, to be stepped by dt s. Raises InvalidValueError where a core cannot stand for what is behind the
    heater, with the reason; `touch_curves` steps such stacks."""
    positive("dt (s)", dt)
    heater = _before(sensor.layers, sensor.heater)
    behind, front = _cut(sensor.layers, heater)
    if not front:
        raise InvalidValueError(
            f"sensor {sensor.name!r}: its heater is at its face, so that no layer is between it and what is touched; "
            "give a layer in front of the heater"
        )
    ahead = _before(sensor.layers, sensor.readout) - heater
    readout = None
    between: tuple[Layer, ...] = ()
    if ahead > _LEAST_PIECE * front[0].thickness:
        between, front = _cut(front, ahead)
        if len(between) > 1:
            names = ", ".join(layer.name for layer in between)
            raise InvalidValueError(
                f"sensor {sensor.name!r}: {len(between)} layers ({names}) lie between heater and readout, and a "
                "simulated fingertip is read across one: join them into one layer of their resistance and capacity"
            )
    nearer: tuple[Layer, ...] = ()
    if between:
        chain, _ = layers_chain(behind, sensor.backing, ())
    else:
        deeper, nearer = _cut(behind, heater + ahead)
        behind = (*deeper, *nearer)
        chain, nodes = layers_chain(behind, sensor.backing, ())
        readout = nodes[Place(len(deeper), 0.0)] if nearer else len(chain.capacity) - 1
    slope = float(np.abs(np.diff(sensor.divider.voltage(_SLOPE)))[0])
    element = SensorStack(sensor.name, (*between, *front), sensor.width, 0, slope)
    area = element.face_area
    held = isinstance(sensor.law, Held)
    answering = element.answering(dt)
    decay, heat, room = _unmoved(chain) if held else _propagator(chain, area, dt, answering)
    return HeatedCore(sensor, element, readout, dt, decay, heat, room, answering, chain, behind, len(nearer))


def _propagator(
    chain: Chain, area: float, dt: float, answering: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(decay, heat, room) of HeatedCore, from the eigenvectors of the chain."""
    rates, turn, root = chain.modes(area, answering)
    stays = np.exp(-rates * dt)
    grows = np.where(rates * dt > 1e-12, -np.expm1(-rates * dt) / np.maximum(rates, 1e-300), dt)
    rows = root[:, None] * turn
    decay = (rows * stays) @ (turn.T / root)
    answer = (rows * grows) @ rows.T
    return decay, answer[:, -1].copy(), answer[:, chain.back] * chain.loss * area


def _unmoved(chain: Chain) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """_propagator's where the heater holds everything behind it."""
    count = len(chain.capacity)
    return np.eye(count), np.zeros(count), np.zeros(count)


def _before(layers: tuple[Layer, ...], place: Place) -> float:
    """m from the back of the first layer to a place."""
    return sum(x.thickness for x in layers[: place.layer]) + place.depth * layers[place.layer].thickness


def _cut(layers: tuple[Layer, ...], depth: float) -> tuple[tuple[Layer, ...], tuple[Layer, ...]]:
    """Layers before and after a depth m; one that it goes through is in both, as thick as each has of it."""
    before, after, start = [], [], 0.0
    for layer in layers:
        share = float(np.clip((depth - start) / layer.thickness, 0.0, 1.0))
        start += layer.thickness
        if share > _LEAST_PIECE:
            before.append(replace(layer, thickness=layer.thickness * share))
        if share < 1 - _LEAST_PIECE:
            after.append(replace(layer, thickness=layer.thickness * (1 - share)))
    return tuple(before), tuple(after)
