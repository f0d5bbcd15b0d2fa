"""What the environments' numbers mean: words and units, which spaces and dictionaries do not carry.

The tables of environment_tables.py take keys, shapes and ranges from the environments, and raise where a word is
missing or no longer needed.
"""

from __future__ import annotations

from typing import Any

from thermograsp.envs import ObjectSpec
from thermograsp.thermal import Thermostat

GRIPPER_ACTION = ("target opening", "force limit", "lift rate of the arm")

ACTIONS: dict[str, tuple[str, ...]] = {
    "thermograsp/Grasp-v0": GRIPPER_ACTION,
    "thermograsp/Sort-v0": (*GRIPPER_ACTION, "sideways rate of the arm"),
    "thermograsp/Identify-v0": (
        "force: above 0 the fingers close with that share of the largest force, else they open",
        "declare: above 0.5 the episode ends with this step's distribution",
        "distribution over the materials, in their order: the softmax of 5 times these",
    ),
}
"""By id, a text for each component; the last one stands for all that follow."""

COMMANDS = {"opening": "mm", "force_limit": "N", "lift_rate": "mm/s", "lateral_rate": "mm/s"}
"""Fields of a Command, as what a component of an action changes is written."""

OBSERVATIONS: dict[str, tuple[tuple[str, str], ...]] = {
    "gripper": (
        ("opening", "m"),
        ("rate of the opening", "m/s"),
        ("height of the arm", "m"),
        ("force limit as commanded", "N"),
    ),
    "force": (("load cell of the left and the right pad: normal and two tangential, pad frame", "N"),),
    "voltage": (("heat flux sensors, left and right, after the converter, oldest sample first", "V"),),
    "thermostat": (("temperature of the left and the right thermostat", "°C"),),
    "lateral": (("place of the arm, sideways", "m"),),
    "goal": (("1 for what is requested, 0 for the others", ""),),
    "pressure": (("over the left and the right pad: rows up to the wrist, columns across", "Pa"),),
    "face_temperature": (("over the left and the right sensor's face: rows and columns alike", "°C"),),
}
"""By key, (what, unit) of each component, or of all together where there is one."""

_ASIDE = ObjectSpec(size=(0.03, 0.03, 0.03), position=(0.0, 0.06))
_SHARED: dict[str, Any] = {
    "taxels": (4, 4),
    "face_temperature": (3, 3),
    "scene": (ObjectSpec(), _ASIDE),
    "thermostat": Thermostat(),
}
OPTIONS: dict[str, dict[str, Any]] = {
    "thermograsp/Grasp-v0": _SHARED,
    "thermograsp/Identify-v0": _SHARED,
    "thermograsp/Sort-v0": {"taxels": (4, 4), "face_temperature": (3, 3)},
}
"""By id, keywords that add keys to observation or info, each with a value for an example."""

INFOS: dict[str, tuple[str, str]] = {
    "success": ("the task is done", ""),
    "material": ("name of the object's material; a pair of names if there are two objects", ""),
    "temperature_drop": ("across the sensors, without noise", "K"),
    "contact_area": ("of the patches on the sensors", "m2"),
    "conductance": ("of the contacts", "W/(m2 K)"),
    "rung": ("thermal model that is used", ""),
    "events": ("touches and releases of this step: (kind, fingertip) each", ""),
    "randomized": ("values that `randomize` has drawn for this episode, by name, in SI units", ""),
    "dropped": ("True if this ended the episode: the object was lifted and fell", ""),
    "crushed": ("True if this ended the episode: a pad pressed harder than the object can bear", ""),
    "slipped": (
        "True if this ended the episode: the object slid further along the pads than `most_slip`",
        "",
    ),
    "wrong": ("True if this ended the episode: the other object was lifted", ""),
    "error": ("why the simulation or the hardware could not go on, if that ended the episode", ""),
    "prediction": ("the declared share of each material", ""),
    "loss": ("-log of the true material's share", ""),
    "asked": ("the requested material, or 'hotter'", ""),
    "right": ("number of the right object, 0 or 1", ""),
    "object_temperatures": ("mean temperature of each object", "°C"),
    "touched": ("number of the object that each fingertip touches, or touched last", ""),
    "over_temperature": ("a heater is off until the next episode, since its thermostat was too hot", ""),
    "unknown": ("names of the values that only a simulation knows", ""),
    "late": ("time by which this step ended too late", "s"),
}

SOMETIMES = ("error", "randomized")
"""In every environment's info, where there is something to tell."""

SIMULATED = ("temperature_drop", "contact_area", "conductance", "rung", "events")
ON_HARDWARE = ("unknown", "late")
"""What info tells, besides the task's own, on a serial plant."""
