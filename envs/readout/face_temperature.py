"""A map of temperature: over the sensor's face of each fingertip, from where it is touched and the heat that flows.

The pressure over the pad (taxels.py) says which of the face's cells touch, and how well they conduct; the network says
how much heat flows and how warm the face is there on the mean. The rest is thermal/batch/face.py's.

B: environments, F = 2 fingertips, (n, m): parts of the face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

from ...thermal import Layer, SensorStack, Skin
from ...thermal.batch import (
    CELLS,
    FaceField,
    cosine_means,
    face_field,
    face_means,
    face_state,
    step_face,
)
from ...thermal.contact import (
    CYLINDER,
    beside_ball,
    beside_strip,
    conductance,
    footprint,
    solid_conduction,
)
from ..footprint import PAD, GraspBody, Taxels, checked_taxels
from ..limits import TIPS
from ..mechanics import Mechanics
from ..sensing import NEW_PATCH, HeatStep

PAD_POINTS = 40  # along the pad's side, on which the pressure is worked out: half a millimetre
_LEAST_PRESSURE = 1e-3  # of a face's highest, below which a cell is apart


@dataclass(frozen=True, slots=True)
class FaceTemperatureState:
    """Everything that the maps of some environments remember; picklable. fields, surface and contact: (n, F, ...) of a
    FaceState. begun (n, F): heat has flowed. owner (n, F): the object that the fingertip touches or touched last."""

    fields: np.ndarray
    surface: np.ndarray
    contact: np.ndarray
    begun: np.ndarray
    owner: np.ndarray


class FaceTemperature:
    """Maps of `shape` (n, m) in num_envs environments: n rows from the fingertip's end up to the wrist, m columns along
    the pad's horizontal axis, equal parts of the sensor's face, or of its skin's, whose layer is the stack's last. dt:
    s, a control step. Raises InvalidValueError for a shape that is none."""

    def __init__(
        self, shape: tuple[int, int], num_envs: int, stack: SensorStack, dt: float, skin: Skin | None = None
    ) -> None:
        self.shape = checked_taxels(shape, "face_temperature")
        self._stack, self._dt = stack, dt
        self._parts = tuple(cosine_means(side) for side in self.shape)
        self._pads = Taxels((PAD_POINTS, PAD_POINTS), skin)
        self._on_face = _shares(stack.width)
        each = (num_envs, len(TIPS))
        fields, surface, contact = (np.zeros((*each, *part.shape)) for part in face_state())
        self._state = FaceTemperatureState(
            fields, surface, contact, np.zeros(each, bool), np.zeros(each, int)
        )
        self._bodies: list[tuple[GraspBody, ...]] = [()] * num_envs
        self._fields: dict[tuple[int, int], FaceField] = {}  # by row and object, once it is touched

    def reset(self, rows: Sequence[int], scenes: Sequence[Sequence[GraspBody]]) -> None:
        """The rows start with new objects, every face as warm as its thermostat."""
        for row, bodies in zip(rows, scenes, strict=True):
            self._bodies[row] = tuple(bodies)
            for number in range(len(bodies)):
                self._fields.pop((row, number), None)
            state = self._state
            state.fields[row] = state.surface[row] = state.owner[row] = 0
            state.contact[row], state.begun[row] = 1.0, False

    def rest(self, step: HeatStep) -> np.ndarray:
        """(B, F, n, m) °C where nothing has touched."""
        even = step.info["sensor_surface"][..., None, None]
        return np.broadcast_to(even, (*even.shape[:2], *self.shape)).copy()

    def step(self, mechanics: Mechanics, step: HeatStep, owner: np.ndarray | None = None) -> np.ndarray:
        """(B, F, n, m) °C at the end of the control step that mechanics and heat made last. owner: (B, F) the object
        that each fingertip's heat goes to, where there are several."""
        maps, info, state = self.rest(step), step.info, self._state
        owners = np.zeros_like(state.owner) if owner is None else owner
        flux = info["flow"] / self._stack.face_area
        begun = state.begun | (flux != 0.0)
        pressure = self._pads.pressure(mechanics, owners)
        renewed = (owners != state.owner) | ((info["events"] & NEW_PATCH) > 0)
        state.fields[renewed, 1] = 0.0  # the object's side
        state.begun[:], state.owner[:] = begun, owners
        for row, tip in np.argwhere(begun).tolist():
            number = owners[row, tip]
            body = self._bodies[row][number]
            field = self._fields.get((row, number))
            if field is None:
                field = self._fields[row, number] = self._field(body)
            maps[row, tip] += _advance(
                *(body.law, pressure[row, tip], self._on_face, flux[row, tip]),
                *(state.fields[row, tip], state.surface[row, tip], state.contact[row, tip]),
                *self._parts,
                *field,
            )
        return maps

    def state(self, rows: Sequence[int]) -> FaceTemperatureState:
        """A copy of what the rows remember."""
        chosen, state = list(rows), self._state
        return FaceTemperatureState(
            state.fields[chosen],
            state.surface[chosen],
            state.contact[chosen],
            state.begun[chosen],
            state.owner[chosen],
        )

    def set_state(
        self, rows: Sequence[int], state: FaceTemperatureState, scenes: Sequence[Sequence[GraspBody]]
    ) -> None:
        """Puts the rows into a state taken by `state`, with these objects."""
        self.reset(rows, scenes)
        chosen, kept = list(rows), self._state
        kept.fields[chosen], kept.surface[chosen] = state.fields, state.surface
        kept.contact[chosen], kept.begun[chosen] = state.contact, state.begun
        kept.owner[chosen] = state.owner

    def _field(self, body: GraspBody) -> FaceField:
        made_of, thickness = body.touched, body.plate[2] / body.fingertips
        behind = made_of.layer(thickness)
        return _field_of(self._stack, behind, self._dt)


