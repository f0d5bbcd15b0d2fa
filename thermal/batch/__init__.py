"""Heat of many grasps at once, in NumPy, PyTorch and JAX, and the temperature over a sensor face."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .carry import LEAST_STATES, TipRows, carry_matrix, tip_rows
    from .face import CELLS, FaceField, cosine_means, face_field, face_means, face_state, step_face
    from .fingertips import ArrayFingertips, FingertipState, array_fingertips
    from .fixed_rates import FIXED_LEVEL, HELD, POLE_HEAT, RATES, SHARED, WHERE, FixedTables, no_fixed_tables
    from .fixed_step import advance_fixed, fixed_room, forget_fixed
    from .remembered import fixed_heat, fixed_tip_heat, fixed_tip_rows, fixed_warmth
    from .residues import fixed_tables, set_body, set_gram, tip_residues
    from .rows import (
        RESERVOIR,
        HeatReading,
        HeatTables,
        advance_heat,
        advance_row,
        fingertips_of,
        forget_field,
        forget_row,
        heat_tables,
        no_heat_tables,
        shift_thermostats,
    )
    from .step import array_forget, array_step
    from .tables import ArrayTables, array_tables

__all__ = [
    "CELLS",
    "FIXED_LEVEL",
    "HELD",
    "LEAST_STATES",
    "POLE_HEAT",
    "RATES",
    "RESERVOIR",
    "WHERE",
    "ArrayFingertips",
    "ArrayTables",
    "FaceField",
    "FingertipState",
    "FixedTables",
    "HeatReading",
    "HeatTables",
    "TipRows",
    "advance_fixed",
    "advance_heat",
    "advance_row",
    "array_fingertips",
    "array_forget",
    "array_step",
    "array_tables",
    "carry_matrix",
    "cosine_means",
    "face_field",
    "face_means",
    "face_state",
    "fingertips_of",
    "fixed_heat",
    "fixed_room",
    "fixed_tables",
    "fixed_tip_heat",
    "fixed_tip_rows",
    "fixed_warmth",
    "forget_fixed",
    "forget_field",
    "forget_row",
    "heat_tables",
    "no_fixed_tables",
    "no_heat_tables",
    "set_body",
    "set_gram",
    "SHARED",
    "tip_residues",
    "shift_thermostats",
    "step_face",
    "tip_rows",
]

__getattr__ = opened(__name__)
