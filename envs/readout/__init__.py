"""Fingertips from temperature drop to readings: thermostats, electronics, and maps of the face's temperature."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .cores import HeatedCores
    from .electronics import Electronics, ElectronicsState
    from .face_temperature import FaceTemperature, FaceTemperatureState
    from .thermostats import Thermostats

__all__ = [
    "Electronics",
    "ElectronicsState",
    "FaceTemperature",
    "FaceTemperatureState",
    "HeatedCores",
    "Thermostats",
]

__getattr__ = opened(__name__)
