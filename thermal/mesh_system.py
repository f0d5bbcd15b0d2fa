"""Fingertips and an object of any shape between them as one system of contacts, of the fewest states that serve.

Mode T. The object's network has every state of its grid's reduction; those that contacts excite are kept (states.py).

F: fingertips, M: modes of one contact, S: moments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal, cast

import numpy as np

from thermograsp.errors import InvalidValueError

from .bodies import Geometry
from .choice import Demand, responses
from .layers import SensorStack
from .materials import Material
from .mesh_grid import MeshGridding
from .mesh_network import body_network
from .mesh_patterns import learned_patterns
from .mesh_solid import Solid, SurfacePatch, surface_patches
from .network import ThermalNetwork
from .states import CONDUCTANCES, MOMENTS, StateBasis, excited_states, state_bases
from .system import ContactSystem, sample_geometry, with_sensors

PLATE = (0.04, 0.04, 0.01)  # m, on which a sensor's states and flux patterns are learned
PLATE_MATERIAL = Material("glass", 1.0, 2500.0, 840.0)
GRID_ERROR = 1e-3
"""Of the first difference, what the grid adds to the temperature drop: 0.0116 K of 12 K at most on plates of ten
materials, 1e3 to 1e5 W/(m2 K), against the semi-analytic rung."""
_CUTS = np.geomspace(0.1, 1e-7, 25)  # weight below which states are left out


@dataclass(frozen=True, slots=True)
class BodyGeometry(Geometry):
    """What a system remembers of a body. body_capacity: J/K. body_surface: m2. The plate in its other fields is the one
    that its sensors were learned on."""

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


@dataclass(frozen=True, slots=True)
class PressedBody:
    """system: fingertips and object. error: K of temperature drop that its reduction costs at most; the grid's own is
    not in it."""

    system: ContactSystem
    error: float


def pressed_body(
    body: Solid,
    patches: Sequence[SurfacePatch],
    stack: SensorStack,
    demand: Demand,
    *,
    modes: int = 3,
    gridding: MeshGridding | None = None,
    cache: bool = True,
) -> PressedBody:
    """One fingertip on each of one or two patches of the same area. modes: flux patterns of each contact.

    Raises InvalidValueError for other patches and where no system keeps the demand's tolerance, MeshError as
    body_network does.
    """
    patches = surface_patches(patches)
    area, *others = {patch.area for patch in patches}
    if len(patches) > 2 or others:
        raise InvalidValueError("one or two patches of the same area carry fingertips")
    if area > stack.face_area * (1 + 1e-9):
        raise InvalidValueError(
            f"area {area:g} m2 is more than the face of sensor {stack.name!r}, {stack.face_area:g} m2: "
            "give at most that"
        )
    fingertips = cast(Literal[1, 2], len(patches))
    plate = Geometry(stack, PLATE_MATERIAL, "T", area, "square", PLATE)
    patterns = learned_patterns(plate, modes)
    network = body_network(body, patches, patterns=patterns, gridding=gridding, cache=cache)
    samples = sample_geometry(plate).networks(modes)
    sensor, sensor_basis = samples["sensor"], state_bases(samples, area)["sensor"]
    capacity = (network.outputs["heat"][0]) ** 2
    geometry = BodyGeometry(
        stack, PLATE_MATERIAL, "T", area, "square", PLATE, fingertips, capacity, body.surface
    )
    basis = _object_basis(network, sensor, area, fingertips)

    def joined(sensor: ThermalNetwork, network: ThermalNetwork) -> ContactSystem:
        touched = network.ports.reshape(network.order, fingertips, modes).transpose(1, 0, 2)
        return with_sensors(
            geometry, sensor, network.rates, touched, network.outputs["heat"], (network.order, None)
        )

    reference = responses(joined(sensor, network), demand)
    error = np.inf
    for cut in _CUTS:
        system = joined(
            sensor.projected(_leading(sensor_basis, cut / 8)), network.projected(_leading(basis, cut))
        )
        error = float(np.max(np.abs(responses(system, demand) - reference)))
        if error <= demand.tolerance:
            return PressedBody(system, error)
    raise InvalidValueError(
        f"no network keeps {demand.tolerance:g} K for this contact; the best misses {error:.2g} K: "
        "ask for a larger tolerance"
    )


def _leading(basis: StateBasis, cut: float) -> np.ndarray:
    """The states that are excited more than a share of the most."""
    return basis.vectors[:, basis.weights > cut]


def _object_basis(
    network: ThermalNetwork, sensor: ThermalNetwork, area: float, fingertips: int
) -> StateBasis:
    """States of the object in the order in which they are excited, whichever fingertips touch."""
    modes = sensor.ports.shape[1]
    z_object = network.impedance(MOMENTS)
    z_sensor = sensor.impedance(MOMENTS)
    flows = []
    for conductance in CONDUCTANCES:
        for count in range(1, fingertips + 1):
            for touching in combinations(range(fingertips), count):
                at = np.concatenate([np.arange(modes) + f * modes for f in touching])
                z = z_object[:, at[:, None], at] + np.kron(np.eye(count), z_sensor)
                drive = np.zeros(len(at))
                drive[::modes] = 1.0
                flow = np.zeros((len(MOMENTS), fingertips * modes))
                flow[:, at] = np.linalg.solve(z + np.eye(len(at)) / (conductance * area), drive)
                flows.append(flow)
    return excited_states(network, np.array(flows))
