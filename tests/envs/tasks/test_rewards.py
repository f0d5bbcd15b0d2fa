"""Success is worth more than any way of spending the time, for every discount from .9 to 1, in all three tasks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermograsp.envs import (
    GraspTask,
    GraspVectorEnv,
    IdentifyVectorEnv,
    SortTask,
    SortVectorEnv,
    action_of,
    sliding_action_of,
)
from thermograsp.envs.limits import MAX_LATERAL_RATE, MAX_LIFT_RATE, MAX_OPENING
from thermograsp.envs.spaces import SortObserver
from thermograsp.errors import InvalidValueError
from thermograsp.plant import Reading

DISCOUNTS = (0.9, 0.92, 0.95, 0.97, 0.99, 0.995, 0.999, 1.0)  # a step
ENOUGH = 0.052  # m
BELOW = 0.0485  # m, at which nothing is held


class Lift:
    """What one script of a lift does. wait: s before it begins. pause: s that it stays at `height` (m) first, for ever
    by default. short: it goes down a moment before the hold is over, and up again. opens: lets go every second."""

    def __init__(
        self,
        height: float = ENOUGH,
        wait: float = 0.0,
        pause: float = np.inf,
        short: bool = False,
        opens: bool = False,
    ) -> None:
        self._height, self._wait, self._pause, self._short, self._opens = height, wait, pause, short, opens
        self._time = self._held = self._stayed = 0.0
        self._down = False

    def aim(self, lift: float, pressing: bool, hold_seconds: float, dt: float) -> tuple[float, float]:
        """(opening, rate of the lift) in m and m/s, for an object that is so high."""
        self._time += dt
        self._held = self._held + dt if pressing and lift >= 0.049 else 0.0
        self._stayed += dt if lift > self._height - 0.001 else 0.0
        if self._time <= self._wait or (self._opens and self._time % 1.0 > 0.7):
            return MAX_OPENING, 0.0
        height = ENOUGH if self._stayed > self._pause else self._height
        if self._short:
            self._down = self._held > hold_seconds - 0.2 if not self._down else lift > 0.0487
            height = 0.048 if self._down else ENOUGH
        return 0.0, float(np.clip((height - lift) / 0.1, -MAX_LIFT_RATE, MAX_LIFT_RATE)) if pressing else 0.0


def dithering() -> dict[str, Lift]:
    """Scripts that gain nothing, or gain it later, beside the one that succeeds at once."""
    return {
        "at once": Lift(),
        "idle": Lift(wait=np.inf),
        "squeeze": Lift(height=0.0),
        "touch again and again": Lift(height=0.0, opens=True),
        "hover": Lift(BELOW),
        "just short": Lift(short=True),
        "begin late": Lift(wait=3.0),
        "hover first": Lift(BELOW, pause=3.0),
    }


def returns(
    env: Any, act: Callable[[dict[str, np.ndarray]], np.ndarray]
) -> tuple[dict[float, np.ndarray], np.ndarray]:
    """(B,) returns by discount, and successes, of an episode in each environment."""
    observation, _ = env.reset(seed=[3] * env.num_envs)  # the same episode in each
    running, won = np.ones(env.num_envs, bool), np.zeros(env.num_envs, bool)
    total, steps = {discount: np.zeros(env.num_envs) for discount in DISCOUNTS}, 0
    while running.any():
        observation, reward, terminated, truncated, info = env.step(act(observation))
        for discount in DISCOUNTS:
            total[discount] += np.where(running, discount**steps * reward, 0.0)
        won |= info["success"] & running
        running &= ~(terminated | truncated)
        steps += 1
    return total, won


def least_margin(
    names: list[str], total: dict[float, np.ndarray], wins: np.ndarray, late: tuple[str, ...]
) -> float:
    """How much less than success at once the best of the others is worth, as a share of it: the least over the
    discounts. wins: who succeeded, which are to be `late` and the first."""
    assert [name for name, won in zip(names, wins, strict=True) if won] == [names[0], *late]
    for discount, values in total.items():
        rewards = dict(zip(names, values.tolist(), strict=True))
        assert values[0] > 0 and values[0] > values[1:].max(), (discount, rewards)
    return min(1 - values[1:].max() / values[0] for values in total.values())


def test_grasp():
    scripts = dithering()
    env = GraspVectorEnv(len(scripts), material="wood")

    def act(observation: dict[str, np.ndarray]) -> np.ndarray:
        lift, pressing = env.batch.reading.truth["lift"], observation["force"][:, :, 0].min(axis=1) > 5.0
        aims = [
            script.aim(lift[row], pressing[row], 2.0, env.dt) for row, script in enumerate(scripts.values())
        ]
        return np.stack([action_of(opening, 10.0, rate) for opening, rate in aims])

    total, won = returns(env, act)
    assert least_margin(list(scripts), total, won, ("begin late", "hover first")) > 0
    assert total[1.0][0] > 1.9  # 1 for progress and 1 for success, less for its time


def test_sort():
    scripts = dithering()
    env = SortVectorEnv(len(scripts), material=["wood", "glass"])

    def act(observation: dict[str, np.ndarray]) -> np.ndarray:
        truth, places = env.batch.reading.truth, np.array(env.batch.plant.layout.places)
        rows = np.arange(env.num_envs)
        right = truth["right"]
        lift = truth["lift"][rows, right]
        away = places[right] - observation["lateral"][:, 0]
        pressing = truth["object_force"][rows, right, :, 0].min(axis=1) > 5.0
        actions = []
        for row, script in enumerate(scripts.values()):
            opening, rate = script.aim(lift[row], pressing[row], 1.0, env.dt)
            if abs(away[row]) > 0.002 and not pressing[row]:
                opening = MAX_OPENING
            aside = float(np.clip(away[row] / 0.1, -MAX_LATERAL_RATE, MAX_LATERAL_RATE))
            actions.append(sliding_action_of(opening, 10.0, rate, 0.0 if pressing[row] else aside))
        return np.stack(actions)

    total, won = returns(env, act)
    assert least_margin(list(scripts), total, won, ("begin late", "hover first")) > 0
    assert total[1.0][0] > 1.7


def test_identify():
    """Certain of the truth, but declared at once, late, nearly, nearly again and again, or never; and unsure."""
    names = ["at once", "late", "nearly", "nearly again and again", "never", "unsure"]
    env = IdentifyVectorEnv(len(names), material=["wood", "glass", "copper"])
    steps = 0

    def act(observation: dict[str, np.ndarray]) -> np.ndarray:
        nonlocal steps
        del observation
        action = np.zeros((len(names), 5), np.float32)
        for row, name in enumerate(env.batch.reading.truth["material"]):
            action[row, 2:] = np.where(np.array(env.batch.task.classes) == name, 1.0, -1.0)
        action[:, 1] = 1.0, float(steps == 100), 0.5, 0.5 * (steps % 2), -1.0, -1.0
        action[-1, 2:] = 0.0
        steps += 1
        return action

    total, won = returns(env, act)
    assert least_margin(names, total, won, ("late",)) > 0


@pytest.mark.parametrize("seed", range(3))
def test_any_episode_without_success_gains_less_than_any_with_one(seed: int):
    """Forces and heights at random, which no gripper could follow: what is paid still adds up."""
    rng = np.random.default_rng(seed)
    task, rows = GraspTask(hold_seconds=0.06, seconds=1.0), 400
    state, total = task.fresh(rows), np.zeros(rows)
    running, won = np.ones(rows, bool), np.zeros(rows, bool)
    for _ in range(50):
        force = np.where(rng.random((rows, 1, 1)) < 0.8, 10.0, 0.0) * np.ones((rows, 2, 3))
        lift = rng.choice([0.0, 0.03, 0.0485, 0.05, 0.06], rows)
        state, outcome = task.judge(state, 0.02, np.zeros((rows, 3)), reading(force, lift))
        total += np.where(running, outcome.reward, 0.0)
        won |= outcome.success & running
        running &= ~(outcome.terminated | outcome.truncated)
    assert not running.any() and 40 < won.sum() < 360
    assert total[won].min() > 1.9 - 1e-9 and total[~won].max() < 1.0
    assert total.min() >= -1.0 - 1e-9


def reading(force: np.ndarray, height: np.ndarray) -> Reading:
    """Of a gripper that knows nothing but the arm's height."""
    nothing = np.zeros(len(height))
    return Reading(
        nothing,
        nothing,
        height,
        force,
        np.zeros((len(height), 2, 2)),
        np.zeros((len(height), 2)),
        {},
        ("",) * len(height),
    )


