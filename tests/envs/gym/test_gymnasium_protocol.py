"""What Gymnasium's users and other libraries expect of an environment beside its steps."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
import warnings
from typing import Any, cast

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import TimeLimit

import thermograsp  # noqa: F401  registers the ids
from thermograsp.envs import (
    Delay,
    GraspBatch,
    GraspEnv,
    GraspVectorEnv,
    IdentifyVectorEnv,
    SolverSettings,
    SortEnv,
)
from thermograsp.errors import InvalidValueError, ThermograspError
from thermograsp.thermal import Thermostat

from ..scripted import grasp_action

SHORT: dict[str, Any] = {"material": ["glass", "wood"], "seconds": 0.1}


def make(num_envs: int = 3, **keywords: Any) -> Any:
    given = {**SHORT, **keywords}
    return gymnasium.make_vec(
        "thermograsp/Grasp-v0", num_envs=num_envs, vectorization_mode="vector_entry_point", **given
    )


def same(a: Any, b: Any) -> bool:
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[name], b[name]) for name in a)
    return np.array_equal(np.asarray(a), np.asarray(b))


@pytest.mark.parametrize(
    ("seconds", "substeps", "steps"), [(0.1, 10, 5), (0.09, 10, 4), (0.1, 5, 10), (1e-3, 10, 1)]
)
def test_the_time_limit_is_told_in_steps(seconds: float, substeps: int, steps: int):
    single: Any = gymnasium.make("thermograsp/Grasp-v0", material="glass", seconds=seconds, substeps=substeps)
    assert single.get_wrapper_attr("_max_episode_steps") == single.spec.max_episode_steps == steps
    single.reset(seed=0)
    ends = [single.step(np.zeros(3))[3] for _ in range(steps)]
    assert ends == [False] * (steps - 1) + [True]
    vector = make(2, seconds=seconds, substeps=substeps)
    assert vector.call("_max_episode_steps") == (steps, steps) and vector.spec.max_episode_steps == steps
    assert single.metadata["render_fps"] == vector.metadata["render_fps"] == 500 / substeps


def test_no_limit_where_the_task_has_none():
    assert GraspEnv(material="glass", seconds=np.inf).batch.time_limit is None


def closed(env: Any) -> Any:
    env.reset(seed=0)
    env.close()
    env.close()  # the second time does nothing
    return env


@pytest.mark.parametrize(
    "env",
    [
        lambda: GraspEnv(**SHORT, render_mode="rgb_array"),
        lambda: gymnasium.make("thermograsp/Identify-v0", **SHORT),
        lambda: SortEnv(seconds=0.1, material=["glass", "wood"]),
        make,
        lambda: make(autoreset_mode=AutoresetMode.SAME_STEP),
        lambda: make(autoreset_mode=AutoresetMode.DISABLED),
    ],
)
def test_a_closed_environment_says_so(env: Any):
    """By Gymnasium's own error, which is one of ours too; a vector also where rows of it have ended."""
    shut = closed(env())
    action = shut.action_space.sample()
    calls = {"step": lambda: shut.step(action), "reset": lambda: shut.reset(seed=1)}
    calls["render"] = shut.render
    for name, call in calls.items():
        with pytest.raises(gymnasium.error.ClosedEnvironmentError, match=f"{name} .*closed: make a new one"):
            call()
        with pytest.raises(ThermograspError):
            call()


def test_a_closed_environment_takes_no_state():
    env = GraspEnv(**SHORT)
    env.reset(seed=0)
    state = env.state()
    env.close()
    with pytest.raises(gymnasium.error.ClosedEnvironmentError, match="set_state"):
        env.set_state(state)
    again = GraspEnv(**SHORT)  # what was saved is not lost
    again.set_state(state)
    again.step(np.zeros(3))
    again.close()


