"""Which material was touched, from the voltage of a touch."""

from . import prior
from .effusivity import EffusivityPosterior
from .identifier import Identifier, identify
from .result import Identification, Verdict
from .setup import TouchSetup

__all__ = [
    "EffusivityPosterior",
    "Identification",
    "Identifier",
    "TouchSetup",
    "Verdict",
    "identify",
    "prior",
]
