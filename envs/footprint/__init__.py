"""Where a pad meets a body, and the pressure between them."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .grasp_body import PAD, GraspBody
    from .padded_contact import PadContact, pad_contact, touch_pads
    from .slipped_mesh import mesh_steps
    from .taxels import MOST_PRESSURE, Taxels, checked_taxels

__all__ = [
    "MOST_PRESSURE",
    "PAD",
    "GraspBody",
    "PadContact",
    "Taxels",
    "checked_taxels",
    "mesh_steps",
    "pad_contact",
    "touch_pads",
]

__getattr__ = opened(__name__)
