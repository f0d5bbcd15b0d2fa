"""What pads meet of a mesh that has slipped or turned between them since they closed on it.

Where they close, mesh_contact.py knows, with pads that align themselves. From there on the contact changes as that of
pads without a tilt does (thermal/pressed/mesh_table.py): by the ratio of what these meet at the new place and where the
grasp closed. Places and directions are those of grids, so that the contact follows from where the pads are alone.

N: meshes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...thermal import ContactArea, Material, Pad, Skin
from ...thermal.contact import FIRST_FORCE, FORCE_STEP, FORCES, TABLE_FORCES
from ...thermal.pressed import PressedView, Ring, pressed_view
from ..bodies import MeshShape, ObjectSpec

GRID = 5e-4
"""m, between places."""
_TURN = math.radians(15)
"""Between directions."""
_LEAST = 1e-12  # W/K or m2: less is none
_LOADS = np.log(TABLE_FORCES), FIRST_FORCE + FORCE_STEP * np.arange(FORCES)


@dataclass(frozen=True, slots=True)
class _Asked:
    """What of a view is asked: m2 that touch of the face, or of a ring, and their share of the force, the face rigid if
    the mesh's material is told; or of a face with a skin, or a rigid one, on a mesh of that material W/K, m2 and m of
    the patch that conducts; or where that lies, as ClosedMesh.lying_at tells it."""

    body: Material | None
    skin: Skin | None = None
    ring: Ring | None = None
    conducts: bool = False
    lies: bool = False

    @property
    def rounded(self) -> bool:
        """Whether the surface is taken as smooth: a rigid face would lie on one of its triangles."""
        return self.body is not None and self.skin is None

    @property
    def width(self) -> int:
        """k, of the numbers that are told."""
        return 5 if self.lies else 3 if self.conducts else 2


_TOUCHED = _Asked(None)
_CLOSED = (0, 0, 0, 0, 0)


@dataclass(frozen=True, slots=True)
class ClosedMesh:
    """A mesh as pads close on it. azimuth: rad, of the first pad's normal in its frame, which is level there. place:
    (3,) m in the mesh's frame, of what of the pads' middles is across that normal."""

    pad: Pad
    shape: MeshShape
    azimuth: float
    place: tuple[float, float, float]
    contact: ContactArea

    def contact_at(self, step: tuple[int, ...]) -> ContactArea:
        """The contact at TABLE_FORCES, (9,) each; the pad's area is that of closing. step: of `mesh_steps`, (5,)."""
        if not any(step):
            return self.contact
        here, first = self._area_and_share(step, _TOUCHED), self._area_and_share(_CLOSED, _TOUCHED)
        face, load = (
            np.where(was > 0, known * now / np.where(was > 0, was, 1.0), now)
            for known, now, was in zip((self.contact.face, self._share), here, first, strict=True)
        )
        face = np.minimum(face, self.pad.face**2)
        return ContactArea(self.contact.pad, face, np.minimum(load, 1.0) * TABLE_FORCES)

    def bare_at(self, step: tuple[int, ...], body: Material) -> tuple[np.ndarray, np.ndarray]:
        """(W/K, m2 of the patch that stands for what conducts), at TABLE_FORCES, (9,) each, of a rigid face that wears
        no skin on a mesh of that material; the mean of both sides that touch. step: as contact_at's."""
        mean = self._of_views(step, _Asked(body, conducts=True))[:, :2]
        through, area = (np.exp(np.interp(*_LOADS, np.log(np.maximum(column, _LEAST)))) for column in mean.T)
        return np.where(through > 2 * _LEAST, through, 0.0), np.where(area > 2 * _LEAST, area, 0.0)

    def seen_at(self, step: tuple[int, ...]) -> ContactArea:
        """What touches at TABLE_FORCES, (9,) each, as conducts_at has it."""
        area, share = self._area_and_share(step, _TOUCHED)
        return ContactArea(area, area, share * TABLE_FORCES)

    def conducts_at(self, step: tuple[int, ...], skin: Skin, body: Material) -> np.ndarray:
        """(9,) W/K at TABLE_FORCES of a face with that skin on a mesh of that material, with the gas beside what
        touches. step: as contact_at's."""
        return np.interp(*_LOADS, self._of_views(step, _Asked(body, skin, conducts=True))[:, 0])

    def widened(self, step: tuple[int, ...], skin: Skin, body: Material) -> np.ndarray:
        """(9,) at TABLE_FORCES: how much wider the patch that stands for what conducts is than what touches, of a face
        with that skin on a mesh of that material. step: as contact_at's."""
        patch = self._of_views(step, _Asked(body, skin, conducts=True))[:, 1]
        touched = self._of_views(step, _TOUCHED)[:, 0]
        wide, narrow = (np.interp(*_LOADS, column) for column in (patch, touched))
        return np.where(narrow > 0, np.maximum(wide / np.where(narrow > 0, narrow, 1.0), 1.0), 1.0)

    def patch_length(self, skin: Skin | None, body: Material, force: float) -> float:
        """m, one side of the rectangle that stands for what conducts where the pads closed on a mesh of that material,
        at a force N on the pad; 0 where none touches."""
        lengths = self._of_views(_CLOSED, _Asked(body, skin, conducts=True))[:, 2]
        return float(np.interp(math.log(force), _LOADS[1], lengths))

    def ring_at(
        self, step: tuple[int, ...], ring: Ring, closed: np.ndarray, rigid: Material | None
    ) -> ContactArea:
        """What touches of a ring of the pad at TABLE_FORCES, by what did as the pads closed: (2, 9) m2 and N. rigid:
        the mesh's material where a rigid face is in the ring."""
        here = self._area_and_share(step, _Asked(rigid, ring=ring))
        first = self._area_and_share(_CLOSED, _Asked(None, ring=ring))
        face, load = (
            np.where(was > 0, known * now / np.where(was > 0, was, 1.0), now)
            for known, now, was in zip((closed[0], closed[1] / TABLE_FORCES), here, first, strict=True)
        )
        face = np.minimum(face, ring.outer**2 - ring.inner**2)
        return ContactArea(face, face, np.minimum(load, 1.0) * TABLE_FORCES)

    def lying_at(self, step: tuple[int, ...], skin: Skin | None, body: Material) -> np.ndarray:
        """(9, 5) at TABLE_FORCES, the mean of both sides that touch: how long the face's contact is over the root of
        its area, and the shares by which it lies at an end, of pads without a tilt."""
        mean = self._of_views(step, _Asked(body, skin, conducts=True, lies=True))
        return np.stack([np.interp(*_LOADS, column) for column in mean.T], axis=1)

    @property
    def _share(self) -> np.ndarray:
        return self.contact.face_force / TABLE_FORCES

    def _area_and_share(self, step: tuple[int, ...], asked: _Asked) -> tuple[np.ndarray, np.ndarray]:
        """m2 on the face, or on a ring, and its share of the force, (9,) each, of pads without a tilt; the mean of
        both."""
        mean = self._of_views(step, asked)
        area, share = (np.interp(*_LOADS, column) for column in mean.T)
        return area, share

    def _of_views(self, step: tuple[int, ...], asked: _Asked) -> np.ndarray:
        """(FORCES, k), what is asked, the mean of both sides that touch."""
        azimuth, elevation = self.azimuth + step[3] * _TURN, step[4] * _TURN
        place = np.array(self.place) + GRID * np.array(step[:3])
        found = []
        for side in (1, -1):
            view, across, begin = _view(self.pad, self.shape, azimuth, elevation, side, asked.rounded)
            found.append(_between(view, across @ place - begin, asked))
        both = [each for each in found if each.any()]
        return np.mean(both, axis=0) if both else np.zeros_like(found[0])


