"""What a second process compiles while the first one makes an environment whose boxes have networks from heat kernels
(see ahead.py)."""

from __future__ import annotations

import numpy as np

from ...thermal import material, sensor
from ...thermal.batch import FIXED_LEVEL, fixed_tables, set_body, set_gram
from ...thermal.kernels import Patches, TouchedBox, tip, touched_boxes
from ...thermal.numerics import port_residues
from .ahead import compile_contacts, compile_fixed, compile_readings
from .places import BOX_ROW, strayed

_SIDE = 0.02  # m


def compile_ahead() -> None:
    """First what no first process is compiling at that time; the heat kernels come from it."""
    port_residues(np.ones((2, 2)), np.ones((2, 1, 1)))
    compile_contacts()
    compile_fixed()
    compile_readings()
    strayed(
        np.zeros(1, BOX_ROW), np.zeros((1, 1, 2)), np.zeros((1, 2, 3)), 1, _SIDE, np.zeros((1, 2), np.int64)
    )
    stack, middle = sensor("seed"), np.full((1, 2), _SIDE / 2)
    worn = tip(stack, ((0.0, stack.width), (0.0, stack.width)), FIXED_LEVEL)
    patches = Patches(np.zeros(1, int), middle, np.full((1, 2), stack.width / 2))
    box = TouchedBox(material("glass"), (_SIDE, _SIDE, _SIDE), 5.0, patches, (worn,), 1)
    tables = fixed_tables(1, 1, 1, FIXED_LEVEL.patterns, worn.side, 0.01)
    (found,) = touched_boxes([box], FIXED_LEVEL)
    set_body(tables, 0, found, (0,))
    tables.links[0, 2:] = 0
    set_gram(tables, 0)
