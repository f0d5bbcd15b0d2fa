"""Grippers that nobody here wrote, from the wheels of robosuite, dm_control and gymnasium-robotics: each of them grasps
a cube and a cylinder and feels glass against aluminium. `make test-grippers` installs them."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import importlib.util
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, Literal

import gymnasium
import mujoco
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments
from thermograsp.agents.gripper_check import MOST_SLIP, check_gripper
from thermograsp.agents.learning import learning_task, score
from thermograsp.cli import main
from thermograsp.envs import (
    Gripper,
    Mechanics,
    ObjectSpec,
    action_of,
    fit_fingertip,
    load_gripper,
)


@dataclass(frozen=True)
class Packaged:
    """A gripper in somebody's wheel. package, path: of its file. radians: a fragment of a file in radians. servos:
    joints that get position servos, for a file whose own package adds actuators in Python. options: of load_gripper.
    fingers: parts of the names of the two bodies that are to be found."""

    package: str
    path: str
    fingers: tuple[str, str]
    radians: bool = False
    servos: tuple[str, ...] = ()
    options: dict[str, Any] = field(default_factory=dict)

    def file(self) -> Path:
        found = importlib.util.find_spec(self.package)
        if found is None or not found.submodule_search_locations:
            pytest.skip(f"needs {self.package}: make test-grippers")
        return Path(found.submodule_search_locations[0]) / self.path

    def source(self) -> Path | mujoco.MjSpec:
        file = self.file()
        if not self.radians and not self.servos:
            return file
        spec = mujoco.MjSpec.from_file(str(file))
        if self.radians:
            spec.compiler.degree = False
        for joint in self.servos:
            servo = spec.add_actuator(name=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=joint)
            servo.set_to_position(kp=20)
        return spec


def robosuite(name: str, *fingers: str, **options: Any) -> Packaged:
    return Packaged("robosuite", f"models/assets/grippers/{name}.xml", fingers, radians=True, options=options)  # pyright: ignore[reportArgumentType]


PAGE = (Path(__file__).parents[2] / "docs" / "grippers.md").read_text(encoding="utf-8")
HANDS = "envs/assets"
GRIPPERS = {
    "Franka hand": robosuite("panda_gripper", "leftfinger", "rightfinger"),
    "Rethink": robosuite("rethink_gripper", "l_finger", "r_finger"),
    "Robotiq 2F-140": robosuite("robotiq_gripper_140", "left_inner_finger", "right_inner_finger"),
    "Boston Dynamics": robosuite("bd_gripper", "mover", "stator"),
    "Kinova three fingers": robosuite("jaco_three_finger_gripper", "thumb_distal", "index_distal"),
    "Inspire hand": robosuite("inspire_left_hand", "thumb_distal", "index_distal"),
    "Inspire hand, thumb and middle": robosuite(
        "inspire_left_hand", "thumb_distal", "middle_distal", fingertips=("thumb", "middle")
    ),
    "Fourier hand": robosuite("fourier_left_hand", "thumb_distal", "index"),
    "Kinova of dm_control": Packaged(
        "dm_control",
        "third_party/kinova/jaco_hand.xml",
        ("finger_1", "finger_"),
        servos=("finger_1", "finger_2", "finger_3"),
    ),
    "Fetch, the whole robot": Packaged(
        "gymnasium_robotics", f"{HANDS}/fetch/pick_and_place.xml", ("r_gripper_finger", "l_gripper_finger")
    ),
    "Shadow hand": Packaged("gymnasium_robotics", f"{HANDS}/hand/reach.xml", ("ff", "th")),
    "Adroit hand": Packaged(
        "gymnasium_robotics", f"{HANDS}/adroit_hand/adroit_pen.xml", ("distal", "thdistal")
    ),
}


@cache
def loaded(name: str) -> Gripper:
    packaged = GRIPPERS[name]
    return load_gripper(packaged.source(), **packaged.options)


@pytest.mark.parametrize("name", GRIPPERS)
def test_its_fingers_are_found(name: str):
    gripper = loaded(name)
    for finger, part in zip(gripper.fingers, GRIPPERS[name].fingers, strict=True):
        assert part in finger, gripper
    assert gripper.widest > 0.047 and gripper.widest - gripper.narrowest > 0.04
    assert gripper.flat[0] < 0.04 < gripper.flat[1]


@pytest.mark.parametrize("shape", ["box", "cylinder"])
@pytest.mark.parametrize("name", GRIPPERS)
def test_it_grasps_holds_and_feels(name: str, shape: Literal["box", "cylinder"]):
    check = check_gripper(loaded(name), shape=shape)
    assert check.passed, check.problem
    assert check.width == pytest.approx(0.04)
    glass, aluminium = check.trials
    assert min(aluminium.drop) > 1.5 * max(glass.drop)
    for trial in check.trials:
        assert trial.slip < MOST_SLIP
        assert trial.force == pytest.approx((check.limit, check.limit), rel=0.1)


@pytest.mark.parametrize("name", GRIPPERS)
def test_the_opening_is_the_distance_of_the_pads(name: str):
    gripper = loaded(name)
    thick = max(0.01, gripper.narrowest + 0.002)
    away = ObjectSpec(size=(thick, 0.01, 0.04), position=(0.0, 0.09))
    mechanics = Mechanics((away,), gripper=gripper)
    model, data = mechanics.env_model(0), mechanics.env_data(0)
    for opening in np.linspace(max(gripper.narrowest, 0.005), gripper.widest, 4):
        for _ in range(75):
            motion = mechanics.advance(np.full(1, opening), np.full(1, 10.0), np.zeros(1))
        mechanics.env_data(0, data)
        mujoco.mj_forward(model, data)
        spots = [data.site(f"pad_{tip}").xpos for tip in ("left", "right")]
        assert motion.opening[0] == pytest.approx(opening, abs=5e-4)  # pyright: ignore[reportPossiblyUnboundVariable]
        assert spots[1][0] - spots[0][0] == pytest.approx(opening, abs=1e-3)


@pytest.mark.parametrize("name", GRIPPERS)
def test_the_page_has_what_is_found(name: str):
    row = next(line for line in PAGE.splitlines() if line.startswith(f"| {name} |"))
    _, package, fingers, opens, flat, most = (cell.strip() for cell in row.strip("|").split("|"))
    gripper = loaded(name)
    assert (package, fingers) == (GRIPPERS[name].package, ", ".join(gripper.fingers))
    for cell, found in ((opens, (gripper.narrowest, gripper.widest)), (flat, gripper.flat)):
        assert [float(end) / 1e3 for end in cell.split("..")] == pytest.approx(found, abs=4.5e-3)
    assert float(most) == pytest.approx(gripper.strongest, abs=0.5)


@pytest.mark.parametrize("name", GRIPPERS)
def test_fingertips_fit_on_the_file_as_it_is(name: str):
    """Both compile into the whole of it, and feel nothing while nothing touches them."""
    source = GRIPPERS[name].source()
    spec = mujoco.MjSpec.from_file(str(source)) if isinstance(source, Path) else source
    for number, finger in enumerate(loaded(name).fingers):
        report = fit_fingertip(spec, finger, name=f"mine_{number}")
        assert report.area > 20e-6
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 20)
    assert np.isfinite(data.qpos).all()
    for number in range(2):
        assert len(data.sensor(f"contact_mine_{number}").data) == 7


@pytest.mark.parametrize("name", ["Robotiq 2F-140", "Fetch, the whole robot", "Adroit hand"])
def test_the_shipped_agent_grasps_with_what_it_has_never_met(name: str):
    """Butter too, which breaks where fingers hit it with more than 12 N."""
    task = learning_task("grasp")
    keywords = {**task.keywords, "gripper": loaded(name), "material": ["butter", "iron"]}
    assert score(replace(task, keywords=keywords), "trained", 16, load=False).successes >= 15


@pytest.mark.parametrize("name", ["Robotiq 2F-140", "Fetch, the whole robot", "Adroit hand"])
def test_the_shipped_agent_identifies_with_what_it_has_never_met(name: str):
    """Fingers that touch some milliseconds earlier than its own make steel no aluminium."""
    task = learning_task("identify")
    keywords = {**task.keywords, "gripper": loaded(name)}
    assert score(replace(task, keywords=keywords), "trained", 32, load=False).successes >= 30


def test_the_force_of_a_franka_hand_is_that_of_its_joints():
    """Each of its fingers slides with the force of its own actuator, 20 N at most."""
    gripper = loaded("Franka hand")
    assert gripper.strongest == pytest.approx(20.0)
    assert list(gripper.actuator_limits(5.0).values()) == pytest.approx([5.0, 5.0])


def test_a_file_is_all_that_an_environment_needs():
    file = GRIPPERS["Fetch, the whole robot"].file()
    env = gymnasium.make("thermograsp/Grasp-v0", gripper=str(file), material="glass")
    env.reset(seed=0)
    for _ in range(80):
        observation, *_ = env.step(action_of(0.0, 10.0, 0.0))
    assert observation["force"][:, 0].min() > 5.0  # pyright: ignore[reportPossiblyUnboundVariable]


def test_a_fragment_in_radians_is_recognised():
    with pytest.raises(ValueError, match="in radians"):
        load_gripper(GRIPPERS["Robotiq 2F-140"].file())


def test_the_command_says_that_it_is_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file = GRIPPERS["Franka hand"].file()
    assert main(["gripper", "check", str(file)]) == 0
    output = capsys.readouterr().out
    assert "fit: it grasps, holds and feels" in output and "leftfinger" in output