def test_closed_before_the_first_reset():
    for env in (GraspEnv(**SHORT), make()):
        env.close()
        with pytest.raises(gymnasium.error.ClosedEnvironmentError):
            env.reset(seed=0)
        with pytest.raises(gymnasium.error.ClosedEnvironmentError):
            env.step(env.action_space.sample())


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("env_id", ["Grasp", "Identify", "Sort"])
def test_gymnasiums_full_check_passes_without_a_display(env_id: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thermograsp.envs.gym.single.has_display", lambda: False)
    env = gymnasium.make(f"thermograsp/{env_id}-v0", seconds=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", module="matplotlib")  # the oldest calls what pyparsing has renamed
        check_env(env.unwrapped)
    env.close()


def test_an_environment_is_made_again_from_its_spec():
    env = gymnasium.make("thermograsp/Grasp-v0", **SHORT)
    assert env.spec is not None
    again = gymnasium.make(pickle.loads(pickle.dumps(env.spec)))
    assert isinstance(again, TimeLimit) and again.spec is not None and again.spec.max_episode_steps == 5
    assert same(env.reset(seed=1)[0], again.reset(seed=1)[0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped, skip_render_check=True)
    vector = gymnasium.make_vec(env.spec, num_envs=2)
    assert vector.get_attr("_max_episode_steps") == (5, 5)  # pyright: ignore[reportAttributeAccessIssue]


def test_a_limit_of_steps_truncates_vector_environments_too():
    vector = make(2, max_episode_steps=3)
    vector.reset(seed=0)
    assert [vector.step(np.zeros((2, 3)))[3].tolist() for _ in range(5)] == [
        [False] * 2,
        [False] * 2,
        [True] * 2,
        [False] * 2,
        [False] * 2,
    ]
    with pytest.raises(InvalidValueError, match="max_episode_steps"):
        make(2, max_episode_steps=0)


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_autoreset_modes_are_those_of_gymnasiums_own_vector_environment(mode: AutoresetMode):
    """Two of three are reset in between, so that not all end at once."""
    ours = make(3, autoreset_mode=mode)
    gym_vector = SyncVectorEnv([lambda: GraspEnv(**SHORT)] * 3, autoreset_mode=mode)
    assert ours.autoreset_mode is mode and ours.metadata["autoreset_mode"] is mode
    assert make(1, autoreset_mode=mode.value).unwrapped.autoreset_mode is mode
    assert same(ours.reset(seed=5)[0], gym_vector.reset(seed=5)[0])
    rng = np.random.default_rng(0)
    for k in range(16):
        if k == 2:
            mask = np.array([True, False, True])
            pairs = [env.reset(seed=9, options={"reset_mask": mask})[0] for env in (ours, gym_vector)]
            assert same(*pairs)
        action = rng.uniform(-1, 1, (3, 3)).astype(np.float32)
        expected_like, other = ours.step(action), gym_vector.step(action)
        ended = expected_like[2] | expected_like[3]
        for a, b in zip(expected_like[:4], other[:4], strict=True):
            assert same(a, b)
        info, wanted = expected_like[4], other[4]
        assert same(info["temperature_drop"], wanted["temperature_drop"])
        assert info["material"].tolist() == wanted["material"].tolist()
        assert ("final_obs" in info) == ("final_obs" in wanted)
        if "final_obs" in info:
            assert same(info["_final_obs"], wanted["_final_obs"]) and same(info["_final_obs"], ended)
            for row in np.flatnonzero(ended):
                assert same(info["final_obs"][row], wanted["final_obs"][row])
                drops = (each["final_info"]["temperature_drop"][row] for each in (info, wanted))
                assert same(*drops)
        if mode is AutoresetMode.DISABLED and ended.any():
            with pytest.raises(InvalidValueError, match="reset_mask"):
                ours.step(action)
            pairs = [env.reset(options={"reset_mask": ended.copy()})[0] for env in (ours, gym_vector)]
            assert same(*pairs)


def test_an_unknown_autoreset_mode_is_refused():
    with pytest.raises(LookupError, match="SameStep"):
        make(1, autoreset_mode="SameStop")
    object.__new__(GraspVectorEnv).close()  # as Gymnasium does when it goes


def test_attributes_of_a_vector_environment():
    vector = make(3).unwrapped
    vector.reset(seed=0)
    assert vector.get_attr("dt") == (0.02,) * 3 and vector.call("dt") == (0.02,) * 3
    assert vector.get_attr("action_space") == (vector.single_action_space,) * 3
    assert [model.nq for model in vector.get_attr("model")] == [vector.model.nq] * 3
    assert vector.get_attr("np_random") == tuple(vector.batch.generators)
    vector.set_attr("difficulty", [1, 2, 3])
    assert vector.get_attr("difficulty") == (1, 2, 3)
    vector.set_attr("difficulty", lambda more: 4 + more)
    assert vector.call("difficulty", 1) == (5, 5, 5)
    with pytest.raises(AttributeError, match="'dt'|'difficulty'"):
        vector.get_attr("difficulti")
    with pytest.raises(AttributeError, match="known: ") as unknown:
        vector.get_attr("zzz")
    assert "__" not in str(unknown.value)
    with pytest.raises(InvalidValueError, match="2 values for 3"):
        vector.set_attr("difficulty", [1, 2])
    with pytest.raises(InvalidValueError, match="cannot set 'dt'"):
        vector.set_attr("dt", 0.1)
    with pytest.raises(InvalidValueError, match="cannot call 'reset'"):
        vector.call("reset")


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
@pytest.mark.parametrize("many", [False, True])
def test_a_copy_goes_on_alike_and_apart(copied: Any, many: bool):
    env: Any = (
        make(2, seconds=0.5) if many else gymnasium.make("thermograsp/Grasp-v0", **{**SHORT, "seconds": 0.5})
    )
    early = copied(env)  # before any reset
    assert same(env.reset(seed=3)[0], early.reset(seed=3)[0])

    def act() -> np.ndarray:
        action = grasp_action(env.unwrapped.batch)
        return action if many else action[0]

    for _ in range(12):
        env.step(act())
    other = copied(env)
    assert other.spec == env.spec and other.unwrapped.batch is not env.unwrapped.batch
    taken = []
    for _ in range(30):  # over the end, where the vector starts anew
        taken.append(act())
        seen = env.step(taken[-1])
        assert same(seen[0], other.step(taken[-1])[0])
    # Drawn from generators of their own, which stand alike.
    assert same(env.reset()[0], other.reset()[0])


def test_hardware_is_not_copied():
    env = GraspEnv(material="glass")
    env.batch.plant = object()  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(InvalidValueError, match="not simulated"):
        copy.deepcopy(env)


def test_a_state_takes_the_generators_and_the_ends_along():
    first = make(3, seconds=0.2).unwrapped
    first.reset(seed=0)
    for _ in range(10):
        first.step(np.zeros((3, 3)))  # all end with the tenth
    state = pickle.loads(pickle.dumps(first.state()))
    wanted = [first.step(np.zeros((3, 3))) for _ in range(25)]
    other = make(3, seconds=0.2).unwrapped
    other.reset(seed=77)
    other.set_state(state)
    for want in wanted:
        got = other.step(np.zeros((3, 3)))
        assert all(same(a, b) for a, b in zip(want[:4], got[:4], strict=True))
        assert want[4]["material"].tolist() == got[4]["material"].tolist()
    batch = other.batch  # set past the environment, too
    batch.set_state(state.batch)
    other._ended[:] = True
    assert same(other.step(np.zeros((3, 3)))[0], wanted[0][0])


def test_a_state_of_another_task_or_number_is_refused_and_changes_nothing():
    first = make(2).unwrapped
    first.reset(seed=0)
    state = first.state()
    for other in (IdentifyVectorEnv(2, material=["glass", "wood"]), make(3).unwrapped):
        other.reset(seed=1)
        twin = copy.deepcopy(other)
        with pytest.raises(InvalidValueError, match="the state is of 2 environments"):
            other.set_state(state)
        still = np.zeros(other.action_space.shape)  # pyright: ignore[reportArgumentType, reportCallIssue]
        assert same(other.step(still)[0], twin.step(still)[0])


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"mode": "O"}, "mode is 'T' in place of 'O'"),
        ({"tolerance": 0.1}, "tolerance is 0.05"),
        ({"air": 50.0}, "air is 5.0"),
        ({"substeps": 5}, "substeps is 10"),
        ({"solver": SolverSettings(timestep=0.001)}, "solver is another"),
        ({"sensor": "biotac_like"}, "sensor is another"),
        ({"thermostat": Thermostat()}, "thermostat is another"),
        ({"randomize": [Delay()]}, "longest delay is 0 in place of 3"),
    ],
)
def test_a_state_of_other_keywords_is_refused_and_changes_nothing(keywords: dict[str, Any], said: str):
    """Some would go on with wrong temperatures, others break off half-way."""
    first, other = make(1).unwrapped, make(1, **keywords).unwrapped
    first.reset(seed=0)
    other.reset(seed=1)
    twin = copy.deepcopy(other)
    with pytest.raises(InvalidValueError, match=said):
        other.set_state(first.state())
    assert same(other.step(np.zeros((1, 3)))[0], twin.step(np.zeros((1, 3)))[0])


