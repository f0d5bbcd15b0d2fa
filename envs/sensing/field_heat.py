"""Heat of grasps wherever fingertips touch, at each force: the fields of ThermalTouch, with or without a pad around the
sensor.

A box that is touched in the middle of its faces has a network of its own (heat.py), also with a pad. Here a
round body is a box of its volume and proportions, a mesh as it is, a fingertip touches them where it is, narrow
contacts spread their heat, and fingertips keep theirs as they go from object to object (touch/heat).

B: environments, O: objects, F: 1 or 2 fingertips with a sensor, N: heat samples of a control step.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...thermal.contact import FOOTPRINT_LAW
from ...touch.contacts import COLUMNS
from ...touch.heat import HeatState as FieldState
from ...touch.heat import JoinedHeat, sample, tell_books
from ...touch.pointers import entry, table
from ...touch.scene import BodyShape, PadPlace
from ..footprint import PAD, GraspBody, PadContact, mesh_steps, pad_contact
from .field_kernel import HEAT, LISTED, PARTS, advance_fields, tell_fields, tell_temperatures
from .heat import HeatStep
from .kernel import meet_rows
from .rows import HEAT_INFO, HEAT_ROW
from .scene_heat import SceneHeatStep, of_fingertips

_TIPS = ("left", "right")
_DISC, _BALL = math.sqrt(math.pi) / 2, (math.pi / 6) ** (1 / 3)
_BOXES = {
    "box": (1.0, 1.0, 1.0),
    "cylinder": (_DISC, _DISC, 1.0),
    "sphere": (_BALL, _BALL, _BALL),
    "mesh": (1.0, 1.0, 1.0),
}
"""Sides of the box that heat flows in, of the object's; a mesh's heat flows in itself."""

MOST_SPARES, MOST_SYSTEMS = 32, 64
"""Heats of objects that no environment holds any more, which are kept for its next episodes, and the groups of fields
that one of them may know."""


@dataclass(frozen=True, slots=True)
class FieldHeatState:
    """Everything that the heat of some environments remembers; picklable. rows: (n, O) HEAT_ROW records. scenes: each
    one's objects. fields: of each, what flows in it. owner: (n, 2) each fingertip's object."""

    rows: np.ndarray
    scenes: tuple[tuple[GraspBody, ...], ...]
    fields: tuple[FieldState, ...]
    owner: np.ndarray


@dataclass(slots=True)
class _Row:
    """An environment's heat. bodies: the objects, but for temperatures. contacts: of each as the pads close on it, and
    slipped: of those that have since the reset. touches: (N, 1, F, O + F, columns). telling: JoinedHeat.telling."""

    bodies: tuple[GraspBody, ...]
    heat: JoinedHeat
    contacts: list[PadContact]
    slipped: dict[int, PadContact]
    touches: np.ndarray
    telling: np.ndarray


class FieldScenes:
    """The thermal side of `num_envs` grasps with so many objects each, in T mode. Keywords as GraspHeat's."""

    def __init__(
        self,
        num_envs: int,
        objects: int,
        *,
        tolerance: float,
        air: float,
        dt: float,
        samples: int,
        sensor_temperature: float | tuple[float, float],
        cache: bool = True,
    ) -> None:
        self._cache, self._tolerance, self._film, self._dt, self._samples = cache, tolerance, air, dt, samples
        self._rows = np.zeros((num_envs, objects), HEAT_ROW)
        self._rows["sensor_temperature"] = sensor_temperature
        self._laws = np.zeros((num_envs, objects), FOOTPRINT_LAW)
        self._info = np.zeros((num_envs, objects), HEAT_INFO)
        self._info["reservoir_temperature"] = np.nan
        self._scenes: dict[int, tuple[GraspBody, ...]] = {}
        self._heats: dict[int, _Row] = {}
        self._spares: list[_Row] = []
        self._owner = np.zeros((num_envs, 2), int)
        # What compiled code takes (field_kernel.py): where the rows' heats are and what their pads meet.
        self._sample = entry(sample, 4)
        self._listed = np.zeros((num_envs, LISTED), np.int64)
        self._parts = np.zeros((num_envs, objects, PARTS), np.int64)
        self._ambient = np.zeros(num_envs)
        # J at the last step's end: from fingertips to objects, in elements and pads, in objects, to the air
        self._given, self._stored = np.zeros((num_envs, 2, objects)), np.zeros((num_envs, 2))
        self._gained, self._air = np.zeros((num_envs, objects)), np.zeros(num_envs)
        self._fed = np.zeros((num_envs, objects))  # J, from contents
        # Meshes, whose contact follows the place: where the pads closed, and how far they have gone.
        self._meshes: list[tuple[int, int]] = []
        self._closed = np.zeros((num_envs, objects, 4))
        self._steps = np.zeros((num_envs, objects, 5), np.int64)

    def reset(
        self,
        rows: Sequence[int],
        scenes: Sequence[Sequence[GraspBody]],
        sensor_temperatures: np.ndarray,
        *,
        waiting: bool = False,
    ) -> None:
        """The rows start with new objects, O each, everything at its first temperature. sensor_temperatures: (n, 2) °C
        of the thermostats. waiting: networks are made when they are touched anyway."""
        del waiting
        for row, scene, celsius in zip(rows, scenes, sensor_temperatures, strict=True):
            self._place(row, tuple(scene), celsius)
            self._owner[row] = 0
            for record, body in zip(self._rows[row], scene, strict=True):
                record["sensor_temperature"], record["difference"] = celsius, celsius - body.temperature
                record["element_capacity"] = body.stack.heat_capacity
                for name in ("offset", "stored", "known", "touching", "books"):
                    record[name] = 0

    def rung(self, row: int) -> tuple[str, ...]:
        """The model that computes each object's heat."""
        return (self._heats[row].heat.rung,) * self._rows.shape[1]

    def advance(self, force: np.ndarray, place: np.ndarray) -> SceneHeatStep:
        """One control step. force: (B, O, S, 2) N, normal, of each substep, 0 where apart. place: (B, O, 2, 3) m, the
        sensor faces' middles in each object's frame at the end of the step."""
        force, place = np.ascontiguousarray(force, float), np.ascontiguousarray(place, float)
        drop = np.zeros((len(force), self._samples, 2))
        if self._meshes:
            self._slip(force, place)
        meet_rows(self._laws, self._rows, force, place, self._info)
        self._own(force)
        arrays = self._sample, self._listed, self._parts, force, place, drop
        number, last = advance_fields(*arrays, 0), len(force) * self._samples
        while number < last:
            row, k = divmod(number, self._samples)
            one = self._heats[row]
            if one.heat.advance(one.touches[k], 1):
                self._list(row)
            drop[row, k, : one.heat.drop.shape[1]] = one.heat.drop[0]
            number = advance_fields(*arrays, number + 1)
        seconds = self._samples * self._dt
        books = self._given, self._stored, self._gained, self._air
        tell_fields(self._listed, self._rows, seconds, self._info, *books)
        tell_temperatures(self._listed, self._rows, self._ambient, self._samples, self._info)
        self._tell_contents(seconds)
        return self._step(drop)

    def rest(self) -> SceneHeatStep:
        """What a step would tell of a batch in which nothing has touched yet."""
        self._info[:] = np.zeros(1, HEAT_INFO)
        self._info["reservoir_temperature"] = np.nan
        tell_temperatures(self._listed, self._rows, self._ambient, self._samples, self._info)
        self._tell_contents()
        return self._step(np.zeros((len(self._rows), self._samples, 2)))

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, 2) °C of the thermostats from now on."""
        first = self._rows[:, 0]
        change = celsius - first["sensor_temperature"] - first["offset"]
        self._rows["offset"] += change[:, None]
        for row in np.flatnonzero(change.any(axis=1)).tolist():
            one = self._heats[row]
            one.heat.warm(change[row : row + 1, : one.bodies[0].fingertips])

    def state(self, rows: Sequence[int]) -> FieldHeatState:
        """A copy of what the rows remember."""
        chosen = list(rows)
        return FieldHeatState(
            self._rows[chosen],
            tuple(self._scenes[row] for row in chosen),
            tuple(self._heats[row].heat.state() for row in chosen),
            self._owner[chosen],
        )

    def set_state(self, rows: Sequence[int], state: FieldHeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        for k, row in enumerate(rows):
            first = state.rows[k, 0]
            self._place(row, state.scenes[k], first["sensor_temperature"] + first["offset"])
            self._rows[row], self._owner[row] = state.rows[k], state.owner[k]
            self._heats[row].heat.set_state(state.fields[k])
            self._list(row)
            books = self._given[row], self._stored[row], self._gained[row]
            self._air[row] = tell_books(self._listed[row, HEAT], *books)
            for inside in self._heats[row].heat.contents:
                self._fed[row, inside.object] = inside.given[0]

    def __setstate__(self, state: dict[str, Any]) -> None:
        """A copy, whose arrays are elsewhere."""
        self.__dict__.update(state)
        self._sample = entry(sample, 4)
        for row, one in self._heats.items():
            for o, closed in enumerate(one.contacts):
                self._meet(row, o, self._laws[row, o], one.slipped.get(o, closed))
            self._list(row)

    @property
    def sensor_temperatures(self) -> np.ndarray:
        """(B, 2) °C of the thermostats at the start."""
        return self._rows["sensor_temperature"][:, 0]

    def _place(self, row: int, scene: tuple[GraspBody, ...], celsius: np.ndarray) -> None:
        first = scene[0]
        ambient = first.temperature if first.ambient is None else first.ambient
        bodies = tuple(replace(body, temperature=0.0, ambient=None) for body in scene)
        free = [*self._spares, *([self._heats[row]] if row in self._heats else [])]
        free = [each for each in free if each.heat.systems <= MOST_SYSTEMS]
        one = next((each for each in free if each.bodies == bodies), None) or self._made(bodies)
        self._heats[row], self._spares = one, [each for each in free if each is not one][-MOST_SPARES:]
        one.heat.set_around(ambient, celsius[: first.fingertips])
        one.heat.reset([0], np.array([[body.temperature for body in scene]]))
        self._scenes[row], self._ambient[row] = scene, ambient
        self._given[row], self._stored[row], self._gained[row], self._air[row] = 0.0, 0.0, 0.0, 0.0
        self._fed[row] = 0.0
        self._info["reservoir_temperature"][row], self._info["reservoir_flow"][row] = np.nan, 0.0
        self._meshes = [each for each in self._meshes if each[0] != row]
        self._steps[row] = 0
        one.slipped.clear()
        for o, body in enumerate(one.bodies):
            self._meet(row, o, body.law, one.contacts[o])
            self._rows[row, o]["reach"] = body.stack.width / 2
            if body.closed_mesh is not None:
                self._meshes.append((row, o))
                self._closed[row, o] = body.closed_mesh.azimuth, *body.closed_mesh.place
        self._list(row)

    def _made(self, bodies: tuple[GraspBody, ...]) -> _Row:
        """A heat of such objects, which waits for a reset."""
        pads = [_pad(bodies[0], number) for number in range(bodies[0].fingertips)]
        heat = JoinedHeat(
            pads,
            (),
            [_shape(body) for body in bodies],
            worlds=1,
            dt=self._dt,
            tolerance=self._tolerance,
            film=self._film,
            ambient=0.0,
            cache=self._cache,
        )
        touches = np.zeros((self._samples, 1, len(pads), len(bodies) + len(pads), COLUMNS))
        return _Row(bodies, heat, [pad_contact(body) for body in bodies], {}, touches, np.zeros(0))

    def _meet(self, row: int, o: int, law: np.void, contact: PadContact) -> None:
        """The pads meet an object in this way from now on."""
        self._laws[row, o] = law
        self._parts[row, o] = table(contact, (len(contact.tables), len(contact.halves)))

    def _list(self, row: int) -> None:
        """Where the row's heat is from now on; to be called whenever anything but compiled code has changed it."""
        one = self._heats[row]
        one.telling = one.heat.telling()
        heard, _ = one.heat.hearing(one.touches)
        self._listed[row] = (
            one.telling.ctypes.data,
            heard,
            one.touches.ctypes.data,
            one.touches.shape[2],
        )

    def _tell_contents(self, seconds: float | None = None) -> None:
        """Fills what info tells of contents after a control step of so many seconds, or at rest, and puts them into
        the books."""
        for row, one in self._heats.items():
            for inside in one.heat.contents:
                step, o = self._info[row, inside.object], inside.object
                step["reservoir_temperature"] = inside.temperature[0]
                if seconds is None:
                    continue
                passed, self._fed[row, o] = inside.given[0] - self._fed[row, o], inside.given[0]
                step["reservoir_flow"] = passed / seconds
                books = self._rows[row, o]["books"]
                books[1] += abs(passed)
                step["exchanged"] = books[1]
                self._info[row, 0]["imbalance"] -= inside.given[0]

    def _slip(self, force: np.ndarray, place: np.ndarray) -> None:
        """What the pads touch of meshes that have slipped or turned between them."""
        rows, objects = np.array(self._meshes).T
        closed = self._closed[rows, objects]
        now = mesh_steps(place[rows, objects], closed[:, 0], closed[:, 1:])
        gone = (now != self._steps[rows, objects]).any(axis=1) & (force[rows, objects] > 0).any(axis=(1, 2))
        for k in np.flatnonzero(gone).tolist():
            row, o = self._meshes[k]
            step, one = tuple(now[k].tolist()), self._heats[row]
            self._steps[row, o] = now[k]
            contact = one.slipped[o] = pad_contact(one.bodies[o], step)
            self._meet(row, o, one.bodies[o].slipped_law(step), contact)

    def _own(self, force: np.ndarray) -> None:
        """Whose the fingertips are after forces (B, O, S, 2): of several objects, that of which they press hardest."""
        if force.shape[1] == 1:
            return
        substeps = force.shape[2]
        for k in range(self._samples):
            part = force[:, :, k * substeps // self._samples : -(-(k + 1) * substeps // self._samples)]
            most = part.max(axis=2)
            self._owner = np.where(most.max(axis=1) > 0, most.argmax(axis=1), self._owner)

    def _step(self, drop: np.ndarray) -> SceneHeatStep:
        objects, owner = self._info.copy(), self._owner.copy()
        alone = objects.shape[1] == 1
        info = objects[:, 0].copy() if alone else of_fingertips(objects, owner)
        return SceneHeatStep(HeatStep(drop, info), objects, owner)


class FieldHeat:
    """FieldScenes of one object each, with GraspHeat's methods."""

    def __init__(self, num_envs: int, **settings: Any) -> None:
        self._scenes = FieldScenes(num_envs, 1, **settings)

    def reset(
        self, rows: Sequence[int], bodies: Sequence[GraspBody], sensor_temperatures: np.ndarray | None = None
    ) -> None:
        """As GraspHeat's."""
        celsius = self.sensor_temperatures[list(rows)] if sensor_temperatures is None else sensor_temperatures
        self._scenes.reset(rows, [(body,) for body in bodies], celsius)

    def rung(self, row: int) -> str:
        """The model that computes an environment's heat."""
        return self._scenes.rung(row)[0]

    def advance(self, force: np.ndarray, place: np.ndarray) -> HeatStep:
        """One control step. force: (B, S, 2) N, normal, of each substep, 0 where apart. place: (B, 2, 3) m, the sensor
        faces' middles in the object's frame at the end of the step."""
        return self._scenes.advance(force[:, None], place[:, None]).fingertips

    def rest(self) -> HeatStep:
        """What a step would tell of a batch in which nothing has touched yet."""
        return self._scenes.rest().fingertips

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, 2) °C of the thermostats from now on."""
        self._scenes.set_thermostats(celsius)

    def state(self, rows: Sequence[int]) -> FieldHeatState:
        """A copy of what the rows remember."""
        return self._scenes.state(rows)

    def set_state(self, rows: Sequence[int], state: FieldHeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        self._scenes.set_state(rows, state)

    @property
    def sensor_temperatures(self) -> np.ndarray:
        """(B, 2) °C of the thermostats at the start."""
        return self._scenes.sensor_temperatures


def _pad(body: GraspBody, number: int) -> PadPlace:
    """A fingertip; where it is, contacts tell, and how warm, a reset."""
    return PadPlace(
        label=_TIPS[number],
        body=0,
        geoms=(),
        position=np.zeros(3),
        axes=np.eye(3),
        size=np.full(2, PAD.width),
        stack=body.stack,
        temperature=0.0,
        skin=body.skin,
        surround=body.surround,
    )


def _shape(body: GraspBody) -> BodyShape:
    """What an object is to its heat: a box of its volume and proportions, or a mesh as it is."""
    spec, extent = body.spec, np.array(body.spec.size)
    size = extent * _BOXES[spec.shape]
    return BodyShape(
        name=spec.name,
        body=0,
        geoms=(),
        material=body.material,
        temperature=body.temperature,
        size=size,
        centre=np.zeros(3),
        axes=np.eye(3),
        extent=extent,
        surface=spec.surface,
        contents=spec.reservoir,
        solid=body.solid if spec.mesh else None,
    )
