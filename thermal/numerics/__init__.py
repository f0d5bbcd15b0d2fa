"""Numerical tools that know nothing of sensors: Laplace inversion, passive networks from samples, finite volumes,
eigenvalues, arrays of other libraries."""

from .erfc_inverse import FARTHEST, HIGH, LOW, NEAREST, SERIES, erfc_inverse
from .fastmath import FAST
from .finite_volume import Axis, Body, graded_cells, radial_axis, single_cell, symmetric_axis
from .grid_contact import BOTTOM, OBJECT, SENSOR, TOP, Grid, Interface, Stage, rates
from .lanczos import largest_eigenvalues
from .laplace import invert, invert_many, windows
from .namespace import Array, as_integers, as_like, namespace_of
from .outputs import least_row, output_row
from .passive import ThermalNetwork
from .passive_residues import (
    compiled_residues,
    free_residues,
    mirrored_residues,
    passive_residues,
    passive_states,
    port_residues,
)
from .reduction import Sampled, hankel_values, interpolate, sampled_fields, truncate
from .symmetric import dot, solve_many, turn_diagonal

__all__ = [
    "BOTTOM",
    "FARTHEST",
    "FAST",
    "HIGH",
    "LOW",
    "NEAREST",
    "OBJECT",
    "SENSOR",
    "SERIES",
    "Sampled",
    "TOP",
    "Array",
    "Axis",
    "Body",
    "Grid",
    "Interface",
    "Stage",
    "ThermalNetwork",
    "as_integers",
    "as_like",
    "compiled_residues",
    "dot",
    "erfc_inverse",
    "free_residues",
    "graded_cells",
    "hankel_values",
    "interpolate",
    "invert",
    "invert_many",
    "largest_eigenvalues",
    "least_row",
    "mirrored_residues",
    "namespace_of",
    "output_row",
    "passive_residues",
    "passive_states",
    "port_residues",
    "radial_axis",
    "rates",
    "sampled_fields",
    "solve_many",
    "single_cell",
    "symmetric_axis",
    "truncate",
    "turn_diagonal",
    "windows",
]
