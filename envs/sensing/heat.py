"""Contact to heat: forces of every substep become conductances, patches and the fingertips' temperature drops.

B: environments, S: substeps, F = 2 fingertips, N: heat samples of a control step, K: states of the largest network.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...thermal import (
    Demand,
    free_area,
    shift_thermostats,
)
from ...thermal.batch import carry_matrix
from ...thermal.contact import FOOTPRINT_LAW
from ...thermal.matter import RESERVOIR_ROW
from ..footprint import GraspBody
from .boxes import BoxHeat
from .kernel import advance_boxes, advance_grasps
from .networks import HeatNetworks
from .places import Touched
from .rows import HEAT_ROW, RELEASE, events_of, heat_info

if TYPE_CHECKING:
    from ...thermal import SurfacePatch
    from .touches import Touches

CONDUCTANCES = (1e2, 1e3, 1e4, 1e5)  # W/(m2 K), over which a network must keep the tolerance
HORIZON = 20.0  # s of contact over which it must
LEAST_DIFFERENCE = 12.0  # K for which the tolerance is meant at least


@dataclass(frozen=True, slots=True)
class HeatState:
    """Everything that the heat of some environments remembers; picklable. rows: their HEAT_ROW records. state (n, K).
    bodies: each environment's object. places: where a box has been touched; the patches of another one that is touched
    anywhere, and each fingertip's; None for a plate."""

    rows: np.ndarray
    state: np.ndarray
    bodies: tuple[GraspBody, ...]
    places: tuple[Touched | tuple[tuple[SurfacePatch, ...], tuple[int, ...]] | None, ...]


class HeatStep(NamedTuple):
    """One control step. drop (B, N, F) K at the end of each heat sample. info (B,): HEAT_INFO records of

    conductance (B, F) W/(m2 K) and area (B, F) m2 of the contact: their product is the mean over the substeps; heat
    sees in each sample the mean of that sample's substeps. sensor_surface, object_surface (B, F) °C, means over the
    contact. object_temperature (B,) °C, the object's mean. heat (B, 3) J gained by left element, right element and
    object. flow (B, F) W into the object's side and air_loss (B,) W, the step's means. reservoir_temperature (B,) °C,
    nan where there is none, and reservoir_flow (B,) W into the object, the step's mean. drawn (B, F) W from the
    thermostats. over_temperature (B,): one of the thermostats has been too hot, and the heaters are off. imbalance (B,)
    J that the object's side gained beyond what flowed in less what the air took, and exchanged (B,) J, the flow's
    absolute sum, since the start.
    """

    drop: np.ndarray
    info: np.ndarray

    @property
    def events(self) -> np.ndarray:
        """(B,) of tuples of (kind, fingertip)."""
        return events_of(self.info["events"])


