"""Impedance samples of the bodies on the two sides of a contact, for one geometry and any conductance.

One fingertip: the object is a plate whose back is adiabatic. Two fingertips face each other on opposite sides; the
object is symmetric about its middle plane, so what both contacts see splits into an even part (half the object, middle
plane adiabatic) and an odd part (middle plane at rest): two small problems in place of a coupled one.

Mode T: the contact is between element and object. Mode O: the elements are bonded to the object, the contact is between
thermostat and element, and the object's side of the contact is element and object together.

C: patterns of the contact patch, S: samples.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Literal

import numpy as np
from threadpoolctl import threadpool_limits

from ..matter import Layer, Material, Mode, SensorStack, Shape, Surround
from ..numerics import Sampled
from .impedance import (
    layer_impedance,
    layered_impedance,
    stack_profile,
    transfer_impedance,
)
from .patch import Patch, RoundPatch, SquarePatch
from .section import Disc, Rectangle, Section


@dataclass(frozen=True, slots=True)
class Geometry:
    """What the networks of a contact depend on. fingertips: 1, or 2 on opposite faces. surround: around the element,
    with its depth; the area is then of all that touches. Others as in PressProblem."""

    stack: SensorStack
    material: Material
    mode: Mode
    area: float
    shape: Shape
    object_size: tuple[float, float, float]
    fingertips: Literal[1, 2] = 1
    surround: Surround | None = field(default=None, kw_only=True)

    @property
    def front(self) -> tuple[float, float]:
        """m, the sides of the rectangle that touches."""
        if self.surround is None:
            side = float(np.sqrt(self.area))
            return side, side
        width = self.surround.width
        return min(width, self.object_size[0]), min(width, self.object_size[1])

    @property
    def element_capacity(self) -> float:
        """J/K of one element."""
        return self.stack.heat_capacity

    @property
    def object_capacity(self) -> float:
        """J/K of what of the object belongs to one fingertip: all, or half of it."""
        width, depth, _ = self.object_size
        return width * depth * self.plate.thickness * self.plate.volumetric_heat_capacity

    @property
    def whole_capacity(self) -> float:
        """J/K of the whole object."""
        width, depth, thickness = self.object_size
        return self.material.volumetric_heat_capacity * width * depth * thickness

    @property
    def surface(self) -> float:
        """m2 of the whole object's surface."""
        width, depth, thickness = self.object_size
        return 2 * (width * depth + width * thickness + depth * thickness)

    @property
    def patch(self) -> Patch:
        """The contact's."""
        return self._centred(self.area)

    @property
    def face(self) -> Patch:
        """The whole face of the element."""
        return self._centred(self.stack.face_area)

    @property
    def element_section(self) -> Section:
        """Cross-section of the element; a round contact has a round element of the same area."""
        if self.shape == "round":
            return Disc(np.sqrt(self.stack.face_area / np.pi))
        return Rectangle(self.stack.width / 2, self.stack.width / 2)

    @property
    def object_section(self) -> Section:
        """Cross-section of the object; under a round contact the disc of equal area."""
        width, depth, _ = self.object_size
        if self.shape == "round":
            return Disc(np.sqrt(width * depth / np.pi))
        return Rectangle(width / 2, depth / 2)

    @property
    def plate(self) -> Layer:
        """The object, down to its middle plane where two fingertips touch it."""
        return self.material.layer(self.object_size[2] / self.fingertips)

    @property
    def parities(self) -> tuple[str, ...]:
        """Names of the object's bodies."""
        return ("even",) if self.fingertips == 1 else ("even", "odd")

    def _centred(self, area: float) -> Patch:
        if self.shape == "round":
            return RoundPatch(np.sqrt(area / np.pi))
        return SquarePatch(np.sqrt(area) / 2, square=self.object_size[0] == self.object_size[1])


@dataclass(frozen=True, slots=True)
class BodySamples:
    """One body at real s (S,): its impedance (S, C, C) m2 K/W less the pole of its uniform temperature, and outputs.

    capacity: J/K of the body, whose uniform temperature is a state of rate 0; infinite where it is held.
    outputs: name -> (S, C), per W of heat flow into the body in each unit pattern of flux, without that state's part.
    uniform_outputs: name -> output of the body one kelvin warmer everywhere.
    """

    impedance: Sampled
    capacity: float
    outputs: dict[str, np.ndarray]
    uniform_outputs: dict[str, float] = field(default_factory=dict)


ElementSamples = tuple[Sampled, Sampled, Sampled]


def sample_bodies(
    geometry: Geometry, s: np.ndarray, element: ElementSamples | None = None
) -> dict[str, BodySamples]:
    """The bodies by name: "sensor" (T mode only; in O mode the thermostat holds its temperature), "even" and, for two
    fingertips, "odd" (the object, in O mode with the element). s: (S,) 1/s. element: of sample_element, where it is
    there already. Outputs "drop" (K, thermostat side less object side, heat flow counted into the body), "element" and
    "object" (J stored)."""
    if geometry.mode == "T":
        return {"sensor": _sensor(geometry, s), **{p: _object(geometry, p, s) for p in geometry.parities}}
    element = sample_element(geometry, s) if element is None else element
    return {parity: _bonded(geometry, parity, s, element) for parity in geometry.parities}


