"""The seam between anyone's mechanics and heat: any MuJoCo scene feels heat.

touch = thermograsp.ThermalTouch(model, fingertips={"thumb": "thumb_pad"}, objects={"can": "aluminium"})
mujoco.mj_step(model, data)
reading = touch.update(data)  # after every step; the reading of the last dt
"""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .contacts import TouchContacts, prepare
    from .engine import install, load_plugin
    from .fixed_touch import FixedTouch, FixedTouchReading, FixedTouchState, grasp_touch
    from .heat import FixedPlaces, HeatBalance
    from .readings import SAMPLES, TouchReading
    from .scene import (
        Face,
        Fingertip,
        SensorElement,
        ThermalBody,
        flat_faces,
        largest_face,
        rotation,
        triangles,
    )
    from .thermal_touch import ThermalTouch, TouchState

__all__ = [
    "SAMPLES",
    "Face",
    "Fingertip",
    "FixedPlaces",
    "FixedTouch",
    "FixedTouchReading",
    "FixedTouchState",
    "HeatBalance",
    "SensorElement",
    "ThermalBody",
    "ThermalTouch",
    "TouchContacts",
    "TouchReading",
    "TouchState",
    "flat_faces",
    "grasp_touch",
    "install",
    "largest_face",
    "load_plugin",
    "prepare",
    "rotation",
    "triangles",
]

__getattr__ = opened(__name__)
