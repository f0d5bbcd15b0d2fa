"""What a grasped object is to the heat model: its plate, the shape of its contact, its surface."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import (
    LAPPED_ALUMINA,
    THERMOSTAT_FACE,
    ContactArea,
    Geometry,
    Joint,
    Material,
    Mode,
    Pad,
    SensorStack,
    Surface,
    cylinder_contact,
    cylinder_law,
    flat_contact,
    flat_law,
    joint,
    sphere_contact,
    sphere_law,
)
from ..bodies import ObjectSpec

if TYPE_CHECKING:
    from ...thermal import Solid
    from .mesh_contact import MeshContact

PAD = Pad()
NOMINAL_FORCE = 10.0  # N, at which a curved object's patch is taken


@dataclass(frozen=True)
class GraspBody:
    """A body between the fingertips, as the heat model takes it.

    spec: its shape and place. material: what it is made of. temperature: °C at first. mode: T or O, where the element
    sits. stack: the sensor. fingertips: how many carry one. roughness_factor: on the object's surface. ambient: °C of
    the air, None for the object's. anywhere: its heat knows where it is touched, as a mesh's always does in T mode."""

    spec: ObjectSpec
    material: Material
    temperature: float
    mode: Mode
    stack: SensorStack
    fingertips: Literal[1, 2] = 2
    roughness_factor: float = 1.0
    ambient: float | None = None
    anywhere: bool = False

    @cached_property
    def contact_shape(self) -> Literal["flat", "cylinder", "sphere"]:
        """What the pads meet, of a mesh about. An element glued on (O mode) is flat."""
        if self.mode == "O" or self.spec.shape == "box":
            return "flat"
        return self._mesh_contact.shape if self.spec.shape == "mesh" else self.spec.shape

    @cached_property
    def _mesh_contact(self) -> MeshContact:
        """What the pads meet of a mesh; where they meet nothing, a face as wide as its bounding box stands for it."""
        from .mesh_contact import MeshContact, mesh_contact

        found = mesh_contact(PAD, self.spec, NOMINAL_FORCE)
        return found if min(found.size) > 0 else MeshContact("flat", np.inf, self.spec.size[1:])

    @cached_property
    def plate(self) -> tuple[float, float, float]:
        """(width, depth, thickness) m of the plate that stands for the object: as thick as it is between the fingers,
        of the same volume, and as wide to high as its bounding box; never narrower than the sensor's face."""
        x, (y, z) = self._thickness, self._sides
        area = self.spec.volume / x
        side = self.stack.width
        width = max(float(np.sqrt(area * y / z)), side)
        return width, max(area / width, side), x

    @cached_property
    def touched(self) -> Material:
        """What the pads meet: its material, or a part's."""
        number = self.spec.touched_part
        return self.spec.parts[number - 1].made_of if number else self.material

    @cached_property
    def joint(self) -> Joint:
        """The opening contact's faces: the lapped element on the object (T) or on the thermostat (O)."""
        if self.mode == "O":
            return joint(LAPPED_ALUMINA, THERMOSTAT_FACE)
        surface = Surface.of(self.touched)
        return joint(LAPPED_ALUMINA, replace(surface, roughness=surface.roughness * self.roughness_factor))

    @cached_property
    def geometry(self) -> Geometry:
        """The networks' geometry; a curved object's patch is that of NOMINAL_FORCE."""
        area = float(self.contact(np.array(NOMINAL_FORCE)).face)
        if not area > 0:
            raise InvalidValueError(
                f"object {self.spec.name!r} of size {self.spec.size} does not reach the sensor's face"
            )
        area = min(area, self.stack.face_area)
        return Geometry(self.stack, self.material, self.mode, area, "square", self.plate, self.fingertips)

    def contact(self, force: np.ndarray) -> ContactArea:
        """Areas and force share at that normal force N on a pad."""
        if self.contact_shape == "cylinder":
            return cylinder_contact(PAD, force, *self._round)
        if self.contact_shape == "sphere":
            return sphere_contact(PAD, force, self._round[0])
        return flat_contact(PAD, force, self._face)

    @property
    def _face(self) -> tuple[float, float]:
        """m, the flat face that the pads meet."""
        if self.mode == "O":
            return self.stack.width, self.stack.width
        return self._mesh_contact.size if self.spec.shape == "mesh" else self._sides

    @property
    def _across(self) -> tuple[int, int]:
        """The axes of the object's frame along the pads: a box that is turned is held by its other sides."""
        turned = (
            self.spec.shape == "box" and self.mode == "T" and abs(math.sin(self.spec.yaw)) > math.sqrt(0.5)
        )
        return (0, 2) if turned else (1, 2)

    @property
    def _sides(self) -> tuple[float, float]:
        """m, the size along those."""
        first, second = self._across
        return self.spec.size[first], self.spec.size[second]

    @property
    def _thickness(self) -> float:
        """m, between the pads."""
        return self.spec.size[1 - self._across[0]]

    @property
    def _round(self) -> tuple[float, float]:
        """m, radius and length of the round body that the pads meet."""
        if self.spec.shape == "mesh":
            return self._mesh_contact.radius, self._mesh_contact.size[0]
        return self.spec.size[0] / 2, self.spec.size[2]

    @cached_property
    def law(self) -> np.void:
        """Area and conductance by force, for compiled code."""
        if self.contact_shape == "cylinder":
            return cylinder_law(PAD, self.joint, *self._round)
        if self.contact_shape == "sphere":
            return sphere_law(PAD, self.joint, self._round[0])
        followed = self.mode == "T" and self.spec.shape == "box"
        return flat_law(PAD, self.joint, self._face, self._across if followed else None)

    @cached_property
    def heat_capacity(self) -> float:
        """J/K of the object, without elements."""
        width, height, thickness = self.plate
        return self.material.volumetric_heat_capacity * width * height * thickness

    @cached_property
    def box_capacity(self) -> float:
        """J/K of a box of one material, as large as it is."""
        return self.material.volumetric_heat_capacity * math.prod(self.spec.size)

    @cached_property
    def solid(self) -> Solid | None:
        """What its heat flows in, where that is no plate."""
        if self.mode == "O" or not (self.anywhere or self.spec.mesh or self.spec.parts):
            return None
        from ..bodies import object_solid

        spec = self.spec
        shape = ObjectSpec(
            shape=spec.shape, size=spec.size, mesh=spec.mesh, scale=spec.scale, pieces=spec.pieces
        )
        if spec.parts:
            shape = replace(shape, material=self.material, parts=spec.parts)
        return object_solid(shape, self.material)

    @property
    def extremes(self) -> tuple[float, ...]:
        """°C between which it and what is in it stay until something touches it."""
        inside = self.spec.reservoir
        return (
            self.temperature,
            self.temperature if self.ambient is None else self.ambient,
            *(inside.extremes(self.temperature) if inside else ()),
        )

    @cached_property
    def crushing_force(self) -> float:
        """N on one pad at which the object breaks, by the pad's mean pressure; inf for what does not."""
        if self.touched.crushing_stress is None:
            return np.inf
        return self.touched.crushing_stress * float(self.contact(np.array(NOMINAL_FORCE)).pad)
