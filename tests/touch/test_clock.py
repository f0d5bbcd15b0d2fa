"""Steps that MuJoCo takes in one call are heard by its clock, one by one, with the bits and the errors of a loop."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import ctypes
import importlib.util
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.touch.wrappers import AddThermalObservation, substeps
from thermograsp.touch.wrappers.clock import _clock

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

hears = pytest.mark.skipif(_clock() is None, reason="this MuJoCo's bindings have no clock")
PADS = {name: f"{name}_pad" for name in hand.FINGERS}
Steps = Callable[["Env", int], None]


class Env(gymnasium.Env):
    """steps: what an environment step is, of which number."""

    def __init__(self, steps: Steps) -> None:
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (2,), np.float64)
        self.action_space = gymnasium.spaces.Box(-20.0, 20.0, (1,), np.float32)
        self.model, self.data = hand.hand()
        self.other = mujoco.MjData(self.model)
        self.steps, self.count = steps, 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        super().reset(seed=seed)
        mujoco.mj_resetData(self.model, self.data)
        return self.data.qpos[:2].copy(), {}

    def step(self, action: Any) -> Any:
        hand.press(self.data, float(action[0]))
        self.count += 1
        self.steps(self, self.count)
        return self.data.qpos[:2].copy(), 0.0, False, False, {}


def _wrapped(env: gymnasium.Env) -> AddThermalObservation:
    return AddThermalObservation(env, fingertips=PADS, objects={"can": "aluminium"}, seed=0)


def _run(steps: Steps, wrap: Callable[[gymnasium.Env], AddThermalObservation] = _wrapped) -> list[Any]:
    """What 30 steps give: voltages, where the simulation is, and errors by name."""
    env, found = wrap(Env(steps)), []
    env.reset(seed=0)
    for _ in range(30):
        try:
            observation, _, _, _, info = env.step(np.array([10.0]))
            touch = info["touch"]
            found += [observation["voltage"], touch.voltage, touch.temperature_drop, touch.force, touch.time]
        except Exception as error:  # noqa: BLE001
            found.append(f"{type(error).__name__}: {error}")
            env.reset(seed=0)
        found.append(env.unwrapped.data.qpos.copy())
    return found


def _ten(env: Env, count: int) -> None:
    mujoco.mj_step(env.model, env.data, nstep=10)


def _by_name(env: Env, count: int) -> None:
    mujoco.mj_step(m=env.model, d=env.data, nstep=7)
    mujoco.mj_step(env.model, env.data, 3)


def _beside_readings(env: Env, count: int) -> None:
    """Calls that end amid what a reading is of."""
    mujoco.mj_step(env.model, env.data, 23)


def _none_or_fewer(env: Env, count: int) -> None:
    for nstep in (0, -3, 10):
        mujoco.mj_step(env.model, env.data, nstep)


def _of_others_too(env: Env, count: int) -> None:
    mujoco.mj_step(env.model, env.other, 5)
    mujoco.mj_step(env.model, env.data, 10)
    mujoco.mj_step(env.model, env.other, 5)


def _resets_inside(env: Env, count: int) -> None:
    mujoco.mj_step(env.model, env.data, 5)
    if count == 7:
        mujoco.mj_resetData(env.model, env.data)
    mujoco.mj_step(env.model, env.data, 5)


def _goes_back(env: Env, count: int) -> None:
    mujoco.mj_step(env.model, env.data, 10)
    if count == 7:
        env.data.time -= 0.01


def _breaks_down(env: Env, count: int) -> None:
    """MuJoCo warns and resets the data, amid its call."""
    if count == 7:
        env.data.qpos[0] = np.nan
    mujoco.mj_step(env.model, env.data, 10)


def _raises(env: Env, count: int) -> None:
    mujoco.mj_step(env.model, env.data, 10)
    if count == 7:
        raise RuntimeError("the environment's own")


def _fails_in_mujoco(env: Env, count: int) -> None:
    """An error of MuJoCo's, which its bindings raise."""
    if count == 7:
        env.model.opt.integrator = 17
    try:
        mujoco.mj_step(env.model, env.data, 10)
    finally:
        env.model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST


def _rk4(env: Env, count: int) -> None:
    env.model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    mujoco.mj_step(env.model, env.data, 10)


def _in_parts(env: Env, count: int) -> None:
    for _ in range(5):
        mujoco.mj_step1(env.model, env.data)
        mujoco.mj_step2(env.model, env.data)
    mujoco.mj_step(env.model, env.data, 5)


def _of_a_copy_of_the_model(env: Env, count: int) -> None:
    mujoco.mj_step(copy.copy(env.model) if count % 2 else env.model, env.data, 10)


