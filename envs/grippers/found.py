"""A user's gripper as its MJCF file was read: parts, pads, actuators and how it closes."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass, field

import mujoco
import numpy as np

from .path import Closing


@dataclass(frozen=True, slots=True)
class ActuatorMap:
    """A closing actuator along the way. name; unit: m or rad, of its length. wide, narrow: its length at the widest and
    the narrowest opening. per_newton: its force (N or N m) for each newton on the pads. limit: of its force, inf for
    none."""

    name: str
    unit: str
    wide: float
    narrow: float
    per_newton: float
    limit: float


@dataclass(frozen=True, eq=False)
class FoundGripper:
    """A user's gripper with our fingertips on. name: of its file. palm, fingers: names of bodies. pads: of the
    geoms that they are mounted on, areas: m2 of these faces, wedges: degrees between face and fingertip. narrowest,
    widest: m, the opening. strongest: N. flat: m, the openings between which the pads lie flat on parallel faces.
    actuators: what closes it. polynomials: of each driven joint over half the opening, rising powers of m. model and
    closing: what all that follows from."""

    name: str
    palm: str
    fingers: tuple[str, str]
    pads: tuple[str, str]
    areas: tuple[float, float]
    wedges: tuple[float, float]
    narrowest: float
    widest: float
    strongest: float
    flat: tuple[float, float]
    actuators: tuple[ActuatorMap, ...]
    polynomials: dict[int, np.ndarray] = field(repr=False)
    model: mujoco.MjModel = field(repr=False)
    palm_body: int = field(repr=False)
    driven: frozenset[int] = field(repr=False)
    closing: Closing = field(repr=False)
