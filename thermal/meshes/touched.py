"""An object of any shape and where fingertips touch it: one network of all its patches, a contact system of any two.

A fingertip that goes from one patch to another sees other ports of the same states, so that nothing is forgotten. A
patch that is added changes the states; field_carried takes the object's field along.

P: patches, M: heat-flow patterns of each, F: fingertips, K: states of the object.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.files import cached_arrays

from ..matter import Material, SensorStack
from ..network import (
    CONDUCTANCES,
    MOMENTS,
    NODE,
    ContactSystem,
    Demand,
    ThermalNetwork,
    excited_states,
    responses,
    sample_geometry,
    state_bases,
    with_sensors,
)
from ..plates import Geometry
from ..surfaces import Solid, SurfacePatch, cross, twice_areas
from .network import body_network, conducting_parts
from .patch import learned_patterns
from .place import place_patch

PLATE = (0.04, 0.04, 0.01)  # m, on which a sensor's states and flux patterns are learned
PLATE_MATERIAL = Material("glass", 1.0, 2500.0, 840.0)
_COARSE = (
    0.08  # K of tolerance per 12 K of difference from which on two patterns of flux serve in place of three
)
_CUTS = np.geomspace(0.1, 1e-7, 25)  # weight below which states are left out
_LEAST_WEIGHT = 1e-7  # singular values below that share of the largest are left out
_LEAST_PORT = 0.03  # of the largest, below which a combination of flows is hardly seen
_TIMES = np.concatenate(([0.0], np.geomspace(1e-3, 300.0, 40)))  # s, over which a field is followed


@dataclass(frozen=True, slots=True)
class BodyGeometry(Geometry):
    """Fingertips on a body of any shape. body_capacity: J/K. body_surface: m2. The plate in the other fields is the one
    that the sensors' states and flux patterns were learned on."""

    body_capacity: float = np.nan
    body_surface: float = np.nan

    @property
    def whole_capacity(self) -> float:
        """J/K of the whole object."""
        return self.body_capacity

    @property
    def surface(self) -> float:
        """m2 of the whole object's surface."""
        return self.body_surface


@dataclass(frozen=True, slots=True, eq=False)
class TouchedBody:
    """A body of any shape with the networks of its patches. geometry: what it remembers of fingertips and object.
    sensor: a fingertip's network. object: the object's, M ports a patch, its state 0 the mean. patches, and centres (P,
    3) m: where on the surface they are. error: K of temperature drop that its fewer states were measured to be off, in
    the demand's cases, from all of the grid's. shared: of the object's states, the first ones that are the body's own
    modes, whatever its patches."""

    geometry: BodyGeometry
    sensor: ThermalNetwork
    object: ThermalNetwork
    patches: tuple[SurfacePatch, ...]
    centres: np.ndarray
    error: float
    shared: int = 0

    @property
    def modes(self) -> int:
        """M."""
        return self.sensor.ports.shape[1]

    def system(self, contacts: Sequence[int]) -> ContactSystem:
        """The system of a fingertip on each of these patches. Raises InvalidValueError where they are not F of them."""
        count, patches = self.geometry.fingertips, len(self.patches)
        if len(contacts) != count or not all(0 <= c < patches for c in contacts):
            raise InvalidValueError(f"contacts {tuple(contacts)}: give {count} of 0 .. {patches - 1}")
        ports = self.object.ports.reshape(self.object.order, patches, self.modes)
        touched = np.ascontiguousarray(ports[:, list(contacts)].transpose(1, 0, 2))
        orders = (self.object.order, None if count == 1 else 0)
        heat = self.object.outputs["heat"]
        return with_sensors(self.geometry, self.sensor, self.object.rates, touched, heat, orders)

    @property
    def hollow(self) -> bool:
        """Whether there is a wall that contents wet."""
        return "wet" in self.object.outputs

    def filled(self, film: float, air: float) -> FilledBody:
        """In air, with contents behind a film on the walls of its hollow, W/K each in all."""
        rows, order = self.object.outputs, self.object.order
        wet = np.stack([row for name, row in rows.items() if name.startswith("film:")])
        walls = wet.T @ wet
        # The walls' mean as the squares have it, so that what is as warm as its contents is at rest to round-off.
        mean = walls[:, 0] * rows["heat"][0]
        matrix = np.zeros((order + 1, order + 1))
        matrix[:order, :order] = np.diag(self.object.rates) + film * walls
        matrix[:order, :order] += air * np.outer(rows["mean"], rows["mean"])
        matrix[order, :order] = matrix[:order, order] = -film * mean / np.sqrt(NODE)
        matrix[order, order] = film * mean[0] * rows["heat"][0] / NODE
        rates, turn = np.linalg.eigh(matrix)
        lost = air * turn[:order].T @ rows["mean"]
        return FilledBody(self, np.maximum(rates, 0.0), turn, lost, np.sqrt(NODE) * turn[order])


