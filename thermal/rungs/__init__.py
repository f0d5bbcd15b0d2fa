"""One press of the sensor, by every model of the ladder from lumped to three-dimensional grids."""

from . import grid_3d, grid_axisymmetric, network
from .closed_form import drop_o_mode, drop_t_mode, equivalent_slab
from .grid import March
from .grid_axisymmetric import grid
from .ladder import RUNGS, Rung, RungInfo, expected, press_network, solve_rung
from .network import geometry_of
from .press import Press, press, press_of, pressed_sensor, sample_times
from .problem import Conductance, PressProblem

__all__ = [
    "RUNGS",
    "Conductance",
    "March",
    "Press",
    "PressProblem",
    "Rung",
    "RungInfo",
    "press_of",
    "drop_o_mode",
    "drop_t_mode",
    "equivalent_slab",
    "expected",
    "geometry_of",
    "grid",
    "grid_3d",
    "grid_axisymmetric",
    "network",
    "press",
    "press_network",
    "pressed_sensor",
    "sample_times",
    "solve_rung",
]
