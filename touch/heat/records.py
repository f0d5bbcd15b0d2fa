"""What the heat of a scene tells and remembers.

W: worlds, F: fingertips, O: objects, T = O + F: targets of a contact and fields, K: states.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...thermal import Material
from .contents import ContentsState
from .places import BodyField


class HeatBalance(NamedTuple):
    """J since the start. given (F, O): from each fingertip to each object, and passed (F, F): from each to each later
    fingertip. air: from all objects to the air. elements (F,) and objects (O,): gained, an object with what is glued on
    it. contents (O,): from each object's contents to it."""

    given: np.ndarray
    passed: np.ndarray
    air: float
    elements: np.ndarray
    objects: np.ndarray
    contents: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class HeatState:
    """What the heat remembers. fields: (W, O) the objects' networks; materials: (W, O); current (W, F, O): each pair's
    place among its object's, -1 for none yet. states: (W, T, K). started: (W, O) J in the objects at the start, counted
    from the air's temperature. narrow: (W, F, T, K) sqrt(J K) of narrow contacts. given (W, F, T) and air (W,): J so
    far. drop: (W, F) K. backs: of the fingertips with thermostats of finite power or heaters of their own.
    contents: of the objects that have any."""

    fields: tuple[tuple[BodyField, ...], ...]
    materials: tuple[tuple[Material, ...], ...]
    current: np.ndarray
    states: np.ndarray
    started: np.ndarray
    narrow: np.ndarray
    given: np.ndarray
    air: np.ndarray
    drop: np.ndarray
    backs: tuple[tuple[Any, np.ndarray], ...]
    contents: tuple[ContentsState, ...]
