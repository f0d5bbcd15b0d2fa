"""With stakes, no one force does for all, and slipping, crushing and time decide as the force window says."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.envs import (
    STAKES,
    GraspEnv,
    GraspVectorEnv,
    action_of,
    force_window,
)
from thermograsp.errors import InvalidValueError


def ended(env: GraspEnv, material: str, force: float) -> str:
    """How an episode ends that closes with one force, waits .5 s and lifts."""
    _, info = env.reset(seed=0, options={"material": material})
    for k in range(1000):
        _, _, terminated, truncated, info = env.step(action_of(0.0, force, 0.05 if k > 40 else 0.0))
        if terminated or truncated:
            break
    reasons = [name for name in ("success", "dropped", "crushed", "slipped") if info.get(name)]
    return reasons[0] if reasons else "time"


def test_the_window_decides():
    env = GraspEnv(**STAKES)
    windows = {}
    for material in STAKES["material"]:
        env.reset(seed=0, options={"material": material})
        low, high = force_window(env.batch.plant.bodies[0])  # pyright: ignore[reportAttributeAccessIssue]
        windows[material] = low, high
        middle = np.sqrt(max(low, 1.0) * min(high, 40.0))
        assert ended(env, material, middle) == "success"
        if low > 2.0:
            assert ended(env, material, 0.7 * low) == "slipped"
        if high < 40.0:
            assert ended(env, material, 1.1 * high) == "crushed"
    # The best single force serves at most five of the eight.
    forces = np.linspace(0.5, 40.0, 200)
    served = [sum(low < force < high for low, high in windows.values()) for force in forces]
    assert max(served) <= 5


def test_sliding_is_free_without_a_limit():
    env = GraspEnv(**{**STAKES, "most_slip": np.inf, "seconds": 2.0})
    assert ended(env, "copper", 10.0) == "time"


def test_a_limit_must_be_above_zero():
    with pytest.raises(InvalidValueError, match="most_slip"):
        GraspEnv(most_slip=0.0)


@pytest.mark.parametrize(
    ("deed", "mean"),
    [("idle", 0.0), ("random", 0.0), ("squeeze hard", 0.1), ("squeeze gently", 0.6), ("lift nothing", 0.0)],
)
def test_no_reward_without_the_deed(deed: str, mean: float):
    """A success is worth 1.7 or more; a touch without a lift .2 a second."""
    env = GraspVectorEnv(16, **STAKES)
    env.reset(seed=0)
    rng = np.random.default_rng(0)
    constant = {
        "idle": action_of(0.085, 0.0, 0.0),
        "squeeze hard": action_of(0.0, 40.0, 0.0),
        "squeeze gently": action_of(0.0, 9.0, 0.0),
        "lift nothing": action_of(0.085, 10.0, 0.05),
    }
    returns, running = np.zeros(16), np.ones(16, bool)
    while running.any():
        action = rng.uniform(-1, 1, (16, 3)) if deed == "random" else np.tile(constant[deed], (16, 1))
        _, reward, terminated, truncated, info = env.step(action)
        assert not (info["success"] & running).any()
        returns += np.where(running, reward, 0.0)
        running &= ~(terminated | truncated)
    assert returns.mean() <= mean and returns.max() <= 0.6
