"""Layered plates seen through a contact patch, in the Laplace domain."""

from .impedance import Far, stack_impedance, stack_profile
from .lateral_sum import from_nodes, lateral_sum, log_nodes
from .patch import SquarePatch
from .samples import BodySamples, ElementSamples, Geometry, sample_bodies, sample_element

__all__ = [
    "BodySamples",
    "ElementSamples",
    "Far",
    "Geometry",
    "SquarePatch",
    "from_nodes",
    "lateral_sum",
    "log_nodes",
    "sample_bodies",
    "sample_element",
    "stack_impedance",
    "stack_profile",
]