@pytest.mark.parametrize(
    "steps",
    [
        *(
            _ten,
            _by_name,
            _beside_readings,
            _none_or_fewer,
            _of_others_too,
            _resets_inside,
            _goes_back,
            _breaks_down,
            _raises,
        ),
        *(_fails_in_mujoco, _rk4, _in_parts, _of_a_copy_of_the_model),
    ],
)
def test_a_call_is_heard_as_its_steps_one_by_one(steps: Steps, monkeypatch: pytest.MonkeyPatch) -> None:
    step, clocked = mujoco.mj_step, _run(steps)
    assert mujoco.mj_step is step
    monkeypatch.setattr(substeps, "heard_steps", lambda *_: False)
    one_by_one = _run(steps)
    if steps in (_resets_inside, _breaks_down):  # after an update that fails, a call goes on to its end
        one_by_one = [one for one in one_by_one if not isinstance(one, str)]
        errors = [one for one in clocked if isinstance(one, str)]
        assert len(errors) == 1 and errors[0].startswith("InvalidValueError: the data are at")
        clocked = [one for one in clocked if not isinstance(one, str)]
    assert len(clocked) == len(one_by_one)
    for one, other in zip(clocked, one_by_one, strict=True):
        np.testing.assert_array_equal(one, other)


def test_mujoco_has_a_clock() -> None:
    """In 3.3.0 it had none, and steps are taken one by one there."""
    version = tuple(int(part) for part in mujoco.__version__.split(".")[:3])
    assert (_clock() is not None) == (version >= (3, 3, 7)) or (3, 3, 0) < version < (3, 3, 7)


@hears
@pytest.mark.parametrize("count", [1, 3])
def test_only_one_call_of_compiled_code_hears_a_step(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Python makes the last reading, and has nothing else to do."""
    env, asked = _wrapped(Env(lambda env, _: mujoco.mj_step(env.model, env.data, 10 * count))), []
    env.reset(seed=0)
    for _ in range(20):
        env.step(np.array([10.0]))
    heard, update, due = env.touch.heard, env.touch.update, env.touch.due
    monkeypatch.setattr(env.touch, "heard", lambda *each: (asked.append(each), heard(*each))[1])
    monkeypatch.setattr(env.touch, "update", lambda data: (asked.append(data), update(data))[1])
    monkeypatch.setattr(env.touch, "due", lambda time: (asked.append(time), due(time))[1])
    env.step(np.array([10.0]))
    assert asked == [env.unwrapped.data.time] == [env.touch.reading.time]


@hears
def test_timers_go_on() -> None:
    env = Env(_ten)
    wrapped = _wrapped(env)
    wrapped.reset(seed=0)
    wrapped.step(np.array([10.0]))  # compiles
    before = [(each.duration, each.number) for each in env.data.timer]
    wrapped.step(np.array([10.0]))
    whole = mujoco.mjtTimer.mjTIMER_STEP
    assert env.data.timer[whole].number == before[whole][1] + 10
    assert 0 < env.data.timer[whole].duration - before[whole][0] < 60.0  # s, neither ticks nor us


def test_a_clock_of_one_s_own_stays_and_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    own = ctypes.CFUNCTYPE(ctypes.c_double)(lambda: (asked.append(0), 0.0)[1])
    expected = _run(_ten)
    mujoco.set_mjcb_time(own)
    try:
        found = _run(_ten)
        assert mujoco.get_mjcb_time() is own
    finally:
        mujoco.set_mjcb_time(None)
    assert asked
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_wrapper_in_a_wrapper_hears_the_same() -> None:
    inner = _wrapped(Env(_ten))

    class Renamed(gymnasium.ObservationWrapper):
        """Without the inner entry."""

        def __init__(self) -> None:
            super().__init__(inner)
            self.observation_space = inner.env.observation_space

        def observation(self, observation: Any) -> Any:
            return observation["observation"]

    outer = _wrapped(Renamed())
    outer.reset(seed=0)
    inner.touch.reset(inner.unwrapped.data, seed=0)
    for _ in range(30):
        outer.step(np.array([10.0]))
    assert (outer.touch.reading.temperature_drop > 1.0).all()
    for one in ("voltage", "temperature_drop", "force"):
        np.testing.assert_array_equal(
            getattr(inner.touch.reading, one), getattr(outer.touch.reading, one), err_msg=one
        )


def test_steps_of_another_thread_are_not_heard() -> None:
    expected, over, taken = _run(_ten), threading.Event(), [0]

    def beside() -> None:
        model, data = hand.hand()
        while not over.is_set():
            mujoco.mj_resetData(model, data)
            plain(model, data, 20)
            taken[0] += 1

    plain = mujoco.mj_step
    thread = threading.Thread(target=beside)
    thread.start()
    try:
        found = _run(_ten)
    finally:
        over.set()
        thread.join()
    assert taken[0] > 0
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one, other)


@hears
@pytest.mark.parametrize("error", [InvalidValueError, KeyboardInterrupt])
def test_what_python_raises_amid_a_call_arrives(
    error: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    step, env = mujoco.mj_step, _wrapped(Env(_ten))
    env.reset(seed=0)
    for _ in range(3):
        env.step(np.array([10.0]))
    monkeypatch.setattr(env.touch, "hearing", lambda data: 0)

    def fails(*_: Any) -> int:
        raise error("here")

    with monkeypatch.context() as patched:
        patched.setattr(env.touch, "heard", fails)
        with pytest.raises(error, match="here"):
            env.step(np.array([10.0]))
    assert mujoco.mj_step is step
    env.reset(seed=0)
    env.step(np.array([10.0]))
