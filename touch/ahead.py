"""What a second process compiles while the first one makes a ThermalTouch: what hears steps, and of heat what the first
one comes to last. The arguments are of the types with which a ThermalTouch calls the functions; with other types the
work would be in vain, and no result wrong."""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import compile_beside

from ..thermal import sensor
from ..thermal.kernels import GRASP, Resolution, at_rates, element_samples
from ..thermal.readout import compile_measuring
from .contacts import read_contacts, sense_contacts
from .heard import compile_hearing, compile_record_hearing
from .heat import sample


def start_compiling(recorded: bool) -> None:
    """Starts that process, where something of it is kept nowhere on disk and another processor is there (see
    compile_beside). recorded: contacts come from recorded sensors."""
    if recorded:
        compile_beside(__name__, sense_contacts, sample, by="compile_records_ahead")
    else:
        compile_beside(__name__, read_contacts, sample)


def compile_ahead() -> None:
    """What it does for one MjData. First what no first process is compiling at that time."""
    compile_hearing()
    _rest()


def compile_records_ahead() -> None:
    """The same for recorded sensors."""
    compile_record_hearing()
    _rest()


def _rest() -> None:
    compile_measuring()
    stack = sensor("seed")
    face = 0.0, stack.width
    element_samples(stack, (face, face))
    at_rates(np.ones((len(GRASP), 1, 1)), Resolution(8, 1), np.ones(len(GRASP)))
