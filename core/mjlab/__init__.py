"""Heat in mjlab: a sensor of fingertips that feel it, in thousands of worlds on one device.

cfg.scene.sensors += (ThermalTouchCfg("touch", fingertips={...}, objects={...}),)
env.scene["touch"].data.voltage  # (worlds, fingertips, samples) V
"""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

try:
    import mjlab  # noqa: F401  (before the rest: it loads our tasks, which need all of this room)
except ImportError:  # the room's modules say what is missing
    pass

if TYPE_CHECKING:
    from .sensor import ThermalTouchCfg, ThermalTouchData, ThermalTouchSensor
    from .terms import randomize_material, temperature_drop, voltage

__all__ = [
    "ThermalTouchCfg",
    "ThermalTouchData",
    "ThermalTouchSensor",
    "randomize_material",
    "temperature_drop",
    "voltage",
]

__getattr__ = opened(__name__)
