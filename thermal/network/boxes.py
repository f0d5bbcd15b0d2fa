"""Contact systems of boxes from heat kernels: any size in some milliseconds, nothing kept on disk."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from threadpoolctl import ThreadpoolController

from thermograsp.errors import InvalidValueError

from ..kernels import Detail, Footprint, Patches, Resolution, Spot, Tip, box_side, tip_at, touch_sides
from ..numerics import ThermalNetwork
from ..padded import padded_sides
from ..plates import Geometry
from .air import with_air
from .choice import Choice, Demand, drops
from .system import ContactSystem, with_sensors
from .trim import trimmed

LEVELS = ((Resolution(8, 2), 1e-2), (Resolution(10, 3), 3.2e-3), (Resolution(16, 4), 2.4e-3))
"""Of networks of fixed rates, cheapest first, and the largest error of the drop from FIRST to 30 s after a touch, a
share of the difference: measured over drawn boxes (benchmarks/kernels.py, and studies/networks/laplace_judge.py, which
shares no code with them) for conductances up to STRONGEST, with a margin. They hold for contacts of one area in the
middle of faces: elsewhere on the box, or with a part of the sensor's face on it, the judge saw up to 4.3e-2 for the
first and 1.8e-2 for finer ones."""
DETAILS = ((Detail(8, 3), 30.0), (Detail(10, 3, 1 / 600), 600.0))
"""Of networks of one touch, and the longest s after it for which they are made."""
PADDED_DETAILS = ((Detail(12, 3), 30.0), (Detail(14, 3, 1 / 600), 600.0))
"""The same with a pad around the element, whose fields are of more kinds."""
SHARE = 8e-4
"""Largest error of the drop of any of DETAILS from FIRST s on as a share of the difference, before anything is trimmed;
measured as for LEVELS."""
STRONGEST = 1e5  # W/(m2 K)
PADDED_SHARE = 3.25e-3
"""The same with a pad around the element (concentric squares, three rings beside the face), beside three-dimensional
finite elements (studies/surround/pad_square.py --press), most of it on metals half a second after the touch."""
PADDED_STRONGEST = 3e5
"""W/(m2 K), as of skins on smooth faces: no other network serves there."""
_AIR = 1.25, 1e-4
"""Of what the air's mean temperature is measured to leave, and of the difference: beside grids with the air and without
it, T and O mode, 10 to 50 W/(m2 K), glass to aluminium, it left at most 1.14 of it or 6e-5 of the difference more."""

_BLAS = ThreadpoolController()


def served(geometry: Geometry) -> bool:
    """Whether its contact is a rectangle between an element on the thermostat and a box."""
    return geometry.mode == "T" and geometry.shape == "square"


def box_choice(geometry: Geometry, demand: Demand, air: float) -> Choice | None:
    """The cheapest network of this touch that keeps the demand in air W/(m2 K); None where none is known to. Raises
    InvalidValueError where the fingertip has a surround, which no other network knows."""
    share = (SHARE if geometry.surround is None else PADDED_SHARE) * abs(demand.difference)
    padded = geometry.surround is not None
    strongest = PADDED_STRONGEST if padded else STRONGEST
    details = PADDED_DETAILS if padded else DETAILS
    detail = next((detail for detail, longest in details if demand.horizon <= longest), None)
    kept = served(geometry) and max(demand.conductances) <= strongest and share <= demand.tolerance
    if detail is None or not kept:
        if not padded:
            return None
        raise InvalidValueError(
            f"no network with a surround keeps {demand.tolerance:g} K over {demand.horizon:g} s at "
            f"{max(demand.conductances):g} W/(m2 K): give a tolerance of {share:.2g} K or more, conductances of at "
            f"most {strongest:g} W/(m2 K) and at most {details[-1][1]:g} s"
        )
    # in one thread, or the number of threads would decide last bits
    with _BLAS.limit(limits=1, user_api="blas"):
        tips, box = _sides(geometry, detail, air)
        held = {"object": box.outputs["object"]}

        def join(sensor: ThermalNetwork, body: ThermalNetwork, patterns: int) -> ContactSystem:
            lost = body.outputs["object"] * body.rates
            side = replace(body, outputs={**body.outputs, "loss": lost})
            return joined(geometry, side, sensor, patterns)

        system, error = trimmed(
            geometry,
            tips[0].side,
            replace(box, outputs=held),
            demand,
            demand.tolerance - share,
            join,
        )
    return Choice(system, share + error)


def lumped_air_error(geometry: Geometry, demand: Demand, air: float) -> float:
    """Most K by which the drop is off where the air W/(m2 K) takes heat at the object's mean temperature (air.py) in
    place of each face's own: measured on the box's kernels with either, whose own errors nearly cancel, with a margin.

    A round contact is a square one of its area here, and in O mode the element stands on the thermostat, behind the
    same resistance to the same face of the object."""
    if air == 0:
        return 0.0
    bond = geometry.stack.face_area if geometry.mode == "O" else geometry.area
    spread = geometry.area / bond
    alike = replace(geometry, mode="T", shape="square", area=bond)
    alike_demand = replace(
        demand,
        conductances=tuple(each * spread for each in demand.conductances),
        opposite=None if demand.opposite is None else demand.opposite * spread,
    )
    finest, _ = DETAILS[-1]
    detail = replace(finest, slowest=min(finest.slowest, 1 / demand.horizon))

    def drops_of(system: ContactSystem) -> np.ndarray:
        return drops(system.rates, system.ports, system.drop[0], alike, alike_demand)

    with _BLAS.limit(limits=1, user_api="blas"):
        everywhere = _whole(alike, detail, air)
        lumped, _ = with_air(_whole(alike, detail, 0.0), air)
        measured = float(np.abs(drops_of(everywhere) - drops_of(lumped)).max())
    return _AIR[0] * measured + _AIR[1] * abs(demand.difference)


def _whole(geometry: Geometry, detail: Detail, air: float) -> ContactSystem:
    """Of one touch, nothing trimmed."""
    tips, box = _sides(geometry, detail, air)
    return joined(geometry, box, tips[0].side, detail.patterns)


def _sides(geometry: Geometry, detail: Detail, air: float) -> tuple[tuple[Tip, ...], ThermalNetwork]:
    """Of one touch: the fingertips' elements, all alike, and the box between them."""
    made, size, patches = geometry.material, geometry.object_size, _patches(geometry)
    if geometry.surround is not None:
        return padded_sides(made, size, air, patches, geometry.stack, geometry.surround, detail)
    covered = ((geometry.stack, _covered(geometry)),) * geometry.fingertips
    return touch_sides(made, size, air, patches, covered, detail, shared=True)


