"""Recordings of a serial line, their replay, and the touches in them."""

from .known_touches import known_touch
from .recording import Damage, Recorder, Recording, read_recording
from .replay import Replay, replay

__all__ = [
    "Damage",
    "Recorder",
    "Recording",
    "Replay",
    "known_touch",
    "read_recording",
    "replay",
]
