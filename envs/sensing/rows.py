"""What heat remembers and tells of one environment, as records that compiled code and NumPy both read.

F = 2 fingertips.
"""

from __future__ import annotations

import numpy as np

from ...thermal.contact import CONTACT_LAW

# difference: K, sensor less object when both were uniform. sensor_temperature: °C, of the thermostats at first.
# offset: K, of theirs since. stored: J, that the elements
# gained. anchor: m, where on the object, in its frame, each patch is, if it is known. reach: m, how far from there a
# contact may move. books: J since the start, that flowed into the object's side, its absolute sum, and lost to the air.
# capacity, element_capacity: J/K. air: W/K from the object to the air, ambient: K, the air above the object's first
# temperature. enthalpy: J of its reservoir. network: the index of the environment's network. begun: something
# has touched, or the object is not as warm as what is around it. glued: the elements sit on the object (O mode).
# lasting: a new patch finds the object's field, not its mean. fed: the reservoir is a node of the network.
# boxed: the row is a box of FixedTables, which has no number. pad: m, half the sides of the pads around the sensors, 0
# without, and pad_law the law of their contact.
HEAT_ROW = np.dtype(
    [
        ("difference", "f8", (2,)),
        ("offset", "f8", (2,)),
        ("stored", "f8", (2,)),
        ("anchor", "f8", (2, 3)),
        ("books", "f8", (3,)),
        ("sensor_temperature", "f8", (2,)),
        ("reach", "f8"),
        ("capacity", "f8"),
        ("element_capacity", "f8"),
        ("air", "f8"),
        ("ambient", "f8"),
        ("enthalpy", "f8"),
        ("pad", "f8", (1,)),
        ("pad_law", CONTACT_LAW),
        ("network", "i8"),
        ("touching", "u1", (2,)),
        ("known", "u1", (2,)),
        ("begun", "u1"),
        ("glued", "u1"),
        ("lasting", "u1"),
        ("fed", "u1"),
        ("boxed", "u1"),
    ]
)

# One control step; see HeatStep.
HEAT_INFO = np.dtype(
    [
        ("conductance", "f8", (2,)),
        ("area", "f8", (2,)),
        ("sensor_surface", "f8", (2,)),
        ("object_surface", "f8", (2,)),
        ("object_temperature", "f8"),
        ("heat", "f8", (3,)),
        ("flow", "f8", (2,)),
        ("air_loss", "f8"),
        ("reservoir_temperature", "f8"),
        ("reservoir_flow", "f8"),
        ("drawn", "f8", (2,)),
        ("imbalance", "f8"),
        ("exchanged", "f8"),
        ("events", "u1", (2,)),
        ("over_temperature", "?"),
    ]
)


def heat_info(rows: int) -> np.ndarray:
    """That many HEAT_INFO records, all 0. NumPy's own zeros would take longer, since they look at each field."""
    return np.ndarray(rows, HEAT_INFO, bytearray(rows * HEAT_INFO.itemsize))


TOUCH, RELEASE, NEW_PATCH, OFF_ELEMENT, OVER_TEMPERATURE = 1, 2, 4, 8, 16
_KINDS = (
    (TOUCH, "touch"),
    (OFF_ELEMENT, "touch off the element"),
    (RELEASE, "release"),
    (NEW_PATCH, "new patch"),
    (OVER_TEMPERATURE, "over temperature"),
)


def _all_events() -> np.ndarray:
    events = np.empty((32, 32), object)
    for codes in np.ndindex(events.shape):
        events[codes] = tuple(
            (kind, tip)
            for code, tip in zip(codes, ("left", "right"), strict=True)
            for bit, kind in _KINDS
            if code & bit
        )
    return events


_EVENTS = _all_events()


def events_of(codes: np.ndarray) -> np.ndarray:
    """(B,) of tuples of (kind, fingertip), from the codes (B, F) of the left and the right one."""
    if np.count_nonzero(codes):
        return _EVENTS[codes[:, 0], codes[:, 1]]
    nothing = np.empty(len(codes), object)  # as in most steps
    nothing.fill(())
    return nothing