def box_system(geometry: Geometry, level: Resolution, air: float) -> ContactSystem:
    """On fixed rates, one fingertip in the middle of the box's top, or two on opposite faces, in air W/(m2 K) that does
    not reach under them."""
    (width, depth, thickness), patches = geometry.object_size, _patches(geometry)
    first, second = patches.half[0].tolist()
    footprint = Footprint(_covered(geometry), (width / 2, depth / 2), (first, second))
    spot = Spot(
        geometry.material.conductivity,
        geometry.material.volumetric_heat_capacity,
        (width, depth),
        thickness,
        footprint,
        footprint if geometry.fingertips == 2 else None,
    )
    touching = tip_at(geometry.stack, spot, level)
    tips = (touching,) * geometry.fingertips
    box = box_side(geometry.material, geometry.object_size, air, patches, tips, level)
    return joined(geometry, box, touching.side, level.patterns)


def _covered(geometry: Geometry) -> tuple[tuple[float, float], tuple[float, float]]:
    """Of the sensor's face."""
    width, half = geometry.stack.width, float(np.sqrt(geometry.area)) / 2
    across = (width / 2 - half, width / 2 + half)
    return across, across


def _patches(geometry: Geometry) -> Patches:
    half, count = np.array(geometry.front) / 2, geometry.fingertips
    middle = [geometry.object_size[0] / 2, geometry.object_size[1] / 2]
    return Patches(np.array([5, 4][:count]), np.array([middle] * count), np.tile(half, (count, 1)))


def joined(geometry: Geometry, box: ThermalNetwork, sensor: ThermalNetwork, patterns: int) -> ContactSystem:
    """The system of a box between the geometry's fingertips, each on `patterns` of its ports."""
    count, order = geometry.fingertips, len(box.rates)
    touched = np.ascontiguousarray(box.ports.reshape(order, count, patterns).transpose(1, 0, 2))
    orders = (order, None if count == 1 else 0)
    alone = with_sensors(geometry, sensor, box.rates, touched, box.outputs["object"], orders)
    if not np.any(box.outputs["loss"]):
        return replace(alone, mean=0)
    lost = np.zeros(len(alone.rates))
    lost[:order] = box.outputs["loss"]
    return replace(alone, air_loss=lost, mean=0)
