"""A tactile map: the pressure over each pad, from the force, where it acts, and the object's shape.

MuJoCo's rigid contact gives a few points. The pad is soft: an elastic foundation spreads their force over it as the
object's surface demands (thermal/pressed), with the same stiffness as thermal/contact/area.py. The map's sum is the
normal force and its centre MuJoCo's centre of contact.

B: environments, F = 2 fingertips, O: objects, (n, m): taxels.
"""

from __future__ import annotations

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import Skin
from ...thermal.contact import bared, skinned
from ...thermal.pressed import face_springs, map_heights, pressure_map
from ..bodies import ObjectSpec
from ..limits import TIPS
from ..mechanics import Mechanics
from .grasp_body import PAD
from .surface_height import BOX, CYLINDER, SPHERE, mesh_map, shape_heights

MOST_TAXELS = 100  # along a side
MOST_PRESSURE = 1e7  # Pa; a pad pressed to nothing, by the linear law, bears 7e6
_FINENESS = 40  # points along a side, at least: half a millimetre
_SHAPES = {"box": BOX, "cylinder": CYLINDER, "sphere": SPHERE}


class Taxels:
    """Pressure maps of `shape` (n, m): n rows from the fingertip's end up to the wrist, m columns across, along the
    pad's horizontal axis. skin: over the pad and the sensor's face. Without one the face is rigid under balls and
    cylinders, and to flat bodies and meshes the pad is as soft all over. Raises InvalidValueError for a shape that is
    none."""

    def __init__(self, shape: tuple[int, int], skin: Skin | None = None) -> None:
        self.shape, self._pad = checked_taxels(shape), skinned(PAD, skin)
        self._under_round = bared(PAD) if skin is None else self._pad
        fine = [side * -(-_FINENESS // side) for side in self.shape]
        self._blocks = (self.shape[0], fine[0] // self.shape[0], self.shape[1], fine[1] // self.shape[1])
        z, y = (_middles(count) for count in fine)
        self._places = np.stack(np.broadcast_arrays(y[None, :], z[:, None]), axis=-1).reshape(-1, 2).copy()
        self._sides = PAD.width / fine[1], PAD.width / fine[0]
        self._springs = {
            pad: face_springs(pad, self._places, self._sides)[1] for pad in (self._pad, self._under_round)
        }
        self._height, self._cover, self._fine, self._elements = (
            np.zeros(len(self._places)) for _ in range(4)
        )

    @property
    def places(self) -> np.ndarray:
        """(n, m, 2) m, the taxels' middles along the pad's two tangential axes, horizontal and towards the wrist."""
        z, y = (_middles(count) for count in self.shape)
        return np.stack(np.broadcast_arrays(y[None, :], z[:, None]), axis=-1).copy()

    def nothing(self, rows: int) -> np.ndarray:
        """(B, F, n, m) Pa where nothing is touched."""
        return np.zeros((rows, len(TIPS), *self.shape))

    def pressure(self, mechanics: Mechanics, owner: np.ndarray | None = None) -> np.ndarray:
        """(B, F, n, m) Pa, of the control step that mechanics made last. owner: (B, F) the number of the object whose
        pressure is meant, None for that of all."""
        maps = self.nothing(mechanics.num_envs)
        for number, contact in enumerate(mechanics.pad_contacts()):
            pressed = (contact.force > 0.0) & np.isfinite(contact.force)
            for row, tip in np.argwhere(pressed if owner is None else pressed & (owner == number)):
                spec, pad = mechanics.objects[row][number], contact.pad[row, tip]
                maps[row, tip] += self._map(
                    spec, pad, float(contact.force[row, tip]), contact.centre[row, tip]
                )
        return maps

    def _map(self, spec: ObjectSpec, pad: np.ndarray, force: float, centre: np.ndarray) -> np.ndarray:
        self._surface(spec, pad)
        area = self._sides[0] * self._sides[1]
        bare = spec.shape in ("cylinder", "sphere") and not (spec.mesh or spec.elements)
        sheet = self._under_round if bare else self._pad
        springs = self._cover * self._springs[sheet]
        stiffness = sheet.foundation_modulus / sheet.thickness
        pressure_map(
            *(self._height, springs, self._places, area, stiffness, sheet.thickness),
            *(force, centre, self._fine),
        )
        return self._fine.reshape(self._blocks).mean(axis=(1, 3))

    def _surface(self, spec: ObjectSpec, pad: np.ndarray) -> None:
        """Heights and coverage of the object over the pad."""
        pitch = max(self._sides)
        if spec.mesh:
            seen = mesh_map(spec.geometry, pad[1])
            map_heights(*seen, pad, self._places, self._height, self._cover)
        else:
            half = np.array(spec.size) / 2
            shape_heights(_SHAPES[spec.shape], half, pad, self._places, pitch, self._height, self._cover)
        if spec.elements:
            self._cover_with_element(spec, pad, pitch)

    def _cover_with_element(self, spec: ObjectSpec, pad: np.ndarray, pitch: float) -> None:
        """The element glued on before the pad, over the object."""
        assert spec.elements is not None
        side, thickness = spec.elements
        place = spec.element_places[0 if pad[1, 0] > 0 else 1]  # the left pad's normal is +x
        lying = pad.copy()
        lying[0] -= place - np.sign(place) * (thickness / 2, 0.0, 0.0)
        half = np.array([thickness, side, side]) / 2
        height = np.zeros_like(self._height)
        shape_heights(BOX, half, lying, self._places, pitch, height, self._elements)
        on = self._elements > 0
        self._height[on], self._cover[on] = height[on], self._elements[on]


def checked_taxels(shape: object, name: str = "taxels") -> tuple[int, int]:
    """The shape. Raises InvalidValueError, with the keyword's name, unless it is two whole numbers from 1 to
    MOST_TAXELS."""
    sides = tuple(shape) if isinstance(shape, tuple | list) else (shape,)
    if len(sides) != 2 or not all(
        isinstance(side, int) and not isinstance(side, bool) and 1 <= side <= MOST_TAXELS for side in sides
    ):
        raise InvalidValueError(
            f"{name} must be two whole numbers (rows, columns) from 1 to {MOST_TAXELS}, got {shape!r}"
        )
    return sides[0], sides[1]


def _middles(count: int) -> np.ndarray:
    """m, of that many equal parts of the pad's side."""
    return (np.arange(count) + 0.5) * (PAD.width / count) - PAD.width / 2
