"""What is given in place of a number, a list or a name is refused in the package's words, not NumPy's or Python's."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermograsp import agents, dataset, thermal
from thermograsp.agents import learning
from thermograsp.dataset import Plan
from thermograsp.envs import (
    Delay,
    GraspBatch,
    GraspTask,
    GraspVectorEnv,
    Mechanics,
    ObjectSpec,
    SimulatedPlant,
    SimulationConfig,
    Size,
    SortVectorEnv,
    action_of,
    library_object,
    load_gripper,
)
from thermograsp.errors import InvalidValueError, ThermograspError, UnknownNameError
from thermograsp.hardware import open_gripper
from thermograsp.thermal import Identifier, Thermostat, TouchSetup, sensor
from thermograsp.touch import Fingertip, ThermalBody

Call = Callable[[Any], Any]
NO_COUNTS: tuple[Any, ...] = (2.5, "2", None, True, -1, [2], float("nan"))
NOT_THREE: tuple[Any, ...] = (0.04, "abc", None, (0.04, 0.04), (0.04, 0.04, "x"), (0.04, 0.04, float("nan")))
COUNTS: dict[str, Call] = {
    "num_envs": GraspBatch,
    "num_envs ": GraspVectorEnv,
    "num_envs  ": SortVectorEnv,
    "num_envs   ": lambda value: SimulatedPlant(value, SimulationConfig()),
    "num_envs    ": lambda value: Mechanics(num_envs=value),
    "threads": lambda value: SimulationConfig(threads=value),
    "substeps": lambda value: SimulationConfig(substeps=value),
    "episodes": lambda value: learning.score("identify", "zero", value),
    "episodes ": lambda value: agents.rollout(None, value, 0),  # pyright: ignore[reportArgumentType]
    "seed": lambda value: agents.rollout(None, 1, value),  # pyright: ignore[reportArgumentType]
    "shard_size": lambda value: Plan(shard_size=value),
    "workers": lambda value: dataset.make(Plan(episodes=1), "never made", value),
    "batch_size": lambda value: next(dataset.iterate("not there", value)),
    "most": Delay,
}
THREE: dict[str, Call] = {
    "object_size": lambda value: thermal.press("glass", object_size=value),
    "object_size ": lambda value: TouchSetup(object_size=value),
    "size, the full extents": lambda value: ObjectSpec(size=value),
    "position": lambda value: Fingertip("tip", position=value, normal=(0, 0, 1)),
}
OTHERS: list[tuple[Call, Any, str]] = [
    (lambda value: SimulationConfig(placement=value), 0.002, "placement .* must be 2 finite numbers"),
    (lambda value: GraspBatch(sensor=value), 3, "unknown sensor 3; known: "),
    (lambda value: GraspBatch(sensor=value), ["seed"], r"unknown sensor \['seed'\]; known: "),
    (lambda value: SimulationConfig(randomize=value), 3, "randomize must be a list"),
    (lambda value: SimulationConfig(solver=value), 3, "solver must be SolverSettings"),
    (lambda value: GraspBatch(plant=value), 3, "unknown plant '3'; known: "),
    (lambda value: GraspVectorEnv(plant=value), None, "unknown plant 'None'; known: "),
    (
        lambda value: SimulationConfig(anywhere=value),
        "yes",
        "anywhere must be True, False or 'auto', got 'yes'",
    ),
    (lambda value: SimulationConfig(cache=value), 0.5, "cache must be True or False, got 0.5"),
    (lambda value: SimulationConfig(objects=value).shapes, [], "objects is an empty list"),
    (lambda value: ObjectSpec(position=value), 3, "position must be 2 finite numbers, got 3"),
    (lambda value: ObjectSpec(elements=value), 5, "elements .* must be 2 finite numbers, got 5"),
    (
        lambda value: SimulationConfig(signal=value).chain,
        ["ideal"],
        r"signal must be one of .* got \['ideal'\]",
    ),
    (lambda value: ObjectSpec(name=value), 3, "name must be a printable string, got 3"),
    (lambda value: ObjectSpec(name=value), "a\0b", "name must be a printable string, got 'a.x00b'"),
    (lambda value: ObjectSpec(rgba=value), "red", "rgba .* must be 4 finite numbers, got 'red'"),
    (lambda value: ObjectSpec(rgba=value), (255, 0, 0, 1), "rgba must be four numbers, each 0 to 1, got"),
    (lambda value: action_of(value, 0.0, 0.0), "wide", "opening must be a number in m, .* got 'wide'"),
    (
        lambda value: GraspVectorEnv(2, material="glass").step(value),
        [[0, 0, 0], [0, 0]],
        r"step takes actions of shape \(2, 3\), one for each environment; got \(2,\)",
    ),
    (lambda value: ObjectSpec(mass=value), 1e4, "mass 10000 kg: give 0 to 1000 kg"),
    (lambda value: ObjectSpec(yaw=value), 45.0, "45 looks like degrees: give 0.785398"),
    (lambda value: Plan(env_id=value), 3, "env_id must be the name of an environment, such as .* got 3"),
    (lambda value: Plan(env_id=value), "", "env_id must be the name of an environment"),
    (
        lambda value: agents.rollout(value, 1, 0),
        None,
        "env must be a vector environment, got None: make one by",
    ),
    (
        lambda value: agents.rollout(value, 1, 0),
        "thermograsp/Grasp-v0",
        "env must be a vector environment, got 'th",
    ),
    (lambda value: ThermalBody("glass", elements=value), 3, "elements must be a list of SensorElement"),
    (lambda value: GraspBatch(thermostat=value), 36.0, "thermostat must be a thermal.Thermostat"),
    (lambda value: GraspTask(seconds=value), "10", "seconds must be a number, got '10'"),
    (lambda value: GraspTask(hold_seconds=value), None, "hold_seconds must be a number"),
    (lambda value: GraspTask(most_slip=value), float("nan"), "most_slip must be a finite number"),
    (lambda value: GraspVectorEnv(width=value), "640", "width must be a whole number"),
    (lambda value: Size(value), 1.5, "factors must be a list"),  # pyright: ignore[reportArgumentType]
    (library_object, 3, "unknown object 3; known: "),
    (open_gripper, 3, "unknown gripper '3'; known: "),
    (lambda value: thermal.press("glass", thermostat=value), 36.0, "thermostat must be a thermal.Thermostat"),
    (lambda value: TouchSetup(conductance=value), 1e4, "conductance .* must be 2 finite numbers"),
    (
        lambda value: TouchSetup(object_temperature=value),
        24,
        "object_temperature .* must be 2 finite numbers",
    ),
    (lambda value: TouchSetup(stack=value), 3, "unknown sensor 3; known: "),
    (lambda value: Plan(materials=value), "glass", "materials must be a list"),
    (lambda value: Plan(materials=value), ("glas",), "unknown material 'glas'; did you mean 'glass'"),
    (lambda value: Plan(keywords=value), 3, "keywords must be a dictionary"),
    (lambda value: learning.score(value, "zero", 1), "grsp", "unknown task 'grsp'; did you mean 'grasp'"),
]


@pytest.mark.parametrize("value", NO_COUNTS, ids=repr)
@pytest.mark.parametrize("name", COUNTS)
def test_no_count(name: str, value: Any) -> None:
    with pytest.raises(
        InvalidValueError, match=f"{name.strip()}.* must be a whole number, [01] or above, got "
    ):
        COUNTS[name](value)


@pytest.mark.parametrize("value", NOT_THREE, ids=repr)
@pytest.mark.parametrize("name", THREE)
def test_not_three_numbers(name: str, value: Any) -> None:
    if name != "position" or value is not None:  # which is left out then
        with pytest.raises(InvalidValueError, match=f"{name.strip()}.* must be 3 finite numbers, got "):
            THREE[name](value)


@pytest.mark.parametrize(("call", "value", "message"), OTHERS, ids=[message for _, _, message in OTHERS])
def test_something_else(call: Call, value: Any, message: str) -> None:
    with pytest.raises((InvalidValueError, UnknownNameError), match=message):
        call(value)


@pytest.mark.parametrize("seed", [1.5, "1", -1, True], ids=repr)
def test_no_seed_and_no_options(seed: Any) -> None:
    env = GraspVectorEnv(2, material="glass")
    with pytest.raises(InvalidValueError, match="seed must be a whole number, 0 or above, got "):
        env.reset(seed=seed)
    with pytest.raises(InvalidValueError, match="options must be a dict, such as "):
        env.reset(options=seed)
    env.close()


def test_fingers_and_actuators_that_are_no_names() -> None:
    from thermograsp.assets import asset

    wrong: list[dict[str, Any]] = [{"fingertips": 3}, {"actuators": 3}, {"actuators": "closing"}]
    for keywords in wrong:
        with pytest.raises(ThermograspError, match="name two that close|actuators must be a list of names"):
            load_gripper(asset("gripper.xml"), **keywords)


def test_samples_that_are_no_numbers() -> None:
    identifier = Identifier(TouchSetup(), ["glass"])
    with pytest.raises(InvalidValueError, match="t and voltage must be arrays of numbers"):
        identifier.update(np.arange(3.0), "abc")  # pyright: ignore[reportArgumentType]


def test_a_thermostat_keeps_all_but_its_setpoint() -> None:
    from thermograsp.thermal.readout import thermostat_at

    found = thermostat_at(30.0, Thermostat(power_limit=2.0), sensor("seed"), 0.01)
    assert found == Thermostat(setpoint=30.0, power_limit=2.0)
