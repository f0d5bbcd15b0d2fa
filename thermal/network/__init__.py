"""Thermal networks of few states: reduced from impedances, joined by contacts, stepped exactly."""

from ..numerics import ThermalNetwork
from . import coupling
from .air import free_area, with_air
from .boxes import LEVELS, box_choice, box_system, lumped_air_error
from .cached import network_for, network_of
from .choice import FIRST, Choice, Demand, candidates, even_ports, responses
from .coupling import POLES, WEIGHTS, propagator, step
from .kernel import StepArrays, advance, step_arrays, workspace
from .modes import patch_modes
from .states import CONDUCTANCES, MOMENTS, Orders, excited_states, reduce, state_bases
from .system import MOST_MODES, NODE, SHIFTS, ContactSystem, assemble, sample_geometry, with_sensors

__all__ = [
    "CONDUCTANCES",
    "FIRST",
    "LEVELS",
    "MOMENTS",
    "MOST_MODES",
    "NODE",
    "POLES",
    "SHIFTS",
    "WEIGHTS",
    "Choice",
    "ContactSystem",
    "Demand",
    "Orders",
    "StepArrays",
    "ThermalNetwork",
    "advance",
    "assemble",
    "box_choice",
    "box_system",
    "candidates",
    "coupling",
    "even_ports",
    "excited_states",
    "free_area",
    "lumped_air_error",
    "network_for",
    "network_of",
    "patch_modes",
    "propagator",
    "reduce",
    "responses",
    "sample_geometry",
    "state_bases",
    "step",
    "step_arrays",
    "with_air",
    "with_sensors",
    "workspace",
]
