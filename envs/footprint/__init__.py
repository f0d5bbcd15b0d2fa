"""Where a pad meets a body, and the pressure between them."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .grasp_body import PAD, GraspBody
    from .slipped_mesh import mesh_steps
    from .taxels import MOST_PRESSURE, Taxels, checked_taxels

__all__ = [
    "MOST_PRESSURE",
    "PAD",
    "GraspBody",
    "Taxels",
    "checked_taxels",
    "mesh_steps",
]

__getattr__ = opened(__name__)
