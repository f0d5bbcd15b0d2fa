"""thermograsp/Sort-v0: of two objects that look alike, lift the one that is asked for."""

from __future__ import annotations

from functools import partial
from typing import Any

from thermograsp.errors import InvalidValueError

from ..plant import HOTTER, Goal, SimulationConfig
from ..spaces import SortObserver
from ..tasks import SortTask
from .keywords import simulates
from .single import TouchEnv
from .vector import TouchVectorEnv


class SortEnv(TouchEnv):
    """Lift the one of two objects that has the requested material, or the hotter one; both have the same shape, colour,
    mass and friction.

    Action, Box(-1, 1, (4,)), clipped: target opening 0 .. 85 mm, force limit 0 .. 40 N, lift rate -50 .. 50 mm/s,
    lateral rate -100 .. 100 mm/s. The arm starts between the objects, over neither, and reaches 60 mm to either side.

    Observation, a Dict of float32 boxes:

    | key | shape | what | unit |
    |---|---|---|---|
    | gripper | (4,) | opening, its rate, height of the arm, commanded force | m, m/s, m, N |
    | force | (2, 3) | load cell of the left and the right fingertip, pad frame: normal, two tangential | N |
    | voltage | (2, 16) | heat flux sensors after the ADC, oldest first, 100 Hz | V |
    | thermostat | (2,) | temperature of the thermostats | °C |
    | lateral | (1,) | where the arm is between the objects, object 0 lies below 0, object 1 above | m |
    | goal | (K,) | 1 for the asked one of K materials, in their order; (1,), 1, where the hotter one is asked | 1 |

    Reward: the change of progress. Progress is 0 unless both fingertips press the right object; then it is .3 times
    the reached share of 5 cm, plus .5 times the share of hold_seconds for which the object has been held there
    without a break. Touching alone gives nothing. Success adds 1, minus .1 times the share of `seconds` that it took.
    Lifting the other object by 2.5 cm, dropping the right one and crushing either of them take back all progress and
    subtract 1. An episode ends with any of these, and is truncated after `seconds`.

    info: success; material (of object 0 and 1), asked, right (0 or 1), object_temperatures (2,) °C; temperature_drop
    (2,) K, contact_area (2,) m2, conductance (2,) W/(m2 K) and events of the two fingertips, with the object that each
    touches or touched last; rung (of both), randomized (one draw for both); wrong, dropped or crushed if the episode
    ended so; error if the simulation broke down.

    Keywords: goal ("material", "hotter"), material (a list, or None for the ten seed materials; an episode draws two
    of them, or one for "hotter"), object_temperature (°C; for "hotter" a pair, the cooler one first, 20 and 28 by
    default), hold_seconds and seconds (s), objects (an ObjectSpec, or a list to draw from; it applies to both
    objects, with .1 kg and friction .8 by default, and its position is where on them the fingers close), plant
    ("simulated", "twin" or a URL), render_mode, and others as GraspEnv's, in T mode. A real gripper needs its arm's
    axis along y, lateral, and is told what is asked: reset(options={"asked": name}), and with "right": 0 or 1 also
    where that is, so that success can be judged by what the arm lifts.
    """

    def __init__(
        self,
        render_mode: str | None = None,
        *,
        goal: Goal = "material",
        hold_seconds: float = 1.0,
        seconds: float = 10.0,
        **config: Any,
    ) -> None:
        super().__init__(SortTask(hold_seconds, seconds), render_mode, **_prepared(goal, config))


class SortVectorEnv(TouchVectorEnv):
    """`num_envs` sort environments in one array step; keywords as SortEnv's."""

    def __init__(
        self,
        num_envs: int = 1,
        *,
        goal: Goal = "material",
        hold_seconds: float = 1.0,
        seconds: float = 10.0,
        **config: Any,
    ) -> None:
        super().__init__(SortTask(hold_seconds, seconds), num_envs, **_prepared(goal, config))


def _prepared(goal: Goal, config: dict[str, Any]) -> dict[str, Any]:
    """The batch's keywords: of a pair of objects that are simulated, or of real ones, for which there are none."""
    plant, choices = config.pop("plant", "simulated"), _choices(goal, config.get("material"))
    config = {**config, "observer": partial(SortObserver, goals=len(choices))}
    if simulates(plant):
        scheme, colon, rest = plant.partition(":")
        return {**config, "plant": f"{scheme}-pair{colon}{rest}", "goal": goal}
    if plant.startswith("serial:") and config.get("lateral") is None:
        raise InvalidValueError(
            f"plant {plant!r}: Sort-v0 moves the gripper along the table to one of two objects; give lateral=, that "
            "axis of its arm (a thermograsp.hardware.Axis, as for lift)"
        )
    return {
        **{name: value for name, value in config.items() if name != "material"},
        "plant": plant,
        "goals": choices,
    }


def _choices(goal: Goal, material: Any) -> tuple[str, ...]:
    """Names of what can be asked."""
    if goal == "hotter":
        return (HOTTER,)
    return tuple(each.name for each in SimulationConfig(material=material).choices)
