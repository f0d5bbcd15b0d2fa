"""What stands in somebody's MuJoCo model: fingertips with their pads, and the objects that they may touch."""

from .bodies import PREFIX, BodyShape, Objects, SensorElement, ThermalBody, bodies, materials_by_world
from .checks import (
    refuse_overlap,
    refuse_sleep,
    warn_of_contact_filters,
    warn_of_fixed_bodies,
    warn_of_wide_faces,
)
from .elements import glued_elements
from .faces import Face, flat_faces, hull_of, largest_face, mesh_of, rotation, triangles
from .fingertips import Fingertip, PadPlace
from .names import find, geom_label, geoms_of
from .own_shape import own_shapes, warn_of_boxes
from .pads import pads
from .round_faces import has_edge
from .steps import LONGEST, samples_in, whole_steps

__all__ = [
    "LONGEST",
    "PREFIX",
    "BodyShape",
    "Face",
    "Fingertip",
    "Objects",
    "PadPlace",
    "SensorElement",
    "ThermalBody",
    "bodies",
    "find",
    "flat_faces",
    "geom_label",
    "geoms_of",
    "glued_elements",
    "has_edge",
    "hull_of",
    "largest_face",
    "materials_by_world",
    "mesh_of",
    "own_shapes",
    "pads",
    "refuse_overlap",
    "refuse_sleep",
    "rotation",
    "samples_in",
    "triangles",
    "warn_of_boxes",
    "warn_of_fixed_bodies",
    "warn_of_contact_filters",
    "warn_of_wide_faces",
    "whole_steps",
]
