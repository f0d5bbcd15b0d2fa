"""One press of the sensor on an object of any shape."""

from __future__ import annotations

from thermograsp.errors import InvalidValueError, positive

from . import network_press
from .body_system import PLATE, PLATE_MATERIAL, touched_body
from .choice import Demand
from .ladder import Rung
from .layers import SensorStack
from .layers import sensor as sensor_preset
from .mesh_solid import Solid, SurfacePatch
from .press import Press, as_felt, sample_times
from .problem import Conductance, PressProblem
from .thermostat import Thermostat

_GRID_ERROR = 1e-3
"""Of the first difference, what the grid adds to the temperature drop: 0.0116 K of 12 K at most on plates of six
materials from cotton to aluminium, 1e3 to 1e5 W/(m2 K), against the semi-analytic rung."""
_VARYING = (1e2, 1e3, 1e4, 1e5)  # W/(m2 K), within which a conductance that varies is expected


def press_body(
    body: Solid,
    patch: SurfacePatch,
    *,
    sensor: str | SensorStack = "seed",
    conductance: Conductance = 1e4,
    air: float = 0.0,
    sensor_temperature: float = 36.0,
    object_temperature: float = 24.0,
    seconds: float = 10.0,
    dt: float = 0.02,
    tolerance: float = 0.05,
    thermostat: Thermostat | None = None,
    cache: bool = True,
) -> Press:
    """Presses the sensor, in mode T, on a patch of an object, both uniform at first.

    body, patch: the object and where it is touched; the patch's area is the contact's. Other arguments are those of
    `press`. Its rung is called "body": a network with flux patterns on the object's own grid.

    tolerance: K of temperature drop from 0.05 s on. Half of it is for the network, half for the grid, which needs 0.012
    K of a first difference of 12 K on flat faces, and more on surfaces that are curved or not along the grid's axes.
    Raises UnknownNameError for names, InvalidValueError for values that make no sense, and MeshError where the patch
    does not meet the surface.
    """
    stack = sensor_preset(sensor)
    problem = PressProblem(
        stack=stack,
        material=PLATE_MATERIAL,
        mode="T",
        conductance=conductance,
        area=patch.area,
        shape="square",
        object_size=PLATE,
        air=air,
        sensor_temperature=sensor_temperature,
        object_temperature=object_temperature,
        thermostat=thermostat,
    )
    t = sample_times(seconds, dt)
    positive("tolerance (K)", tolerance)
    difference = problem.temperature_difference
    least = 2 * _GRID_ERROR * abs(difference)
    if tolerance < least:
        raise InvalidValueError(
            f"tolerance {tolerance:g} K is finer than a mesh's grid is sure to keep, {least:.2g} K at a difference of "
            f"{abs(difference):g} K: ask for a larger one"
        )
    conductances = _VARYING if callable(conductance) else (conductance,)
    demand = Demand(tolerance, difference, conductances, max(float(t[-1]), 0.1))
    system = touched_body(body, (patch,), stack, demand, fingertips=1, cache=cache).system((0,))
    curves = network_press.solve(problem, t, system)
    rung = Rung(
        "body", str(system.orders), tolerance, "the object's own grid, its network cut to the tolerance"
    )
    return as_felt(problem, t, curves, rung)