@dataclass(frozen=True, slots=True, eq=False)
class FilledBody:
    """A touched body whose walls feed a node of NODE J/K that stands for contents of any heat capacity: what steps it
    sets the node's temperature before each step. rates: (K + 1,) 1/s. turn: (K + 1, K + 1), the body's states and the
    node's from its own. air_loss: (K + 1,) W. reservoir: (K + 1,) J of the node."""

    body: TouchedBody
    rates: np.ndarray
    turn: np.ndarray
    air_loss: np.ndarray
    reservoir: np.ndarray

    def system(self, contacts: Sequence[int]) -> ContactSystem:
        """As TouchedBody's."""
        empty, order = self.body.system(contacts), self.body.object.order
        ports = np.concatenate((self.turn[:order].T @ empty.ports[:order], empty.ports[order:]))

        def turned(rows: np.ndarray) -> np.ndarray:
            return np.concatenate((rows[..., :order] @ self.turn[:order], rows[..., order:]), axis=-1)

        def on_object(row: np.ndarray) -> np.ndarray:
            return np.concatenate((row, np.zeros(len(empty.rates) - order)))

        return replace(
            empty,
            orders=replace(empty.orders, even=order + 1),
            rates=np.concatenate((self.rates, empty.rates[order:])),
            ports=ports,
            drop=turned(empty.drop),
            element_heat=turned(empty.element_heat),
            object_heat=turned(empty.object_heat),
            sensor_surface=turned(empty.sensor_surface),
            object_surface=turned(empty.object_surface),
            air_loss=on_object(self.air_loss),
            reservoir=on_object(self.reservoir),
        )


def touched_body(
    body: Solid,
    patches: Sequence[SurfacePatch],
    stack: SensorStack,
    demand: Demand,
    *,
    fingertips: int = 2,
    cache: bool = True,
) -> TouchedBody:
    """An object without contents and its patches, of one area, with as few states as keep half the demand's tolerance
    where the fingertips are on the last of the patches; the other half is the grid's and the patterns'.

    Raises InvalidValueError for other patches, MeshError as body_network does."""
    patches = tuple(patches)
    area = patches[0].area
    modes = 2 if demand.tolerance >= _COARSE * abs(demand.difference) / 12 else 3
    plate = Geometry(stack, PLATE_MATERIAL, "T", area, "square", PLATE)
    key = {
        "body": conducting_parts(body),
        "patches": patches,
        "stack": stack,
        "demand": demand,
        "fingertips": fingertips,
    }

    def build() -> dict[str, np.ndarray]:
        patterns = learned_patterns(plate, modes)
        whole = body_network(body, patches, patterns=patterns, cache=False)
        learned = sample_geometry(plate).networks(modes)
        basis = state_bases(learned, area)["sensor"]
        geometry = geometry_of(plate, whole, body, fingertips)
        centres = np.array([place_patch(body.outside, patch, np.eye(3)).centre for patch in patches])
        full = TouchedBody(geometry, learned["sensor"], whole, patches, centres, 0.0)
        reduced = _smallest(full, basis.vectors, basis.weights, demand)
        shared = {"centres": centres, "error": np.array(reduced.error)}
        return {**_pack("sensor", reduced.sensor), **_pack("object", reduced.object), **shared}

    arrays = cached_arrays(key, build, enabled=cache)
    sensor, whole = _unpack("sensor", arrays), _unpack("object", arrays)
    geometry = geometry_of(plate, whole, body, fingertips)
    return TouchedBody(geometry, sensor, whole, patches, arrays["centres"], float(arrays["error"]))


