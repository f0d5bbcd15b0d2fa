"""How the sensor's element is mounted, and the shape of its face."""

from typing import Literal

Mode = Literal["T", "O"]
"""T: the element on the thermostat. O: on the object."""
Shape = Literal["square", "round"]
"""Of a contact patch, and of the sensor's cross-section."""
