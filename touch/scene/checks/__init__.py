"""What of a scene would be felt wrongly, or as nothing, without a word: warned of or refused."""

from .contact_filters import refuse_sleep, warn_of_contact_filters
from .fixed_bodies import warn_of_fixed_bodies
from .overlap import refuse_overlap
from .wide_faces import warn_of_wide_faces

__all__ = [
    "refuse_overlap",
    "refuse_sleep",
    "warn_of_contact_filters",
    "warn_of_fixed_bodies",
    "warn_of_wide_faces",
]