def _sensor(geometry: Geometry, s: np.ndarray) -> BodySamples:
    return _sensor_alone(geometry.stack, geometry.element_section, geometry.patch, tuple(s.tolist()))


@lru_cache(maxsize=8)  # of up to 7 MB
def _sensor_alone(
    stack: SensorStack, section: Section, patch: Patch, shifts: tuple[float, ...]
) -> BodySamples:
    """It does not depend on the object, and takes most of the time of a network: all objects share it. Not to be
    written to."""
    layers, s = stack.layers[::-1], np.array(shifts)
    with threadpool_limits(1, "blas"):  # who asks first decides no bits of those who ask later
        impedance = layered_impedance(layers, "isothermal", section, patch, s)
    temperatures, flows = stack_profile(layers, "isothermal", s[:, None], np.zeros(1))
    sensed = len(layers) - 1 - stack.sensed
    drop = (temperatures[sensed + 1] - temperatures[sensed])[:, 0] / section.area
    stored = ((flows[0] - flows[-1])[:, 0]) / s
    outputs = {"drop": np.outer(drop, patch.uniform), "element": np.outer(stored, patch.uniform)}
    return BodySamples(impedance, np.inf, outputs)


def _object(geometry: Geometry, parity: str, s: np.ndarray) -> BodySamples:
    far = "adiabatic" if parity == "even" else "isothermal"
    impedance = layer_impedance(geometry.plate, geometry.object_section, geometry.patch, far, s)
    none = np.zeros((len(s), len(geometry.patch.uniform)))
    if parity == "odd":
        return BodySamples(impedance, np.inf, {"object": none})
    capacity = geometry.object_capacity
    return BodySamples(impedance, capacity, {"object": none}, {"object": capacity})


def sample_element(geometry: Geometry, s: np.ndarray) -> ElementSamples:
    """The element alone, both faces adiabatic: its impedance at the contact, at the bond, and across, (S, bond,
    contact). It does not depend on the object's material."""
    layers, section = geometry.stack.layers, geometry.element_section
    top, bond = geometry.patch, geometry.face
    return (
        layered_impedance(layers, "adiabatic", section, top, s),
        layered_impedance(layers[::-1], "adiabatic", section, bond, s),
        transfer_impedance(layers, section, top, bond, s),
    )


def _bonded(geometry: Geometry, parity: str, s: np.ndarray, element: ElementSamples) -> BodySamples:
    layers, section = geometry.stack.layers, geometry.element_section
    top, bond = geometry.patch, geometry.face
    at_top, at_bond, across = element
    far = "adiabatic" if parity == "even" else "isothermal"
    plate = layer_impedance(geometry.plate, geometry.object_section, bond, far, s)
    if parity == "even":
        plate = plate + _pole(bond, geometry.object_capacity, s)
    at_bond = at_bond + plate
    bond_flow = np.linalg.solve(
        at_bond.value, across.value
    )  # flux patterns over the bond per pattern over the contact
    value = at_top.value - across.value.transpose(0, 2, 1) @ bond_flow
    cross = across.slope.transpose(0, 2, 1) @ bond_flow
    flow_back = bond_flow.transpose(0, 2, 1)
    slope = at_top.slope - cross - cross.transpose(0, 2, 1) + flow_back @ (at_bond.slope @ bond_flow)

    impedance = Sampled((value + value.transpose(0, 2, 1)) / 2, (slope + slope.transpose(0, 2, 1)) / 2)

    # One-dimensional outputs follow from the two total heat flows, into the element's top and out of its bond.
    into = np.broadcast_to(top.uniform, (len(s), len(top.uniform)))
    out = np.sqrt(bond.area / top.area) * np.einsum("b,sbc->sc", bond.uniform, bond_flow)
    down, _ = stack_profile(layers, "adiabatic", s[:, None], np.zeros(1))
    up, _ = stack_profile(layers[::-1], "adiabatic", s[:, None], np.zeros(1))
    sensed, count = geometry.stack.sensed, len(layers)
    from_top = (down[sensed] - down[sensed + 1]) / section.area
    from_bond = (up[count - sensed] - up[count - sensed - 1]) / section.area
    outputs = {"drop": from_top * into - from_bond * out, "element": (into - out) / s[:, None]}
    if parity == "odd":
        return BodySamples(impedance, np.inf, {**outputs, "object": np.zeros_like(out)})
    above, below = geometry.element_capacity, geometry.object_capacity
    capacity = above + below
    outputs["object"] = out / s[:, None] - into * below / capacity / s[:, None]
    outputs["element"] = outputs["element"] - into * above / capacity / s[:, None]
    rest = impedance + _pole(top, capacity, s, sign=-1.0)
    return BodySamples(rest, capacity, outputs, {"element": above, "object": below, "drop": 0.0})


def _pole(patch: Patch, capacity: float, s: np.ndarray, sign: float = 1.0) -> Sampled:
    """The uniform temperature's impedance A/(s C) over the uniform pattern."""
    uniform = np.outer(patch.uniform, patch.uniform) * patch.area / capacity * sign
    return Sampled(uniform / s[:, None, None], -uniform / s[:, None, None] ** 2)