class GraspHeat:
    """The thermal side of `num_envs` grasps. tolerance: K. air: W/(m2 K) on the objects. dt: s, spacing of heat
    samples, `samples` of them in a control step. sensor_temperature: °C of the thermostats, one or
    each fingertip's. cache: keep networks on disk. least_sensor_states: of each fingertip (T mode), also where the
    tolerance needs fewer."""

    def __init__(
        self,
        num_envs: int,
        *,
        tolerance: float,
        air: float,
        dt: float,
        samples: int,
        sensor_temperature: float | tuple[float, float],
        cache: bool = True,
        least_sensor_states: int = 0,
    ) -> None:
        self._tolerance, self._air, self._samples = tolerance, air, samples
        self._sensor_temperature, self._cache = sensor_temperature, cache
        self._networks = HeatNetworks(
            dt, cache, least_sensor_states, lambda: set(self._rows["network"].tolist())
        )
        self._boxes = BoxHeat(num_envs, tolerance, dt)
        self._fingertips = 2
        # By row, once it has been reset.
        self._bodies: dict[int, GraspBody] = {}
        self._demands: dict[int, Demand] = {}
        self._films: dict[int, float] = {}
        self._touches: dict[int, Touches] = {}
        self._waiting: set[int] = set()
        self._boxed: set[int] = set()
        self._rows = np.zeros(num_envs, HEAT_ROW)
        self._laws = np.zeros(num_envs, FOOTPRINT_LAW)
        self._reservoirs = np.zeros(num_envs, RESERVOIR_ROW)
        self._state = np.zeros((num_envs, 0))
        # Meshes, whose contact follows the place: their rows, where the pads closed, and how far they have gone.
        self._meshes: list[int] = []
        self._closed = np.zeros((num_envs, 4))
        self._steps = np.zeros((num_envs, 5), np.int64)

    def reset(
        self,
        rows: Sequence[int],
        bodies: Sequence[GraspBody],
        sensor_temperatures: np.ndarray | None = None,
        *,
        waiting: Collection[int] = (),
    ) -> None:
        """The rows start with new objects, everything at its first temperature. sensor_temperatures: °C of each row's
        thermostats, (n, F), where they differ from the batch's. waiting: rows whose networks are made when something
        happens to them."""
        temperatures = np.broadcast_to(self._sensor_temperature, (len(rows), 2))
        if sensor_temperatures is not None:
            temperatures = sensor_temperatures
        for row, body, temperature in zip(rows, bodies, temperatures, strict=True):
            self._place(row, body, temperature)
            fresh = self._rows[row]
            fresh["sensor_temperature"] = temperature
            fresh["difference"] = temperature - body.temperature
            fresh["known"] = body.mode == "O"
            fresh["anchor"] = body.spec.element_places
            for name in ("offset", "stored", "touching", "books"):
                fresh[name] = 0
            fresh["begun"] = body.spec.reservoir is not None or fresh["ambient"] != 0
            if body.spec.reservoir is not None:
                fresh["enthalpy"] = body.spec.reservoir.row(body.temperature)[1]
            if fresh["boxed"] or row not in waiting or fresh["begun"]:
                self._build(row)
        begun = [row for row in rows if self._rows[row]["boxed"] and self._rows[row]["begun"]]
        if begun:
            self._boxes.wait(begun, self._state)

    def rung(self, row: int) -> str:
        """The model that computes an environment's heat."""
        if row in self._waiting:
            return ""
        record = self._rows[row]
        return self._boxes.rung if record["boxed"] else self._networks.rungs[record["network"]]

    def advance(
        self, force: np.ndarray, place: np.ndarray, carried: Sequence[tuple[int, int, int, int]] = ()
    ) -> HeatStep:
        """One control step. force: (B, S, F) N, normal, of each substep, 0 where apart. place: (B, F, 3) m, the
        sensor faces' middles in the object's frame at the end of the step. carried: (sample, source, target,
        fingertip) of fields that go from one row to another as that sample begins, as in carry."""
        if self._waiting:
            for row in [row for row in self._waiting if force[row].any()]:
                self._build(row)
        if self._meshes:
            self._slip(force, place)
        moved = self._moved(force, place) if self._touches else []
        drop, info = np.empty((len(force), self._samples, 2)), heat_info(len(force))
        normal, middles = np.ascontiguousarray(force, dtype=float), np.ascontiguousarray(place, dtype=float)
        boxed = len(self._boxed)
        strayed = self._boxes.strayed(normal, middles, self._samples) if boxed else []
        changes = (*strayed, *carried, *moved)
        starts = sorted({0, *(sample for sample, *_ in changes)}) if changes else (0,)
        for first, last in pairwise((*starts, self._samples)):
            now = [(row, tips) for sample, row, tips in strayed if sample == first]
            if now:
                self._boxes.settle(now, middles, self._state)
            for sample, source, target, tip in carried:
                if sample == first:
                    self._leave(info, sample, source, tip)
                    self.carry(source, target, tip)
            for sample, row, tip in moved:
                if sample == first:
                    self._touch(row, self._touches[row].moved(tip, place[row, tip]))
            step = (normal, middles, drop, info, first, last)
            if boxed < len(drop):
                tables = self._networks.tables(self._fingertips)
                advance_grasps(self._laws, self._reservoirs, self._rows, self._state, *step, *tables)
            if boxed:
                advance_boxes(self._laws, self._rows, self._state, *step, *self._boxes.tables)
        return HeatStep(drop, info)

    def rest(self) -> HeatStep:
        """What a step would tell of a batch in which nothing has touched yet."""
        info = heat_info(len(self._rows))
        info["sensor_surface"] = self._rows["sensor_temperature"] + self._rows["offset"]
        info["object_surface"] = info["sensor_surface"] - self._rows["difference"]
        info["object_temperature"] = info["object_surface"][:, 0]
        info["reservoir_temperature"] = np.where(
            self._reservoirs["conductance"] > 0, self._reservoirs["temperature"], np.nan
        )
        return HeatStep(np.zeros((len(self._rows), self._samples, 2)), info)

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, F) °C of the thermostats from now on."""
        change = celsius - self._rows["sensor_temperature"] - self._rows["offset"]
        self._rows["offset"] += change
        tips, boxed = self._fingertips, self._rows["boxed"] > 0
        plates = np.flatnonzero(~boxed)
        if len(plates) and self._networks.systems:
            shifted, _ = shift_thermostats(
                self._networks.tables(tips),
                self._rows["network"][plates],
                self._state[plates, : self._networks.states],
                self._rows["difference"][plates, :tips],
                change[plates, :tips],
            )
            self._state[plates, : self._networks.states] = shifted
        if boxed.any():
            self._boxes.shift(np.flatnonzero(boxed), self._state, change)
        self._rows["difference"][:, :tips] += change[:, :tips]

    def carry(self, source: int, target: int, fingertip: int) -> None:
        """The fingertip's field goes from one row to another, whose object it touches from now on. The source's
        fingertip is left as warm as its thermostat. Raises InvalidValueError in O mode."""
        if target in self._waiting:
            self._build(target)
        old, new = self._rows[source], self._rows[target]
        before, after = (self._of_tip(row, fingertip) for row in (source, target))
        if old["boxed"] and new["boxed"]:
            self._boxes.carry(source, target, fingertip, self._state)
        else:
            if old["boxed"] or new["boxed"]:
                rows = (
                    self._boxes.tip_rows(row, fingertip)
                    if self._rows["boxed"][row]
                    else self._networks.tip_rows(int(self._rows["network"][row]))
                    for row in (source, target)
                )
                matrix = carry_matrix(*rows)
            else:
                matrix = self._networks.carried(int(old["network"]), int(new["network"]))
            # Row by row, so that rounding does not depend on what else the batch holds.
            self._state[target, after] = (matrix * self._state[source, before]).sum(axis=1)
        self._state[source, before] = 0.0
        new["stored"][fingertip], old["stored"][fingertip] = old["stored"][fingertip], 0.0

    def _of_tip(self, row: int, fingertip: int) -> slice:
        """Where the fingertip's own states are in the row's."""
        if self._rows["boxed"][row]:
            return self._boxes.fingertip(fingertip)
        return self._networks.fingertip(int(self._rows["network"][row]), fingertip)

    def state(self, rows: Sequence[int]) -> HeatState:
        """A copy of what the rows remember."""
        chosen = list(rows)
        bodies = tuple(self._bodies[row] for row in chosen)
        places = tuple(self._places(row) for row in chosen)
        return HeatState(self._rows[chosen], self._state[chosen], bodies, places)

    def _places(self, row: int) -> Touched | tuple[tuple[SurfacePatch, ...], tuple[int, ...]] | None:
        if self._rows["boxed"][row]:
            return self._boxes.touched(row)
        touches = self._touches.get(row)
        return (touches.body.patches, touches.contacts) if touches else None

    def set_state(self, rows: Sequence[int], state: HeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        touched: dict[int, Touched] = {}
        for k, row in enumerate(rows):
            self._place(row, state.bodies[k], state.rows["sensor_temperature"][k])
            self._build(row)
            places = state.places[k]
            if isinstance(places, Touched):
                touched[row] = places
            elif places is not None:
                self._touches[row] = self._touches[row].at(*places)
                self._rows["network"][row] = self._number(row)
            network = self._rows["network"][row]  # this batch's own number of it
            self._rows[row] = state.rows[k]
            self._rows["network"][row] = network
            width = min(state.state.shape[1], self._state.shape[1])
            self._state[row] = 0.0
            self._state[row, :width] = state.state[k, :width]
        self._boxes.set_touched(touched)

    @property
    def sensor_temperatures(self) -> np.ndarray:
        """(B, F) °C of the thermostats at the start."""
        return self._rows["sensor_temperature"]

    def _place(self, row: int, body: GraspBody, sensor_temperature: np.ndarray) -> None:
        self._bodies[row] = body
        self._laws[row] = body.law
        self._steps[row] = 0
        mesh = body.closed_mesh
        if mesh is not None:
            self._closed[row] = mesh.azimuth, *mesh.place
        if (mesh is not None) != (row in self._meshes):
            self._meshes = sorted({*self._meshes} ^ {row})
        self._touches.pop(row, None)
        inside = body.spec.reservoir
        self._reservoirs[row] = np.zeros(1, RESERVOIR_ROW)[0]
        if inside is not None:
            self._reservoirs[row] = inside.row(body.temperature)[0]
        celsius = {body.temperature}
        if self._air and body.ambient is not None:
            celsius.add(body.ambient)
        if inside is not None:
            celsius.add(float(self._reservoirs["temperature"][row]))
        # In steps, so that nearly equal temperatures share a network.
        above = float(max(np.abs(sensor_temperature - each).max() for each in celsius))
        self._boxed.discard(row)
        if self._boxes.serves(body, above):
            self._boxed.add(row)
        self._rows["boxed"][row] = row in self._boxed
        above /= LEAST_DIFFERENCE
        difference = LEAST_DIFFERENCE * 1.25 ** max(np.ceil(np.log(max(above, 1e-9)) / np.log(1.25)), 0.0)
        demand = self._tolerance, difference, CONDUCTANCES, HORIZON
        self._demands[row] = Demand(*demand, beside=body.pad_conductance)
        self._waiting.add(row)
        record = self._rows[row]
        record["glued"] = body.mode == "O"
        record["reach"] = body.stack.width / 2
        record["element_capacity"] = body.stack.heat_capacity
        record["pad"] = 0.0 if body.surround is None else body.surround.width / 2
        record["pad_law"] = body.pad_law
        record["ambient"] = 0.0 if body.ambient is None or self._air == 0 else body.ambient - body.temperature

    def _build(self, row: int) -> None:
        """Makes the row's network, all at its first temperature."""
        self._waiting.discard(row)
        self._state[row] = 0.0
        self._fingertips = self._bodies[row].fingertips
        if self._rows["boxed"][row]:
            self._box(row)
            return
        self._boxes.stop(row)
        body, demand = self._bodies[row], self._demands[row]
        geometry, capacity = body.geometry, body.heat_capacity
        touches = None
        if body.solid is not None:
            from .touches import first_touches  # with what makes networks of meshes

            touches = first_touches(body, demand, self._cache)
        if touches is not None:
            self._touches[row] = touches
            geometry = touches.body.geometry
            capacity = geometry.whole_capacity
        free = free_area(geometry)
        record = self._rows[row]
        record["lasting"] = touches is not None
        record["capacity"] = capacity
        record["air"] = self._air * free
        record["fed"] = touches is not None and touches.fed
        # What the object gives to the air and to a reservoir at its mean, as one film of that many W/(m2 K).
        inside = 0.0 if record["fed"] else float(self._reservoirs["conductance"][row])
        self._films[row] = self._air + inside / free
        record["network"] = self._number(row)

    def _box(self, row: int) -> None:
        """The row is a box, all at its first temperature and touched nowhere yet."""
        body, record = self._bodies[row], self._rows[row]
        self._boxes.start(row, body, self._air)
        record["lasting"], record["fed"], record["network"] = body.anywhere, 0, 0
        record["capacity"] = body.box_capacity
        self._make_room()

    def _number(self, row: int) -> int:
        """Number of the row's network."""
        film, touches = self._films[row], self._touches.get(row)
        if touches is None:
            number = self._networks.of_plate(self._bodies[row].geometry, self._demands[row], film)
        else:
            number = self._networks.of_touches(touches, film, float(self._rows["air"][row]))
        self._make_room()
        return number

    def _make_room(self) -> None:
        """States are as many as those of the largest row."""
        states, last = max(self._networks.states, self._boxes.tables.states), self._state.shape[1]
        if states != last:
            kept = np.zeros((len(self._state), states))
            kept[:, :last] = self._state[:, :states]
            self._state = kept

    def _leave(self, info: np.ndarray, sample: int, row: int, fingertip: int) -> None:
        """Notes that the fingertip leaves the row's object for another one within a step."""
        if sample > 0 and self._rows["touching"][row, fingertip]:
            self._rows["touching"][row, fingertip] = 0
            info["events"][row, fingertip] |= RELEASE

    def _slip(self, force: np.ndarray, place: np.ndarray) -> None:
        """What the pads touch of meshes that have slipped or turned between them."""
        from ..footprint import mesh_steps  # nothing that meshes need is loaded without them

        rows = np.array(self._meshes)
        now = mesh_steps(place[rows], self._closed[rows, 0], self._closed[rows, 1:])
        gone = (now != self._steps[rows]).any(axis=1) & (force[rows] > 0).any(axis=(1, 2))
        for k in np.flatnonzero(gone).tolist():
            row = int(rows[k])
            self._steps[row] = now[k]
            self._laws[row] = self._bodies[row].slipped_law(tuple(now[k].tolist()))

    def _moved(self, force: np.ndarray, place: np.ndarray) -> list[tuple[int, int, int]]:
        """(sample, row, fingertip) of those that begin to touch where they have not been since they were there last."""
        rows = np.array(list(self._touches))
        record = self._rows[rows]
        away = np.sqrt(((place[rows] - record["anchor"]) ** 2).sum(axis=2))
        elsewhere = (away > record["reach"][:, None]) | (record["known"] == 0)
        pressed = force[rows] > 0
        settling = elsewhere & pressed.any(axis=1)
        sample = pressed.argmax(axis=1) * self._samples // force.shape[1]
        tips = np.argwhere(settling[:, : self._fingertips]).tolist()
        return [(int(sample[k, tip]), int(rows[k]), tip) for k, tip in tips]

    def _touch(self, row: int, touches: Touches) -> None:
        """The row's object is touched there from now on, and keeps its field."""
        last, self._touches[row] = self._touches[row], touches
        old = int(self._rows["network"][row])
        self._rows["network"][row] = new = self._number(row)
        if last.body is touches.body:
            return
        before = self._state[row].copy()
        self._state[row] = 0.0
        # Row by row, so that rounding does not depend on what else the batch holds.
        field = self._networks.field_carried(old, new, touches.field_from(last))
        self._state[row, : len(field)] = (field * before[: field.shape[1]]).sum(axis=1)
        matrix = self._networks.carried(old, new)
        for tip in range(len(touches.contacts)):
            source, target = (self._networks.fingertip(number, tip) for number in (old, new))
            self._state[row, target] = (matrix * before[source]).sum(axis=1)
