"""Heat inside MuJoCo's own step: a sensor plugin in C, built for the mujoco that is installed."""

from .install import install
from .library import load_plugin

__all__ = ["install", "load_plugin"]