def test_a_plant_that_tells_its_truth_in_a_plain_dict_is_judged_by_it():
    task = GraspTask()
    pressing, arm = np.full((2, 2, 3), 10.0), np.full(2, 0.05)
    truth = {"lift": np.array([0.0, 0.05]), "crushing_force": np.array([np.inf, 5.0])}
    _, outcome = task.judge(
        task.fresh(2), 0.02, np.zeros((2, 3)), reading(pressing, arm)._replace(truth=truth)
    )
    assert outcome.reward[0] == pytest.approx(0.2)  # it lies on the table, however high the arm is
    assert outcome.reasons["crushed"].tolist() == [False, True]
    with pytest.raises(InvalidValueError, match=r"'lift' of shape \(2, 2\).*\(2,\)"):
        wrong = reading(pressing, arm)._replace(truth={"lift": np.zeros((2, 2))})
        task.judge(task.fresh(2), 0.02, np.zeros((2, 3)), wrong)


def pressed(places: list[float], height: float, force: float = 10.0) -> Reading:
    """Of arms over real objects, at these lateral places."""
    rows = len(places)
    told = reading(np.full((rows, 2, 3), force), np.full(rows, height))
    return told._replace(lateral=np.array(places), truth={"right": np.array([1] * rows)})


def test_real_objects_are_told_apart_by_the_side_that_the_arm_is_on():
    """Nothing else tells which of the two is lifted."""
    task, action = SortTask(hold_seconds=0.02), np.zeros((2, 4))
    state, outcome = task.judge(task.fresh(2), 0.02, action, pressed([0.03, -0.03], 0.04))
    assert outcome.reasons["wrong"].tolist() == [False, True] and not outcome.success.any()
    assert outcome.reward[0] == pytest.approx(0.3 * 0.8)
    state, outcome = task.judge(state, 0.02, action, pressed([0.03, 0.0], 0.05))
    assert outcome.success.tolist() == [True, True]  # the middle counts as object 1's side
    _, outcome = task.judge(state, 0.02, action, pressed([0.03, 0.03], 0.05, force=0.0))
    assert outcome.reasons["dropped"].tolist() == [True, True]
    _, outcome = task.judge(task.fresh(2), 0.02, action, pressed([0.03, -0.03], 0.05)._replace(truth={}))
    assert not (outcome.success | outcome.terminated).any() and not outcome.reward.any()  # nobody told
    with pytest.raises(InvalidValueError, match="no lateral axis"):
        task.judge(task.fresh(2), 0.02, action, pressed([0.03, 0.03], 0.05)._replace(lateral=None))


def test_an_observer_of_two_objects_says_what_a_plant_lacks():
    observer, everything = SortObserver(1, goals=2), np.ones(1, bool)
    there = pressed([0.03], 0.0)._replace(truth={"goal": np.array([[0.0, 1.0]])})
    seen = observer.observe(there, np.zeros(1), everything)
    assert seen["goal"].tolist() == [[0.0, 1.0]] and seen["lateral"] == pytest.approx(0.03)
    for lacking, said in (
        (there._replace(lateral=None), "no lateral place"),
        (there._replace(truth={}), "no goal"),
    ):
        with pytest.raises(InvalidValueError, match=said):
            observer.observe(lacking, np.zeros(1), everything)
