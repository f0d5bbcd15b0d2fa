"""From normal force to contact: area, conductance, and both as one compiled law."""

from .area import ContactArea, Pad, cylinder_contact, flat_contact, sphere_contact
from .law import CONTACT_LAW, CYLINDER, FLAT, conductance, contact, cylinder_law, flat_law, sphere_law
from .rough_faces import (
    AIR,
    LAPPED_ALUMINA,
    THERMOSTAT_FACE,
    Gas,
    Joint,
    Surface,
    contact_conductance,
    joint,
    stack_joints,
    typical_slope,
)

__all__ = [
    "AIR",
    "CONTACT_LAW",
    "CYLINDER",
    "FLAT",
    "LAPPED_ALUMINA",
    "THERMOSTAT_FACE",
    "ContactArea",
    "Gas",
    "Joint",
    "Pad",
    "Surface",
    "conductance",
    "contact",
    "contact_conductance",
    "cylinder_contact",
    "cylinder_law",
    "flat_contact",
    "flat_law",
    "joint",
    "sphere_contact",
    "sphere_law",
    "stack_joints",
    "typical_slope",
]
