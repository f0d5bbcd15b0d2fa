"""A map of temperature: over the sensor's face of each fingertip, from where it is touched and the heat that flows.

The pressure over the pad (taxels.py) says which of the face's cells touch, and how well they conduct; the network says
how much heat flows and how warm the face is there on the mean. The rest is thermal/face_field.py's.

B: environments, F = 2 fingertips, (n, m): parts of the face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit

from ..thermal import SensorStack
from ..thermal.contact_law import conductance
from ..thermal.face_field import (
    CELLS,
    FaceField,
    FaceState,
    cosine_means,
    face_field,
    face_means,
    face_state,
    step_face,
)
from ..thermal.impedance import Slab
from .heat import HeatStep
from .heat_rows import NEW_PATCH
from .mechanics import Mechanics
from .scene import TIPS
from .taxels import Taxels, checked_taxels
from .things import PAD, Thing

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
    the pad's horizontal axis, equal parts of the sensor's face. dt: s, a control step. Raises InvalidValueError for a
    shape that is none."""

    def __init__(self, shape: tuple[int, int], num_envs: int, stack: SensorStack, dt: float) -> None:
        self.shape = checked_taxels(shape, "face_temperature")
        self._stack, self._dt = stack, dt
        self._parts = tuple(cosine_means(side) for side in self.shape)
        self._pads = Taxels((PAD_POINTS, PAD_POINTS))
        self._on_face = _shares(stack.width)
        each = (num_envs, len(TIPS))
        fields, surface, contact = (np.zeros((*each, *part.shape)) for part in face_state())
        self._state = FaceTemperatureState(
            fields, surface, contact, np.zeros(each, bool), np.zeros(each, int)
        )
        self._things: list[tuple[Thing, ...]] = [()] * num_envs

    def reset(self, rows: Sequence[int], scenes: Sequence[Sequence[Thing]]) -> None:
        """The rows start with new objects, every face as warm as its thermostat."""
        for row, things in zip(rows, scenes, strict=True):
            self._things[row] = tuple(things)
            state = self._state
            state.fields[row] = state.surface[row] = state.owner[row] = 0
            state.contact[row], state.begun[row] = 1.0, False

    def rest(self, step: HeatStep) -> np.ndarray:
        """(B, F, n, m) °C where nothing has touched."""
        even = step.told["sensor_surface"][..., None, None]
        return np.broadcast_to(even, (*even.shape[:2], *self.shape)).copy()

    def step(self, mechanics: Mechanics, step: HeatStep, owner: np.ndarray | None = None) -> np.ndarray:
        """(B, F, n, m) °C at the end of the control step that mechanics and heat made last. owner: (B, F) the object
        that each fingertip's heat goes to, where there are several."""
        maps, told, state = self.rest(step), step.told, self._state
        owners = np.zeros_like(state.owner) if owner is None else owner
        flux = told["flow"] / self._stack.face_area
        begun = state.begun | (flux != 0.0)
        pressure = self._pads.pressure(mechanics, owners)
        renewed = (owners != state.owner) | ((told["events"] & NEW_PATCH) > 0)
        state.fields[renewed, 1] = 0.0  # the object's side
        state.begun[:], state.owner[:] = begun, owners
        cells = np.zeros((CELLS, CELLS))
        for row, tip in np.argwhere(begun).tolist():
            thing = self._things[row][owners[row, tip]]
            conducted = np.ascontiguousarray(self._on_face @ pressure[row, tip] @ self._on_face.T)
            _cell_conductance(thing.law, conducted, cells)
            face = FaceState(state.fields[row, tip], state.surface[row, tip], state.contact[row, tip])
            step_face(self._field(thing), cells, float(flux[row, tip]), *face)
            maps[row, tip] += face_means(face, *self._parts)
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
        self, rows: Sequence[int], state: FaceTemperatureState, scenes: Sequence[Sequence[Thing]]
    ) -> None:
        """Puts the rows into a state taken by `state`, with these objects."""
        self.reset(rows, scenes)
        chosen, mine = list(rows), self._state
        mine.fields[chosen], mine.surface[chosen] = state.fields, state.surface
        mine.contact[chosen], mine.begun[chosen] = state.contact, state.begun
        mine.owner[chosen] = state.owner

    def _field(self, thing: Thing) -> FaceField:
        made_of, thickness = thing.touched, thing.plate[2] / thing.fingertips
        behind = Slab(thickness, made_of.conductivity, made_of.volumetric_heat_capacity)
        return _field_of(self._stack, behind, self._dt)


@lru_cache(maxsize=64)
def _field_of(stack: SensorStack, behind: Slab, dt: float) -> FaceField:
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
def _cell_conductance(law, pressure, out):
    """Writes W/(m2 K) at pressures (N, N) Pa, 0 where there is nearly none: gas would conduct there as well."""
    least = _LEAST_PRESSURE * pressure.max()
    for i in range(pressure.shape[0]):
        for j in range(pressure.shape[1]):
            out[i, j] = conductance(law, pressure[i, j]) if pressure[i, j] > least else 0.0
