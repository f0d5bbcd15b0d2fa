"""The one seam between simulation and hardware: a plant takes commands and answers with readings.

B: environments of a plant, F = 2 fingertips (left, right), S: voltage samples of one control step.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol

import numpy as np

from thermograsp.errors import unknown_name

MAX_OPENING = 0.085  # m between the pads, that a command may ask for and an observation tell
MAX_HEIGHT = 0.15  # m of the arm over its lowest position, that an observation tells
MAX_LIFT_RATE = 0.05  # m/s that a command may ask for
LATERAL_REACH = 0.06  # m of the arm to either side of its middle, that an observation tells
MAX_LATERAL_RATE = 0.1  # m/s that a command may ask for


class Command(NamedTuple):
    """The commands of a gripper for one control step, all (B,). opening: m. force_limit: N. lift_rate: m/s.
    lateral_rate: m/s along the table, across the fingers' motion; None for a gripper that has no such axis, or is to
    stay."""

    opening: np.ndarray
    force_limit: np.ndarray
    lift_rate: np.ndarray
    lateral_rate: np.ndarray | None = None


class Reading(NamedTuple):
    """What a gripper and its fingertips report after one control step.

    opening (B,) m, opening_rate (B,) m/s, height (B,) m of the arm over its lowest position. force (B, F, 3) N: each
    fingertip's load cell in the pad's frame, normal (> 0 when pressing) and two tangential. voltage (B, S, F) V after
    the ADC, oldest first. thermostat (B, F) °C. truth: name -> (B, ...) of what only a simulation knows; on
    hardware `unknown`, the names that are missing, and `late`, s by which the step's end was missed. error: (B,) why an
    environment can't go on, "" while it can. info_names: the entries of truth that every step's info has. lateral (B,)
    m of the arm along the table, None without such an axis. pressure (B, F, n, m) Pa over each pad, rows from the
    fingertip's end up, columns along its horizontal axis; None without taxels. face_temperature (B, F, n, m) °C over
    each sensor's face, rows and columns alike; None where it is not asked for.
    """

    opening: np.ndarray
    opening_rate: np.ndarray
    height: np.ndarray
    force: np.ndarray
    voltage: np.ndarray
    thermostat: np.ndarray
    truth: Mapping[str, Any]
    error: tuple[str, ...]
    info_names: tuple[str, ...] = ()
    lateral: np.ndarray | None = None
    pressure: np.ndarray | None = None
    face_temperature: np.ndarray | None = None


def merged(old: Reading, new: Reading, rows: Sequence[int]) -> Reading:
    """The old reading with the named rows from the new one; both are left as they are."""
    chosen = list(rows)

    def merge(a: Any, b: Any) -> Any:
        if isinstance(a, np.ndarray):
            a = a.copy()
            a[chosen] = b[chosen]
            return a
        if isinstance(a, list | tuple):
            return type(a)(b[i] if i in chosen else value for i, value in enumerate(a))
        return b

    both = Reading(*(merge(before, after) for before, after in zip(old, new, strict=True)))
    truth = {name: merge(value, new.truth[name]) for name, value in old.truth.items()}
    return both._replace(truth=truth, info_names=new.info_names)


class Plant(Protocol):
    """What executes commands and returns readings: a simulation, or a gripper on a serial port. dt: s, the control
    period. sample_rate: Hz of the voltage. num_envs: B."""

    dt: float
    sample_rate: float
    num_envs: int

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Start the named environments anew, each drawing from its own generator. Of the reading only
        their rows count."""
        ...

    def step(self, command: Command) -> Reading:
        """Carry out one control step in all environments."""
        ...

    def close(self) -> None:
        """Release what the plant holds."""
        ...


ENTRY_POINTS = "thermograsp.plants"  # where another package names its own: scheme = module:function
_SCHEMES: Mapping[str, str] = MappingProxyType(
    {
        "simulated": "thermograsp.envs.plant.simulated:simulated_plant",
        "simulated-pair": "thermograsp.envs.plant.pair:pair_plant",
        "serial": "thermograsp.hardware.plant.serial:serial_plant",
        "twin": "thermograsp.twin.plant:twin_plant",
        "twin-pair": "thermograsp.twin.plant:twin_pair_plant",
    }
)


def plant_factory(url: str) -> Callable[..., Plant]:
    """What makes a plant for a URL such as "simulated" or "serial:///dev/ttyACM0": called with the URL, the number of
    environments and the environment's keywords. Modules are loaded on demand.

    Other packages add theirs as an entry point of the group `thermograsp.plants`, the scheme its name. Raises
    UnknownNameError with the known schemes.
    """
    return named_by_scheme("plant", url, _SCHEMES, ENTRY_POINTS)


def named_by_scheme(kind: str, url: str, ours: Mapping[str, str], group: str) -> Any:
    """What stands for a URL's scheme: one of ours, module:function, or another package's entry point of the group.
    Raises UnknownNameError with the known schemes."""
    scheme = str(url).partition(":")[0]
    if scheme in ours:
        module, _, name = ours[scheme].partition(":")
        return getattr(importlib.import_module(module), name)
    added = entry_points(group=group)
    if scheme not in added.names:
        raise unknown_name(kind, scheme, {*ours, *added.names})
    return added[scheme].load()