def surface_normal(body: Solid, place: np.ndarray) -> np.ndarray:
    """(3,) outward normal of the face nearest to a place (3,) m."""
    return nearest_surface(body.outside, place)[1]


def nearest_surface(triangles: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The point (3,) m of triangles (F, 3, 3) m that is nearest to a place (3,) m, and their normal (3,) there."""
    a = triangles[:, 0]
    normals = twice_areas(triangles)
    areas = np.linalg.norm(normals, axis=1)
    faces = areas > 0
    normals = normals[faces] / areas[faces, None]
    above = np.einsum("fc,fc->f", place - a[faces], normals)
    # beside a face its nearest point is on an edge
    foot = place - above[:, None] * normals
    inside = np.ones(len(foot), bool)
    nearest, at = np.full(len(foot), np.inf), foot.copy()
    for i in range(3):
        start, end = triangles[faces, i], triangles[faces, (i + 1) % 3]
        edge = end - start
        inside &= np.einsum("fc,fc->f", cross(edge, foot - start), normals) >= 0
        share = np.einsum("fc,fc->f", place - start, edge) / np.einsum("fc,fc->f", edge, edge)
        on_edge = start + np.clip(share, 0.0, 1.0)[:, None] * edge
        away = np.linalg.norm(place - on_edge, axis=1)
        closer = away < nearest
        nearest[closer], at[closer] = away[closer], on_edge[closer]
    found = int(np.argmin(np.where(inside, np.abs(above), nearest)))
    return foot[found] if inside[found] else at[found], normals[found]


def field_carried(source: TouchedBody, target: TouchedBody) -> np.ndarray:
    """(K of target, K of source): the object's field on the states of a network of patches that both have, and others.

    What heat has done that came in through common patches is known on either side: the fields that pulses of heat leave
    at _TIMES after them are mapped on each other by least squares, and any field that was made through these patches is
    a sum of such. The object's heat stays the same to round-off, since its mean is a state of its own."""
    common = [patch for patch in source.patches if patch in target.patches]
    if source.shared and source.shared == target.shared:
        return _by_rates(source, target, common)
    before, after = (_pulses(each, common) for each in (source, target))
    left, weights, right = np.linalg.svd(before, full_matrices=False)
    kept = weights > _LEAST_WEIGHT * weights.max(initial=0.0)
    carried = np.zeros((target.object.order, source.object.order))
    carried[1:, 1:] = (after @ right[kept].T / weights[kept]) @ left[:, kept].T
    carried[0, 0] = 1.0
    return carried


def _by_rates(source: TouchedBody, target: TouchedBody, common: list[SurfacePatch]) -> np.ndarray:
    """field_carried's between networks whose slow modes are the body's, which stay, and of which the others fade at the
    same rates: such a state is what has flowed through the patches, as it has faded, by its ports."""
    carried = np.zeros((target.object.order, source.object.order))
    carried[: source.shared, : source.shared] = np.eye(source.shared)
    before, after = (
        each.object.ports.reshape(each.object.order, len(each.patches), each.modes)[
            :, [each.patches.index(patch) for patch in common]
        ].reshape(each.object.order, -1)
        for each in (source, target)
    )
    old, new = (np.arange(each.object.order) >= each.shared for each in (source, target))
    for rate in np.unique(source.object.rates[source.shared :]):
        was, now = old & (source.object.rates == rate), new & (target.object.rates == rate)
        carried[np.ix_(now, was)] = after[now] @ np.linalg.pinv(before[was], rcond=_LEAST_PORT)
    return carried


def _pulses(body: TouchedBody, common: list[SurfacePatch]) -> np.ndarray:
    """(K - 1, pulses): fields after a joule let in through each pattern of the common patches, each of them weighted by
    the time that it stays."""
    ports = body.object.ports.reshape(body.object.order, len(body.patches), body.modes)
    chosen = ports[1:, [body.patches.index(patch) for patch in common]].reshape(body.object.order - 1, -1)
    faded = np.exp(-np.outer(body.object.rates[1:], _TIMES)) * np.sqrt(np.maximum(_TIMES, _TIMES[1]))
    return (chosen[:, :, None] * faded[:, None, :]).reshape(len(chosen), -1)


def geometry_of(plate: Geometry, whole: ThermalNetwork, body: Solid, fingertips: int) -> BodyGeometry:
    """What a contact system keeps of a body. plate: the one that its sensors were learned on. whole: its network."""
    capacity = float(whole.outputs["heat"][0] ** 2)
    return BodyGeometry(
        plate.stack,
        plate.material,
        "T",
        plate.area,
        "square",
        plate.object_size,
        2 if fingertips == 2 else 1,
        capacity,
        body.surface,
    )


def _smallest(full: TouchedBody, sensor: np.ndarray, weights: np.ndarray, demand: Demand) -> TouchedBody:
    """The first that keeps the tolerance, or else the full one, for a tolerance may be near to what rounding leaves of
    the responses. sensor: (states, R) basis of its field, and weights (R,)."""
    basis = excited_states(full.object, _flows(full))
    last = range(len(full.patches) - full.geometry.fingertips, len(full.patches))

    def answer(body: TouchedBody) -> np.ndarray:
        return responses(body.system(last), demand)

    reference = answer(full)
    for cut in _CUTS:
        smaller = TouchedBody(
            full.geometry,
            full.sensor.projected(sensor[:, weights > cut / 8]),
            full.object.projected(basis.vectors[:, basis.weights > cut]),
            full.patches,
            full.centres,
            0.0,
        )
        error = float(np.max(np.abs(answer(smaller) - reference)))
        if error <= demand.tolerance / 2:
            return replace(smaller, error=error)
    return full


def _flows(full: TouchedBody) -> np.ndarray:
    """(cases, moments, P M) W: heat flows of one and of two fingertips on any of the patches."""
    modes, area = full.modes, full.geometry.area
    z_object, z_sensor = full.object.impedance(MOMENTS), full.sensor.impedance(MOMENTS)
    flows = []
    for conductance in CONDUCTANCES:
        for count in range(1, full.geometry.fingertips + 1):
            for touching in combinations(range(len(full.patches)), count):
                at = np.concatenate([np.arange(modes) + f * modes for f in touching])
                z = z_object[:, at[:, None], at] + np.kron(np.eye(count), z_sensor)
                drive = np.tile(np.eye(modes)[0], count)
                flow = np.zeros((len(MOMENTS), z_object.shape[1]))
                flow[:, at] = np.linalg.solve(z + np.eye(len(at)) / (conductance * area), drive)
                flows.append(flow)
    return np.array(flows)


def _pack(name: str, network: ThermalNetwork) -> dict[str, np.ndarray]:
    rows = {f"{name} output {key}": row for key, row in network.outputs.items()}
    return {f"{name} rates": network.rates, f"{name} ports": network.ports, **rows}


def _unpack(name: str, arrays: dict[str, np.ndarray]) -> ThermalNetwork:
    rates, ports = arrays[f"{name} rates"], arrays[f"{name} ports"]
    start = f"{name} output "
    rows = {key.removeprefix(start): row for key, row in arrays.items() if key.startswith(start)}
    return ThermalNetwork(rates, ports, np.zeros((ports.shape[1],) * 2), rows)
