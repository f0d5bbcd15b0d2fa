"""Actions, observations and rewards are plain NumPy: a user can read them, and nothing of them has to be compiled."""

from __future__ import annotations

import importlib
import pkgutil

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher

import thermograsp.envs.spaces
import thermograsp.envs.tasks
from thermograsp.envs import GraspTask, IdentifyTask, SortTask
from thermograsp.plant import Reading


@pytest.mark.parametrize("room", [thermograsp.envs.tasks, thermograsp.envs.spaces])
def test_nothing_is_compiled(room) -> None:
    names = [module.name for module in pkgutil.iter_modules(room.__path__, room.__name__ + ".")]
    assert len(names) > 3
    for name in names:
        values = vars(importlib.import_module(name)).values()
        assert not [value for value in values if isinstance(value, Dispatcher)], name


def reading(rng: np.random.Generator, rows: int) -> Reading:
    """Of grippers anywhere in an episode, on hardware."""
    return Reading(
        opening=np.zeros(rows),
        opening_rate=np.zeros(rows),
        height=rng.uniform(0, 0.06, rows),
        force=rng.uniform(-0.3, 1.0, (rows, 2, 3)),
        voltage=np.zeros((rows, 2, 2)),
        thermostat=np.zeros((rows, 2)),
        truth={
            "lift": rng.uniform(0, 0.06, rows),
            "crushing_force": rng.uniform(0.5, 3.0, rows),
            "right": rng.integers(2, size=rows),
            "material": rng.choice(["wood", "glass", "copper", "unknown"], rows).astype(object),
        },
        error=("",) * rows,
        lateral=rng.uniform(-0.05, 0.05, rows),
    )


@pytest.mark.parametrize(
    "task", [GraspTask(most_slip=0.01), IdentifyTask(("wood", "glass", "copper"), 0.2), SortTask(0.04, 0.2)]
)
def test_a_row_does_not_depend_on_the_others(task) -> None:
    """To the last bit, for any number of rows."""
    rng = np.random.default_rng(5)
    rows, steps = 37, 12
    readings = [reading(rng, rows) for _ in range(steps)]
    actions = rng.uniform(-1, 1, (steps, rows, *task.action_space().shape)).astype(np.float32)
    state, alone = task.fresh(rows), [task.fresh(1) for _ in range(rows)]
    for action, whole in zip(actions, readings, strict=True):
        state, outcome = task.judge(state, 0.02, action, whole)
        for row in range(rows):
            at = slice(row, row + 1)
            arrays = {n: v[at] for n, v in whole._asdict().items() if isinstance(v, np.ndarray)}
            truth = {name: values[at] for name, values in whole.truth.items()}
            cut = whole._replace(**arrays, truth=truth, error=("",))
            alone[row], one = task.judge(alone[row], 0.02, action[at], cut)
            assert alone[row].tobytes() == state[at].tobytes()
            for single, many in zip(one[:4], outcome[:4], strict=True):
                assert single.tobytes() == many[at].tobytes()
            for name, values in one.info.items():
                assert values.tobytes() == outcome.info[name][at].tobytes()