@pytest.mark.parametrize("name", ["Grasp", "Sort"])
def test_what_was_never_reset_takes_no_step(name: str):
    vector: Any = gymnasium.make_vec(
        f"thermograsp/{name}-v0",
        num_envs=3,
        vectorization_mode="vector_entry_point",
        material=["glass", "wood"],
    )
    vector.reset(seed=0, options={"reset_mask": np.array([True, False, True])})
    with pytest.raises(InvalidValueError, match=r"environments \[1\] have never been reset"):
        vector.step(np.zeros(vector.action_space.shape))
    for copied in (vector.unwrapped.state, lambda: copy.deepcopy(vector)):
        with pytest.raises(
            InvalidValueError, match=r"environments \[1\] have never been reset.*before state"
        ):
            copied()
    vector.reset(seed=0, options={"reset_mask": np.array([False, True, False])})
    vector.step(np.zeros(vector.action_space.shape))
    with pytest.raises(InvalidValueError, match="one True"):
        vector.reset(options={"reset_mask": np.zeros(3, bool)})


@pytest.mark.parametrize(
    ("kind", "keyword", "near"),
    [
        (GraspEnv, "hold_second", "'hold_seconds'"),
        (GraspVectorEnv, "materials", "'material'"),
        (IdentifyVectorEnv, "cost", "'cost_per_second'"),
        (SortEnv, "goals", "'goal'"),
        (GraspEnv, "goal", "'signal'|known"),
        (GraspBatch, "tolerence", "'tolerance'"),
    ],
)
def test_an_unknown_keyword_is_a_type_error_that_names_the_nearest(kind: Any, keyword: str, near: str):
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{keyword}'.*({near})") as error:
        kind(**{keyword: 1.0})
    assert isinstance(error.value, InvalidValueError)
    if kind is GraspEnv:
        with pytest.raises(TypeError, match=keyword):
            gymnasium.make("thermograsp/Grasp-v0", **cast(Any, {keyword: 1.0}))


def test_nothing_is_loaded_that_only_draws():
    """A simulation without pictures loads neither matplotlib nor rich nor Pillow."""
    code = (
        "import sys, gymnasium, thermograsp, thermograsp.envs\n"
        "env = gymnasium.make('thermograsp/Grasp-v0', material='glass')\n"
        "envs = gymnasium.make_vec('thermograsp/Grasp-v0', 2, 'vector_entry_point', material='glass')\n"
        "for one in (env, envs):\n"
        "    one.reset(seed=0)\n"
        "    one.step(one.action_space.sample())\n"
        "print([name for name in ('matplotlib', 'rich', 'PIL') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
