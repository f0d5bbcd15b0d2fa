"""Figures that commands draw, in one style."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.figures.beside_plot import plot_beside
    from thermograsp.figures.curves import Curve, Mark, chart
    from thermograsp.figures.face_maps import RANGE, Touch, face_section, touches
    from thermograsp.figures.film import Film, Still, across, strip, write_pictures
    from thermograsp.figures.gripper_picture import draw_gripper
    from thermograsp.figures.identify_plot import plot_identification
    from thermograsp.figures.labels import Label, coloured_key, place_labels
    from thermograsp.figures.look import (
        FAINT,
        INK,
        PALE,
        TEMPERATURE_MAP,
        label_ends,
        ordered_colors,
        readable,
        style,
    )
    from thermograsp.figures.press_plot import plot_press
    from thermograsp.figures.pressure_maps import Press, presses, pressure_section
    from thermograsp.figures.saving import save_figure
    from thermograsp.figures.validation_plot import plot_validation

__all__ = [
    "FAINT",
    "INK",
    "PALE",
    "RANGE",
    "TEMPERATURE_MAP",
    "Curve",
    "Film",
    "Label",
    "Mark",
    "Press",
    "Still",
    "Touch",
    "across",
    "chart",
    "coloured_key",
    "draw_gripper",
    "face_section",
    "label_ends",
    "ordered_colors",
    "place_labels",
    "plot_beside",
    "plot_identification",
    "plot_press",
    "plot_validation",
    "presses",
    "pressure_section",
    "readable",
    "save_figure",
    "strip",
    "style",
    "touches",
    "write_pictures",
]

__getattr__ = opened(__name__)