@lru_cache(maxsize=64)
def _field_of(stack: SensorStack, behind: Layer, dt: float) -> FaceField:
    return face_field(stack, behind, dt)


def _shares(width: float) -> np.ndarray:
    """(CELLS, PAD_POINTS): what of each cell along the face lies in each of the pad's squares."""
    cells = (np.arange(CELLS + 1) / CELLS - 0.5) * width
    points = (np.arange(PAD_POINTS + 1) / PAD_POINTS - 0.5) * PAD.width
    low = np.maximum(cells[:-1, None], points[:-1])
    high = np.minimum(cells[1:, None], points[1:])
    shares = np.maximum(high - low, 0.0) * CELLS / width
    return np.where(shares > 1e-9, shares, 0.0)


@njit(cache=True, error_model="numpy")
def _advance(law, pressure, on_face, flux, fields, surface, contact, rows, columns, *numbers):
    """One step of a face: (n, m) K above the mean over its contact; where gas conducts most, or all, above the mean
    weighted by what conducts. law: FOOTPRINT_LAW. pressure: Pa at the pad's points. on_face: of _shares. flux: W/m2.
    numbers: a FaceField's, which cost less to hand over one by one."""
    field = FaceField(*numbers)
    cells, half = np.zeros((CELLS, CELLS)), np.zeros((CELLS, PAD_POINTS))
    for i in range(CELLS):
        for k in range(PAD_POINTS):
            if on_face[i, k] > 0.0:
                for j in range(PAD_POINTS):
                    half[i, j] += on_face[i, k] * pressure[k, j]
    highest = 0.0
    for i in range(CELLS):
        for j in range(CELLS):
            for k in range(PAD_POINTS):
                cells[i, j] += on_face[j, k] * half[i, k]
            highest = max(highest, cells[i, j])
    for i in range(CELLS):
        for j in range(CELLS):
            # where there is nearly none gas alone conducts
            touches = cells[i, j] > _LEAST_PRESSURE * highest
            cells[i, j] = conductance(law, cells[i, j]) if touches else 0.0
    pressed = cells.copy()
    if law.mean_gap > 0.0:
        _add_gas(law, pressure, cells)
    step_face(field, cells, flux, fields, surface, contact)
    if law.mean_gap > 0.0 and cells.max() > 0.0:
        if law.modulus > 0.0 or pressed.max() == 0.0:
            contact[:] = cells
        else:
            contact[:] = np.where(pressed > 0.0, 1.0, 0.0)
    return face_means(field.waves, surface, contact, rows, columns)


@njit(cache=True, inner=True, error_model="numpy")
def _add_gas(law, pressure, cells):
    """Adds to cells (C, C) W/(m2 K) that are apart the gas beside the contact of a ball or an upright cylinder. On a
    bare face the contact is smaller than a cell: those that touch conduct what it does, and their gas."""
    force, y, z = 0.0, 0.0, 0.0
    pitch, side, half = 2 * law.half_pad / PAD_POINTS, 2 * law.half_face / CELLS, law.half_face
    for i in range(PAD_POINTS):
        for j in range(PAD_POINTS):
            force += pressure[i, j] * pitch * pitch
            y += pressure[i, j] * pitch * pitch * ((j + 0.5) * pitch - law.half_pad)
            z += pressure[i, j] * pitch * pitch * ((i + 0.5) * pitch - law.half_pad)
    if force <= 0.0:
        return
    y, z = y / force, z / force
    line = law.shape == CYLINDER
    place = np.array([0.0, y, 0.0 if line else z])
    touched, load = footprint(law, force, place)
    half_width = touched / (4 * half)
    square = half_width * half_width if line else touched / np.pi
    total = cells.sum() * side * side
    bare = law.modulus > 0.0
    share = solid_conduction(law, touched, load, place, 0.0, 0.0) / total if bare and total > 0.0 else 1.0
    for i in range(CELLS):
        for j in range(CELLS):
            if cells[i, j] > 0.0 and not bare:
                continue
            off_y, off_z = (j + 0.5) * side - half - y, (i + 0.5) * side - half - z
            if line:
                gas = beside_strip(square, law.mean_gap, law.radius, side / 2, off_y) / side
            else:
                beside = beside_ball(square, 0.0, law.mean_gap, law.radius, side / 2, off_y, off_z)
                gas = beside / (side * side)
            cells[i, j] = share * cells[i, j] + law.gas * gas
