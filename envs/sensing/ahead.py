"""What a second process compiles while the first one makes an environment: contact laws and networks, which its first
step needs. The arguments are of the types with which advance_grasps calls the functions; with other types the work
would be in vain, and no result wrong."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numba import types

from thermograsp.compiled import compile_beside

from ...thermal.batch import HeatTables, advance_fixed, advance_row, fixed_room, no_fixed_tables
from ...thermal.contact import FOOTPRINT_LAW, footprint, gas_conduction, solid_conduction
from ...thermal.network import workspace
from ...thermal.readout import CHAIN_NUMBERS, measure_rows
from .kernel import _reading

_VECTOR = types.Array(types.float64, 1, "C")


def start_compiling(boxes: bool) -> None:
    """Starts that process, where nothing of it is kept on disk and another processor is there (see compile_beside).
    boxes: all objects have networks from heat kernels, and need nothing of others."""
    if boxes:
        compile_beside("thermograsp.envs.sensing.boxes_ahead", gas_conduction, advance_fixed)
    else:
        compile_beside(__name__, gas_conduction, advance_row)


def compile_ahead() -> None:
    """What it does."""
    compile_contacts()
    tables = HeatTables(
        0.01, np.zeros((1, 5), np.int64), np.zeros((1, 1, 1)), np.zeros((1, 1, 1, 1), np.complex128)
    )
    _advance(advance_row, tables, _made_by(workspace, types.int64, types.int64))
    compile_readings()


def compile_contacts() -> None:
    """The laws of contact."""
    law = numba.from_dtype(FOOTPRINT_LAW)
    _made_by(gas_conduction, law, types.float64, _VECTOR)
    _made_by(footprint, law, types.float64, _VECTOR)
    _made_by(solid_conduction, law, types.float64, types.float64)


def compile_fixed() -> None:
    """The step of a box."""
    _advance(advance_fixed, no_fixed_tables(0.01), _made_by(fixed_room, types.int64))


def compile_readings() -> None:
    """The electronics."""
    chains, matrix, cube = (
        numba.typeof(np.zeros(1, CHAIN_NUMBERS)),
        types.float64[:, ::1],
        types.float64[:, :, ::1],
    )
    measure_rows.compile((chains, matrix, matrix, cube, cube, cube, cube))


def _advance(step: Any, tables: Any, room: types.Type) -> None:
    """A step of a row with such tables."""
    _made_by(
        step,
        numba.typeof(tables),
        types.int64,
        _VECTOR,
        _VECTOR,
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
