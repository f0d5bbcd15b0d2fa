"""A sensor's element with the pad around it, which gives heat to the element's sides and to the object."""

from .touch import padded_sides

__all__ = ["padded_sides"]