def closed_mesh(pad: Pad, spec: ObjectSpec, contact: ContactArea) -> ClosedMesh:
    """contact: of mesh_contact at TABLE_FORCES."""
    (x, y), turn = spec.position, spec.yaw
    cos, sin = math.cos(turn), math.sin(turn)
    height = spec.grasp_height - spec.size[2] / 2
    middle, normal = np.array([-x * cos - y * sin, x * sin - y * cos, height]), np.array([cos, -sin, 0.0])
    across = middle - (middle @ normal) * normal
    return ClosedMesh(
        pad, spec.geometry, -turn, (float(across[0]), float(across[1]), float(across[2])), contact
    )


def mesh_steps(places: np.ndarray, azimuth: np.ndarray, closed: np.ndarray) -> np.ndarray:
    """(N, 5) whole numbers of GRID along the mesh's axes, and of turns to the side and up, from where the pads closed.
    places: (N, 2, 3) m of their middles; azimuth: (N,) rad and closed: (N, 3) m, of ClosedMesh."""
    between = places[:, 1] - places[:, 0]
    length = np.sqrt((between**2).sum(axis=1, keepdims=True))
    normal = between / np.where(length > 0, length, 1.0)
    across = places[:, 0] - (places[:, 0] * normal).sum(axis=1, keepdims=True) * normal
    aside = np.arctan2(normal[:, 1], normal[:, 0]) - azimuth
    aside = np.arctan2(np.sin(aside), np.cos(aside))
    up = np.arcsin(np.clip(normal[:, 2], -1.0, 1.0))
    numbers = ((across - closed) / GRID, np.stack((aside, up), axis=1) / _TURN)
    return np.rint(np.concatenate(numbers, axis=1)).astype(np.int64)


