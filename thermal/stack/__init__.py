"""Heated sensors as stacks of layers: read anywhere, heated anywhere by a law, touched with a conductance that follows
force, recorded through filters."""

from .cells import Sample
from .core import CoreState, HeatedCore, heated_core
from .design import Backing, ForceContact, HeatedStack, Place
from .laws import ConstantPower, CutAtContact, Held, Off, Pid
from .network import stack_network
from .presets import any_sensor, heated_stack, heated_stacks, load_heated_stacks
from .recorder import Divider, Recorder
from .signal import converter, fallen, highest_voltage, require_linear
from .touch import StackCurves, Touches, touch_curves

__all__ = [
    "Backing",
    "ConstantPower",
    "CoreState",
    "CutAtContact",
    "Divider",
    "ForceContact",
    "HeatedCore",
    "HeatedStack",
    "Held",
    "Off",
    "Pid",
    "Place",
    "Recorder",
    "Sample",
    "StackCurves",
    "Touches",
    "any_sensor",
    "converter",
    "fallen",
    "heated_core",
    "heated_stack",
    "highest_voltage",
    "heated_stacks",
    "load_heated_stacks",
    "require_linear",
    "stack_network",
    "touch_curves",
]
