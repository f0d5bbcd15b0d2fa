"""Contacts of a simulation as conductances: read from MjData or from recorded contact sensors."""

from .array_contacts import ArrayContacts, StepContacts, TouchContacts, array_contacts
from .columns import (
    AREA,
    ASIDE,
    BESIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    CURVED,
    ENDS,
    FORCE,
    LENGTH,
    NORMAL,
    PAUSED,
    PLACE,
    PULSES,
)
from .glued import BOND, GluedContacts
from .laws import pair_laws, stacked
from .memory import clock_of
from .reader import ContactReader
from .round_pads import bends, curves
from .sensors import FORCE_AT, PLACE_AT, SensorPlaces, prepare, require_sensors, sensor_places
from .step_contacts import read_contacts, sense_contacts

__all__ = [
    "AREA",
    "ASIDE",
    "BESIDE",
    "BOND",
    "CLOSED",
    "COLUMNS",
    "ArrayContacts",
    "CONDUCTANCE",
    "CURVED",
    "ENDS",
    "FORCE",
    "FORCE_AT",
    "LENGTH",
    "NORMAL",
    "PAUSED",
    "PULSES",
    "PLACE",
    "PLACE_AT",
    "ContactReader",
    "StepContacts",
    "GluedContacts",
    "SensorPlaces",
    "TouchContacts",
    "array_contacts",
    "bends",
    "clock_of",
    "curves",
    "pair_laws",
    "prepare",
    "read_contacts",
    "require_sensors",
    "sense_contacts",
    "sensor_places",
    "stacked",
]
