"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .joined import HeatBalance, HeatState, JoinedHeat

__all__ = ["HeatBalance", "HeatState", "JoinedHeat"]
