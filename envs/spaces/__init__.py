"""Actions and observations: what an agent does and what it is given."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .actions import (
        action_of,
        action_space,
        checked_action,
        command_of,
        sliding_action_of,
        sliding_action_space,
        sliding_command_of,
    )
    from .map_observation import with_maps
    from .observation import Observation, Observer, observation_space
    from .senses import SIZE, Senses
    from .sort_observation import SortObserver

__all__ = [
    "SIZE",
    "Observation",
    "Observer",
    "Senses",
    "SortObserver",
    "action_of",
    "action_space",
    "checked_action",
    "command_of",
    "observation_space",
    "sliding_action_of",
    "sliding_action_space",
    "sliding_command_of",
    "with_maps",
]

__getattr__ = opened(__name__)
