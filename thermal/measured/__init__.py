"""Recorded touches of real heated sensors: read, predicted, compared, fitted, sorted."""

from .comparing import Comparison, compare, drawn_apart
from .fitting import Fitted, Free, StackFit, fit_stack, value_of, with_value
from .predicting import Predictions, Touched, known_labels, predict, touched_as
from .recordings import START, Recordings, drops_of, load_recordings, shipped_recordings
from .sorting import Confusion, confusion, sort_touches

__all__ = [
    "START",
    "Comparison",
    "Confusion",
    "Fitted",
    "Free",
    "Predictions",
    "Recordings",
    "StackFit",
    "Touched",
    "compare",
    "confusion",
    "drawn_apart",
    "drops_of",
    "fit_stack",
    "known_labels",
    "load_recordings",
    "predict",
    "shipped_recordings",
    "sort_touches",
    "touched_as",
    "value_of",
    "with_value",
]
