"""Pictures of a grasp, with bodies coloured by temperature."""

from .colormap import temperature_colour
from .picture import GraspPicture, temperatures
from .render import Renderer, Window

__all__ = [
    "GraspPicture",
    "Renderer",
    "Window",
    "temperature_colour",
    "temperatures",
]
