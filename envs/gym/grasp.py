"""thermograsp/Grasp-v0: close on the object, lift it, hold it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..tasks import GraspTask
from .single import TouchEnv
from .vector import TouchVectorEnv


class GraspEnv(TouchEnv):
    """Close on the object, lift it by 5 cm and hold it there, feeling what it is made of.

    Action, Box(-1, 1, (3,)), clipped: target opening 0 .. 85 mm, force limit 0 .. 40 N, lift rate -50 .. 50 mm/s.

    Observation, a Dict of float32 boxes:

    | key | shape | what | unit |
    |---|---|---|---|
    | gripper | (4,) | opening, its rate, height of the arm, commanded force | m, m/s, m, N |
    | force | (2, 3) | load cell of the left and the right fingertip, pad frame: normal, two tangential | N |
    | voltage | (2, 16) | heat flux sensors after the ADC, oldest first, 100 Hz | V |
    | thermostat | (2,) | temperature of the thermostats | °C |

    Reward: the change of progress. Progress is 0 unless both fingertips press; then it is .2, plus .3 times the
    reached share of 5 cm, plus .5 times the share of hold_seconds for which the object has been held there without a
    break. Success adds 1, minus .1 times the share of `seconds` that it took. Dropping, crushing and slipping take
    back all progress and subtract 1. An episode ends with success after hold_seconds at 5 cm, or when the object is
    dropped, crushed or slips. It is truncated after `seconds`.

    info: success; in simulation also material, temperature_drop (2,) K, contact_area (2,) m2, conductance (2,) W/(m2
    K), rung, randomized (the values that randomize drew, by name), events (of this step: (kind, fingertip)); dropped,
    crushed or slipped if the episode ended so; error if the simulation broke down.

    Keywords: material (a name, a Material, a list from which each episode draws one, or None for the object's own,
    else the ten seed materials), mode ("T", "O"), plant ("simulated" or a URL), objects (an ObjectSpec, a name of the
    library, or a list to draw from), taxels ((n, m) adds pressure (2, n, m) Pa over the pads to the observation),
    face_temperature ((n, m) adds face_temperature (2, n, m) °C over the sensors' faces), randomize (records such as
    envs.Roughness, for other differences between episodes), tolerance (K), hold_seconds and seconds (s), most_slip (m
    that the object may slide along the pads, unlimited by default), render_mode ("human", "rgb_array"), and the
    fields of SimulationConfig. reset(options={"material": name}) sets one episode's material.
    """

    def __init__(
        self,
        render_mode: str | None = None,
        *,
        hold_seconds: float = 2.0,
        seconds: float = 10.0,
        most_slip: float = np.inf,
        **config: Any,
    ) -> None:
        super().__init__(GraspTask(hold_seconds, seconds, most_slip), render_mode, **config)


class GraspVectorEnv(TouchVectorEnv):
    """`num_envs` grasp environments in one array step; keywords as GraspEnv's."""

    def __init__(
        self,
        num_envs: int = 1,
        *,
        hold_seconds: float = 2.0,
        seconds: float = 10.0,
        most_slip: float = np.inf,
        **config: Any,
    ) -> None:
        super().__init__(GraspTask(hold_seconds, seconds, most_slip), num_envs, **config)
