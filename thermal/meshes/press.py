"""One press of the sensor on an object of any shape."""

from __future__ import annotations

from thermograsp.errors import InvalidValueError, positive

from ..matter import SensorStack, Skin
from ..network import Demand
from ..readout import Thermostat
from ..rungs import Conductance, Press, PressProblem, Rung, expected, press_of, pressed_sensor, sample_times
from ..rungs import network as network_press
from ..stack import HeatedStack
from ..surfaces import Solid, SurfacePatch
from .touched import PLATE, PLATE_MATERIAL, touched_body

_AIR_LUMPED = ", nor what the air does that it takes at the object's mean temperature"
_GRID_ERROR = 1e-3
"""Of the first difference, what the grid adds to the temperature drop: 0.0116 K of 12 K at most on plates of six
materials from cotton to aluminium, 1e3 to 1e5 W/(m2 K), against the semi-analytic rung."""


def press_body(
    body: Solid,
    patch: SurfacePatch,
    *,
    sensor: str | SensorStack | HeatedStack = "seed",
    skin: str | Skin | None = None,
    conductance: Conductance | None = None,
    force: Conductance | None = None,
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
    pressed = pressed_sensor(sensor, conductance, force, skin)
    stack = pressed.stack
    problem = PressProblem(
        stack=stack,
        material=PLATE_MATERIAL,
        mode="T",
        conductance=pressed.conductance,
        area=patch.area,
        shape="square",
        object_size=PLATE,
        air=air,
        sensor_temperature=sensor_temperature,
        object_temperature=object_temperature,
        thermostat=thermostat,
        heated=pressed.heated,
        force=pressed.force,
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
    demand = Demand(tolerance, difference, expected(problem.conductance, t), max(float(t[-1]), 0.1))
    touched = touched_body(body, (patch,), stack, demand, fingertips=1, cache=cache)
    system = touched.system((0,))
    curves = network_press.solve(problem, t, system)
    rung = Rung(
        "body",
        str(system.orders),
        touched.error + _GRID_ERROR * abs(difference),
        f"its network measured {touched.error:.2g} K off full order"
        f"{', at constant conductances' if callable(conductance) else ''}; its grid taken to be off as on flat faces "
        f"along its axes, elsewhere that part is not measured{_AIR_LUMPED if air else ''}",
    )
    return press_of(problem, t, curves, rung)
