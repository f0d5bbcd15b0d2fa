"""Heat physics: arrays in, arrays out.

Identification and fitting load when they are first asked for: environments do without them, and so start sooner.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .air import free_area
from .area import ContactArea, Pad, cylinder_contact, flat_contact, sphere_contact
from .array_fingertips import ArrayFingertips, FingertipState, array_fingertips
from .array_step import array_forget, array_step
from .array_tables import ArrayTables, array_tables
from .batch import HeatReading, HeatTables, advance_heat, forget_field, heat_tables, shift_thermostats
from .bodies import Geometry
from .choice import Choice, Demand
from .conductance import (
    AIR,
    LAPPED_ALUMINA,
    THERMOSTAT_FACE,
    Gas,
    Joint,
    Surface,
    contact_conductance,
    joint,
    stack_joints,
)
from .contact_law import CONTACT_LAW, cylinder_law, flat_law, sphere_law
from .contact_network import network_for, network_of
from .ladder import RUNGS, Rung, RungInfo
from .layers import Layer, SensorStack, load_sensors, sensor, sensors, write_sensor
from .materials import SEED_MATERIALS, Material, load_materials, material, materials
from .network import ThermalNetwork
from .press import Press, press
from .problem import Mode, PressProblem, Shape
from .sensor_touch import KnownTouch
from .signal import (
    ADS1115,
    IDEAL,
    SIGNAL_CHAINS,
    SignalChain,
    SignalState,
    measure,
    measure_sample,
    saturated,
    settled,
)
from .states import Orders
from .system import ContactSystem
from .thermostat import (
    TOO_HOT,
    Thermostat,
    ThermostatState,
    ideal_thermostat,
    settled_thermostat,
    thermostat_step,
)

if TYPE_CHECKING:
    from .identifier import Identifier, identify
    from .identify_effusivity import EffusivityPosterior
    from .identify_result import Identification, Verdict
    from .identify_setup import TouchSetup
    from .mesh_network import body_network
    from .mesh_press import press_body
    from .mesh_solid import Solid, SolidPart, SurfacePatch, solid
    from .sensor_fit import Estimate, SensorFit, fit_sensor

_LATER = {
    "EffusivityPosterior": "identify_effusivity",
    "Estimate": "sensor_fit",
    "Identification": "identify_result",
    "Identifier": "identifier",
    "SensorFit": "sensor_fit",
    "Solid": "mesh_solid",
    "SolidPart": "mesh_solid",
    "SurfacePatch": "mesh_solid",
    "TouchSetup": "identify_setup",
    "Verdict": "identify_result",
    "body_network": "mesh_network",
    "fit_sensor": "sensor_fit",
    "identify": "identifier",
    "press_body": "mesh_press",
    "solid": "mesh_solid",
}
"""Name -> module."""

__all__ = [
    "ADS1115",
    "AIR",
    "CONTACT_LAW",
    "IDEAL",
    "LAPPED_ALUMINA",
    "RUNGS",
    "SEED_MATERIALS",
    "SIGNAL_CHAINS",
    "THERMOSTAT_FACE",
    "TOO_HOT",
    "ArrayFingertips",
    "ArrayTables",
    "Choice",
    "ContactArea",
    "ContactSystem",
    "Demand",
    "FingertipState",
    "EffusivityPosterior",
    "Estimate",
    "Gas",
    "Geometry",
    "HeatReading",
    "HeatTables",
    "Identification",
    "Identifier",
    "Joint",
    "KnownTouch",
    "Layer",
    "Material",
    "Mode",
    "Orders",
    "Pad",
    "Press",
    "PressProblem",
    "Rung",
    "RungInfo",
    "SensorFit",
    "SensorStack",
    "Shape",
    "SignalChain",
    "SignalState",
    "Solid",
    "SolidPart",
    "Surface",
    "SurfacePatch",
    "ThermalNetwork",
    "Thermostat",
    "ThermostatState",
    "TouchSetup",
    "Verdict",
    "advance_heat",
    "array_fingertips",
    "array_forget",
    "array_step",
    "array_tables",
    "body_network",
    "contact_conductance",
    "cylinder_contact",
    "cylinder_law",
    "fit_sensor",
    "flat_contact",
    "flat_law",
    "forget_field",
    "free_area",
    "heat_tables",
    "ideal_thermostat",
    "identify",
    "joint",
    "load_materials",
    "load_sensors",
    "material",
    "materials",
    "measure",
    "measure_sample",
    "network_for",
    "network_of",
    "press",
    "press_body",
    "saturated",
    "sensor",
    "sensors",
    "shift_thermostats",
    "settled",
    "settled_thermostat",
    "solid",
    "sphere_contact",
    "sphere_law",
    "stack_joints",
    "thermostat_step",
    "write_sensor",
]


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_LATER[name]}", __name__), name)
    globals()[name] = value
    return value
