"""Contacts narrower than the sensor's face: what heat has still to spread on both sides of them."""

from .arrays import ArrayNarrow, array_narrow
from .pairs import NarrowPairs
from .ripple import array_ripple, compiled_ripple
from .shared import face_room, face_room_size, note_place, send_across, share_faces
from .spread import add_own, lean, seen, share_of, spread, table_between
from .tables import MODES, STEPS, face_modes, narrow_table, narrow_tables
from .walls import Pinched, Wall, kinds_of, pressed_behind, wall_of

__all__ = [
    "MODES",
    "STEPS",
    "ArrayNarrow",
    "NarrowPairs",
    "Pinched",
    "Wall",
    "add_own",
    "array_narrow",
    "array_ripple",
    "compiled_ripple",
    "face_room",
    "face_room_size",
    "face_modes",
    "kinds_of",
    "lean",
    "narrow_table",
    "narrow_tables",
    "note_place",
    "pressed_behind",
    "seen",
    "send_across",
    "share_faces",
    "share_of",
    "spread",
    "table_between",
    "wall_of",
]
