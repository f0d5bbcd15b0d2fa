"""What a second process compiles while the first one makes an environment: contact laws and networks, which its first
step needs. The arguments are of the types with which advance_grasps calls the functions; with other types the work
would be in vain, and no result wrong."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numba import types

from thermograsp.compiled import compile_beside

from ...thermal import material, sensor
from ...thermal.batch import (
    FIXED_LEVEL,
    HeatTables,
    advance_fixed,
    advance_row,
    fixed_heat,
    fixed_room,
    fixed_tables,
    fixed_warmth,
    no_fixed_tables,
    set_body,
    set_gram,
    tip_residues,
)
from ...thermal.contact import (
    CONTACT_LAW,
    FOOTPRINT_LAW,
    beside_face,
    curved_table,
    footprint,
    gas_around,
    solid_conduction,
)
from ...thermal.kernels import (
    GRASP,
    Footprint,
    Patches,
    Spot,
    TouchedBox,
    at_rates,
    compile_tip_states,
    tip,
    tip_at,
    touched_box,
)
from ...thermal.network import workspace
from ...thermal.readout import compile_measuring
from ..footprint import PAD
from .kernel import _reading
from .places import BOX_ROW, strayed

_SIDE = 0.02  # m
_VECTOR = types.Array(types.float64, 1, "C")


def start_compiling(boxes: bool, fields: bool = False) -> None:
    """Starts that process, where nothing of it is kept on disk and another processor is there (see compile_beside).
    boxes: all objects have networks from heat kernels, and need nothing of others. fields: heat flows in those of
    ThermalTouch."""
    if fields:
        from .field_kernel import advance_fields  # nothing that fields need is loaded without them

        compile_beside(__name__, gas_around.called(), advance_fields, by="compile_fields_ahead")
    elif boxes:
        compile_beside(__name__, gas_around.called(), advance_fixed, by="compile_boxes_ahead")
    else:
        compile_beside(__name__, gas_around.called(), advance_row)


def compile_ahead() -> None:
    """What it does."""
    _contacts()
    tables = HeatTables(
        0.01, np.zeros((1, 6), np.int64), np.zeros((1, 1, 1)), np.zeros((1, 1, 1, 1), np.complex128)
    )
    _advance(advance_row, tables, 2, _made_by(workspace, types.int64, types.int64))
    compile_measuring()


def compile_fields_ahead() -> None:
    """The same for objects whose heat flows in fields: the half to which the first process comes last, so that it need
    not wait for any of it."""
    from .field_kernel import compile_fields

    compile_tip_states()
    _contacts()
    curved_table(PAD, None, material("glass"), _SIDE)
    at_rates(np.ones((len(GRASP), 1, 1)), FIXED_LEVEL, np.ones(len(GRASP)))
    compile_fields()
    compile_measuring()


def compile_boxes_ahead() -> None:
    """The same for boxes whose networks come from heat kernels. First what no first process is compiling at that time;
    the kernels come from it."""
    compile_tip_states()
    _contacts()
    _advance(advance_fixed, no_fixed_tables(0.01), 1, _made_by(fixed_room, types.int64))
    compile_measuring()
    strayed(
        np.zeros(1, BOX_ROW), np.zeros((1, 1, 2)), np.zeros((1, 2, 3)), 1, _SIDE, np.zeros((1, 2), np.int64)
    )
    stack, middle = sensor("seed"), np.full((1, 2), _SIDE / 2)
    face, half = ((0.0, stack.width), (0.0, stack.width)), stack.width / 2
    worn = tip(stack, face, FIXED_LEVEL)
    spot = Spot(1.0, 2e6, (_SIDE, _SIDE), _SIDE, Footprint(face, (_SIDE / 2, _SIDE / 2), (half, half)))
    tip_residues(tip_at(stack, spot, FIXED_LEVEL).side)
    patches = Patches(np.array([0, 1]), np.tile(middle, (2, 1)), np.full((2, 2), stack.width / 2))
    box = TouchedBox(material("glass"), (_SIDE, _SIDE, _SIDE), 5.0, patches, (worn, worn), 1)
    tables = fixed_tables(1, 1, 2, FIXED_LEVEL.patterns, worn.side, 0.01)
    set_body(tables, 0, touched_box(box, FIXED_LEVEL), (0, 1))
    tables.links[0, 2:] = 0
    set_gram(tables, 0)
    state = np.zeros(tables.states)
    fixed_heat(tables, 0, state)
    fixed_warmth(tables, 0, state, np.ones(FIXED_LEVEL.rates))


def _contacts() -> None:
    """The laws of contact."""
    law = numba.from_dtype(FOOTPRINT_LAW)
    _made_by(gas_around, law, types.float64, _VECTOR)
    _made_by(footprint, law, types.float64, _VECTOR)
    _made_by(solid_conduction, law, types.float64, types.float64, _VECTOR, types.float64, types.float64)
    pad = types.NestedArray(types.float64, (1,))
    _made_by(beside_face, numba.from_dtype(CONTACT_LAW), pad, types.float64, _VECTOR, _VECTOR)


def _advance(step: Any, tables: Any, contacts: int, room: types.Type) -> None:
    """A step of a row with such tables, and so many arrays of what contacts conduct."""
    _made_by(
        step,
        numba.typeof(tables),
        types.int64,
        _VECTOR,
        *[_VECTOR] * contacts,
        types.NestedArray(types.float64, (2,)),
        types.float64,
        room,
        _made_by(_reading, types.int64, types.int64),
        types.int64,
        types.int64,
    )


def _made_by(function: Any, *arguments: types.Type) -> types.Type:
    """The type of what a function returns for arguments of such types; compiles it."""
    return function.get_call_template(arguments, {})[0].cases[0].return_type
