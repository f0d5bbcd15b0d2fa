"""What a grasped object is to the heat model: its plate, the shape of its contact, its surface."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import (
    ContactArea,
    Geometry,
    Joint,
    Material,
    Mode,
    Pad,
    SensorStack,
    SignalChain,
    Skin,
    Surface,
    Surround,
    cylinder_contact,
    flat_contact,
    material,
    sphere_contact,
)
from ...thermal.contact import (
    CONTACT_LAW,
    TABLE_FORCES,
    bared,
    beside_face,
    element_joint,
    even_patch,
    face_joint,
    flat_footprint,
    footprint,
    pad_joint,
    pad_law,
    round_footprint,
    skinned,
    solid_conduction,
    table_footprint,
)
from ..bodies import ObjectSpec

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...thermal import Solid, TouchSetup
    from ...thermal.pressed import Ring
    from .slipped_mesh import ClosedMesh

PAD = Pad()
_FLAT = 0.9  # of what conducts as on a soft pad
_MIDDLE = np.zeros(3)
NOMINAL_FORCE = 10.0  # N, at which a curved object's patch is taken


@dataclass(frozen=True)
class GraspBody:
    """A body between the fingertips, as the heat model takes it.

    spec: its shape and place. material: what it is made of. temperature: °C at first. mode: T or O, where the element
    sits. stack: the sensor. fingertips: how many carry one. roughness_factor: on the object's surface. ambient: °C of
    the air, None for the object's. anywhere: its heat knows where it is touched, as a mesh's always does in T mode.
    any_size: its size is drawn from any, so that its network is made where it can be and not searched. skin: of the
    fingertips, whose layer is the stack's last; None where they are bare. surround: the pad around the sensor, with its
    depth, which exchanges heat with it and with the object; None for none."""

    spec: ObjectSpec
    material: Material
    temperature: float
    mode: Mode
    stack: SensorStack
    fingertips: Literal[1, 2] = 2
    roughness_factor: float = 1.0
    ambient: float | None = None
    anywhere: bool = False
    any_size: bool = False
    skin: Skin | None = None
    surround: Surround | None = None

    @cached_property
    def pad(self) -> Pad:
        """What presses on it: the pad with its skin; for a ball or a cylinder that meets a bare face, with a rigid face
        in it. O: the thermostat, bare."""
        return bared(PAD) if self._on_bare_face else skinned(PAD, self.skin)

    @property
    def _on_bare_face(self) -> bool:
        """Whether a ball or a cylinder meets the sensor's own face, which does not yield."""
        return self.skin is None and self.mode == "T" and self.spec.shape in ("cylinder", "sphere")

    @property
    def _bare_mesh(self) -> bool:
        """Whether a mesh does."""
        return self.skin is None and self.mode == "T" and self.contact_shape == "mesh"

    @cached_property
    def contact_shape(self) -> Literal["flat", "cylinder", "sphere", "mesh"]:
        """What the pads meet. An element glued on (O mode) is flat, and so is what stands for a mesh that they miss."""
        if self.mode == "O" or self.spec.shape == "box":
            return "flat"
        if self.spec.mesh:
            from .mesh_contact import is_mesh_contact

            return "mesh" if is_mesh_contact(self.pad, self.spec) else "flat"
        return self.spec.shape

    @cached_property
    def _mesh_table(self) -> ContactArea:
        """What the pads meet of a mesh, at TABLE_FORCES."""
        return self._contact(self.pad, TABLE_FORCES, (0.0, 0.0))

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
        """The opening contact's faces: the lapped element or its skin on the object (T), or the element on the
        thermostat (O)."""
        return element_joint() if self.mode == "O" else face_joint(self.skin, self._surface)

    @cached_property
    def _surface(self) -> Surface:
        surface = Surface.of(self.touched)
        return replace(surface, roughness=surface.roughness * self.roughness_factor)

    @cached_property
    def geometry(self) -> Geometry:
        """The networks' geometry, with a surround on all of it that the plate reaches."""
        area, (width, depth, _) = self.face_area, self.plate
        if self.surround is not None:
            area = min(self.surround.width, width) * min(self.surround.width, depth)
        return Geometry(
            self.stack,
            self.material,
            self.mode,
            area,
            "square",
            self.plate,
            self.fingertips,
            surround=self.surround,
        )

    @cached_property
    def face_area(self) -> float:
        """m2 of the patch on the sensor's face; a curved object's is that of NOMINAL_FORCE, its middle before the
        pad's. It is wider than what touches: see even_patch. It is the square that impedes heat as the
        strip does that a cylinder touches, or the rectangle that stands for what a mesh does."""
        nominal = self._contact(self.pad, np.array(NOMINAL_FORCE), (0.0, 0.0))
        area = float(nominal.face)
        if self.contact_shape in ("cylinder", "sphere"):
            area = even_patch(self.law, self.touched, NOMINAL_FORCE, self.skin)
        if self._bare_mesh:
            area, _ = footprint(self.law, NOMINAL_FORCE, np.zeros(3))
        elif self.closed_mesh is not None and self.skin is not None:
            wider = self.closed_mesh.widened((0, 0, 0, 0, 0), self.skin, self.touched)
            area *= float(np.interp(math.log(NOMINAL_FORCE), np.log(TABLE_FORCES), wider))
        if self.contact_shape == "mesh" and not area > 0:  # it may slip to where the sensor is
            area = float(nominal.pad)
        if not area > 0:
            raise InvalidValueError(
                f"object {self.spec.name!r} of size {self.spec.size} does not reach the sensor's face"
            )
        length = self._patch_length
        if length == 0.0:
            return min(area, self.stack.face_area)
        from ...thermal.curves import equal_square

        return equal_square(self.stack, self.skin is not None, self.touched, area, length)

    @property
    def _patch_length(self) -> float:
        """m, of the rectangle that touches the face; 0 where that is as long as it is wide."""
        if self.contact_shape == "cylinder":
            return min(self.stack.width, self.spec.size[2])
        if self.closed_mesh is None:
            return 0.0
        return self.closed_mesh.patch_length(self.skin, self.touched, NOMINAL_FORCE)

    def check_sensed(self) -> None:
        """Raises InvalidValueError for an object on the table that fingers close on below the sensors' faces: forces
        would tell of a touch, and heat of none."""
        spec, lowest = self.spec, self.spec.grasp_height - self.stack.width / 2
        missed = spec.size[2] <= lowest
        if not missed and self.contact_shape in ("cylinder", "sphere"):
            missed = not self._contact(self.pad, np.array(NOMINAL_FORCE), (0.0, self._up)).face > 0
        if missed:
            raise InvalidValueError(
                f"object {spec.name!r} is a {spec.shape} {1e3 * spec.size[2]:.1f} mm high: the pads stay off the "
                f"table, and the sensors' faces begin {1e3 * lowest:.1f} mm above it, so that they would not touch it; "
                "make it higher"
            )

    def contact(self, force: np.ndarray) -> ContactArea:
        """Areas and force share at that normal force N on a pad, at the height at which the fingers are to close."""
        found = self._contact(self.pad, force, (0.0, self._up))
        if not self._on_bare_face:
            return found
        place, every = np.array([0.0, 0.0, self._up]), np.asarray(force, dtype=float)
        rows = [
            footprint(self.law, each, place) if each > 0 else (0.0, 0.0) for each in every.ravel().tolist()
        ]
        area, load = np.array(rows).reshape(-1, 2).T.reshape(2, *every.shape)
        return ContactArea(found.pad - found.face + area, area, load)

    def _contact(self, pad: Pad, force: np.ndarray, offset: tuple[float, float]) -> ContactArea:
        """The same of a pad whose middle is so far from the object's, m across and up. A mesh has its own place."""
        aside, up = offset
        if self.contact_shape == "cylinder":
            return cylinder_contact(pad, force, *self._round, offset=(up, aside))
        if self.contact_shape == "sphere":
            return sphere_contact(pad, force, self._round[0], offset=offset)
        if self.contact_shape == "flat":
            return flat_contact(pad, force, self._face, offset)
        from .mesh_contact import mesh_contact

        every = np.atleast_1d(force)
        found = mesh_contact(pad, self.spec, tuple(every.ravel().tolist()))
        assert found is not None  # or else something flat stands for it
        shaped = (each.reshape(np.shape(force)) for each in (found.pad, found.face, found.face_force))
        return ContactArea(*shaped)

    @property
    def _up(self) -> float:
        """m, where the pads' middles are above the object's as the fingers close."""
        return 0.0 if self.mode == "O" else self.spec.grasp_height - self.spec.size[2] / 2

    @property
    def edge_room(self) -> float:
        """m from the sensor's face, where the fingers close, to the nearest end of the face that they meet; below 0
        where that ends under it."""
        first, second = self._face
        return min(first, second - 2 * abs(self._up)) / 2 - self.stack.width / 2

    @property
    def _face(self) -> tuple[float, float]:
        """m, the flat face that the pads meet; of a mesh that they miss, as wide as its bounding box."""
        return (self.stack.width, self.stack.width) if self.mode == "O" else self._sides

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
        """m, radius and length of a cylinder or a sphere."""
        return self.spec.size[0] / 2, self.spec.size[2]

    @cached_property
    def law(self) -> np.void:
        """Area and conductance by force and place, for compiled code; FOOTPRINT_LAW."""
        if self.contact_shape in ("cylinder", "sphere"):
            radius, length = self._round
            length = length if self.contact_shape == "cylinder" else None
            return round_footprint(PAD, self.skin, self._surface, radius, length)
        if self.contact_shape == "flat":
            followed = self.mode == "T" and self.spec.shape == "box"
            return flat_footprint(self.pad, self.joint, self._face, self._across if followed else None)
        return self._table_law(self._mesh_table, (0, 0, 0, 0, 0))

    def _table_law(self, contact: ContactArea, step: tuple[int, ...]) -> np.void:
        """Of a mesh's contact at TABLE_FORCES after a step of slipped_mesh.py."""
        return self._soft_or_rigid(contact, step)[0]

    def _soft_or_rigid(self, contact: ContactArea, step: tuple[int, ...]) -> tuple[np.void, bool]:
        """A mesh's law, and whether it meets the bare face as one that does not yield."""
        soft = table_footprint(self.pad, self.joint, contact)
        if self.closed_mesh is None:
            return soft, False
        if self.skin is not None:
            # the tables tell how much more or less its contact and the gas conduct than what touches does by itself;
            # where the pads close, that is known more exactly than from them
            seen = table_footprint(self.pad, self.joint, self.closed_mesh.seen_at(step))
            through = self.closed_mesh.conducts_at(step, self.skin, self.touched)
            solid, same = (_table_conduction(law) for law in (soft, seen))
            through = np.where(same > 0, solid * through / np.where(same > 0, same, 1.0), through)
            borne = contact.face_force > 0
            if borne.any():
                soft["conducts"] = np.interp(TABLE_FORCES, contact.face_force[borne], through[borne])
            return soft, False
        if not self._bare_mesh:
            return soft, False
        conducts, area = self.closed_mesh.bare_at(step, self.touched)
        rigid = table_footprint(self.pad, self.joint, replace(contact, face=area), conducts)
        of_soft, of_rigid = (float(_table_conduction(law, (NOMINAL_FORCE,))[0]) for law in (soft, rigid))
        # a flat face meets the rigid one flush with the pad, whose areas and forces tell more exactly what conducts
        return (rigid, True) if of_rigid < _FLAT * of_soft else (soft, False)

    @cached_property
    def closed_mesh(self) -> ClosedMesh | None:
        """A mesh as the pads close on it; None of what else they meet."""
        if self.contact_shape != "mesh":
            return None
        from .slipped_mesh import closed_mesh

        return closed_mesh(self.pad, self.spec, self._mesh_table)

    @cached_property
    def pad_law(self) -> np.void:
        """By which the pad around the sensor conducts, beside_face's to evaluate; zeros without one."""
        if self.surround is None:
            return np.zeros(1, CONTACT_LAW)[0]
        made = material(self.surround.material)
        return pad_law(PAD, self.skin, made, self._surface, self._face, self._across)

    @cached_property
    def pad_conductance(self) -> float | None:
        """W/(m2 K) of the pad's contact at NOMINAL_FORCE to a factor of two, so that networks for nearly equal surfaces
        are the same; None without a pad."""
        if self.surround is None:
            return None
        half, place = np.array([self.surround.width / 2]), np.array([0.0, 0.0, self._up])
        conducts = beside_face(self.pad_law, half, NOMINAL_FORCE, place, np.zeros(1))
        return 2.0 ** round(math.log2(conducts)) if conducts > 0 else 0.0

    def slipped_law(self, step: tuple[int, ...]) -> np.void:
        """`law` of a mesh that has slipped and turned by a step of slipped_mesh.py."""
        assert self.closed_mesh is not None
        return self._table_law(self.closed_mesh.contact_at(step), step)

    def around_face(self, step: tuple[int, ...], rings: Sequence[Ring]) -> tuple[list[np.void], np.ndarray]:
        """By which laws rings of the pad around the sensor conduct to a mesh that has slipped and turned by a step, and
        (9, 6) where the face's contact lies at TABLE_FORCES; AroundFace has its columns, and the last one is how much
        wider than what touches the patch is that stands for what conducts."""
        from .mesh_contact import around_face

        mesh = self.closed_mesh
        assert mesh is not None
        bare = self.touched if self._soft_or_rigid(mesh.contact_at(step), step)[1] else None
        sides = tuple(ring.outer for ring in rings)
        closed = around_face(self.pad, self.spec, tuple(TABLE_FORCES.tolist()), sides)
        laws = [
            table_footprint(
                self.pad,
                pad_joint(self.skin, ring.made, self._surface),
                mesh.ring_at(step, ring, each, bare),
            )
            for ring, each in zip(rings, closed.rings, strict=True)
        ]
        lying = closed.lying.copy()
        if bare is not None:  # the pads that align themselves are soft, and what they touch is broader
            lying = mesh.lying_at(step, self.skin, self.touched)
        elif any(step):
            lies, lay = (mesh.lying_at(each, self.skin, self.touched) for each in (step, (0, 0, 0, 0, 0)))
            lying = lying + lies - lay
            lying[:, 1:] = np.clip(lying[:, 1:], 0.0, 1.0)
        wider = np.ones(len(lying))
        if self.skin is not None:
            wider = mesh.widened(step, self.skin, self.touched)
            lying[:, 0] = mesh.lying_at(step, self.skin, self.touched)[:, 0]  # of the patch
        return laws, np.column_stack((lying, wider))

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

    def touch_setup(
        self,
        chain: SignalChain,
        sensor_temperature: tuple[float, float],
        spread: float,
        tolerance: float,
    ) -> TouchSetup:
        """What an identifier may know of a touch of it beforehand. sensor_temperature: °C and its standard deviation.
        spread: K, standard deviation of the object's temperature. tolerance: K, of its network."""
        from ...thermal import TouchSetup

        return TouchSetup(
            stack=self.stack,
            mode=self.mode,
            area=self.face_area,
            object_size=self.plate,
            fingertips=self.fingertips,
            chain=chain,
            object_temperature=(self.temperature, spread),
            sensor_temperature=sensor_temperature,
            tolerance=tolerance,
        )

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
        """N on one pad at which the object breaks, by the mean pressure of a pad that is as soft all over as its
        silicone, since what breaks gives way under a stiffer face; inf for what does not."""
        if self.touched.crushing_stress is None:
            return np.inf
        soft = self._contact(PAD, np.array(NOMINAL_FORCE), (0.0, self._up))
        return self.touched.crushing_stress * float(soft.pad)


def _table_conduction(law: np.void, forces: Sequence[float] | np.ndarray = TABLE_FORCES) -> np.ndarray:
    """W/K at these forces N on the pad of a table's areas under what they bear."""
    touches = (footprint(law, force, _MIDDLE) for force in forces)
    return np.array([solid_conduction(law, *each, _MIDDLE, 0.0, 0.0) for each in touches])