@lru_cache(maxsize=256)
def _view(
    pad: Pad, shape: MeshShape, azimuth: float, elevation: float, side: int, rounded: bool
) -> tuple[PressedView, np.ndarray, np.ndarray]:
    """What a pad meets whose normal is that direction, or against it; the other two axes (2, 3), and m along these
    where the view begins. rounded: as pressed_view's."""
    cos, sin, level = math.cos(azimuth), math.sin(azimuth), math.cos(elevation)
    normal, aside = np.array([level * cos, level * sin, math.sin(elevation)]), np.array([-sin, cos, 0.0])
    axes = np.stack([side * normal, side * aside, np.cross(normal, aside)])
    vertices, faces = shape.surface
    corners = np.ascontiguousarray(vertices, float)
    view = pressed_view(
        pad, corners.tobytes(), faces.astype(np.int64).tobytes(), axes.tobytes(), rounded=rounded
    )
    return view, axes[1:], (corners @ axes[1:].T).min(axis=0) - pad.face / 2


def _between(view: PressedView, at: np.ndarray, asked: _Asked) -> np.ndarray:
    """(forces, k): what is asked, at a place (2,) m among the view's; beyond them none."""
    places = view.places
    if not all(places[axis, 0] < at[axis] < places[axis, -1] for axis in range(2)):
        return np.zeros((FORCES, asked.width))
    ends = 1 if asked.lies else 0  # where nothing touches, nothing lies
    i, j = (
        int(np.clip(np.searchsorted(places[axis], at[axis]) - 1, ends, places.shape[1] - 2 - ends))
        for axis in range(2)
    )
    values = _around(view, i, j, asked)
    for axis, k in enumerate((i, j)):
        share = (at[axis] - places[axis, k]) / (places[axis, k + 1] - places[axis, k])
        share = min(max(share, 0.0), 1.0) if asked.lies else share
        values = (1 - share) * values[:, 0] + share * values[:, 1]
    return values


@lru_cache(maxsize=2048)
def _around(view: PressedView, i: int, j: int, asked: _Asked) -> np.ndarray:
    """(forces, 2, 2, k): what is asked, at the places round one of the view's cells."""
    cell = (i, i + 2), (j, j + 2)
    if not asked.conducts:
        return view.touched(asked.ring, cell, bare=asked.body)
    assert asked.body is not None
    every = view.conducted(asked.skin, asked.body, cell)
    long, longer, contact, gas, area, wide = np.moveaxis(every[..., 4:], -1, 0)
    patch, length = (_mean(contact, a, gas, b) for a, b in ((area, wide), (long, longer)))
    if not asked.lies:
        return np.stack((contact + gas, patch, length), axis=-1)
    over = np.where(patch > _LEAST, length / np.sqrt(np.maximum(patch, _LEAST)), 1.0)
    return np.concatenate((over[..., None], every[..., :4]), axis=-1)


def _mean(contact: np.ndarray, one: np.ndarray, gas: np.ndarray, other: np.ndarray) -> np.ndarray:
    return (contact * one + gas * other) / np.maximum(contact + gas, _LEAST)
