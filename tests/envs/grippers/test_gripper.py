"""Grippers that nobody prepared for us, small ones written for the purpose: found, mounted, driven, felt."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import gymnasium
import mujoco
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments
from thermograsp.assets import asset
from thermograsp.envs import (
    GraspEnv,
    Gripper,
    Mechanics,
    ObjectSpec,
    action_of,
    load_gripper,
)
from thermograsp.envs.grippers.shipped import SHIPPED_GRIPPER
from thermograsp.errors import GripperError, InvalidValueError, UnknownNameError

from ..synthetic_grippers import (
    COUPLED,
    HINGE,
    LONE_JAW,
    MESH,
    MOTORS,
    POSITIONS,
    ROUND,
    TENDON,
    THREE,
    TWO_ARMS,
    parallelograms,
    slides,
    two_arms,
)

TWO = {
    "positions": slides(POSITIONS),
    "motors": slides(MOTORS),
    "tendon": slides(TENDON),
    "coupled": slides(COUPLED),
    "turned": slides(POSITIONS, 'pos=".3 -1 .5" euler="70 20 130"'),
    "upside down": slides(POSITIONS, 'euler="180 0 0"'),
    "lone jaw": LONE_JAW,
    "hinges": HINGE,
    "three": THREE,
    "parallelograms": parallelograms(),
}
SLIDES = [name for name in TWO if name not in ("hinges", "lone jaw", "three", "parallelograms")]
WIDEST = 0.08  # m, 92 mm between the faces less two fingertips


def read(text: str, **options: object) -> Gripper:
    return load_gripper(mujoco.MjSpec.from_string(text), **options)  # pyright: ignore[reportArgumentType]


def drive(mechanics: Mechanics, seconds: float, opening: float = 0.0, force: float = 8.0, lift: float = 0.0):
    n = mechanics.num_envs
    for _ in range(round(seconds / 0.02) - 1):
        mechanics.advance(np.full(n, opening), np.full(n, force), np.full(n, lift))
    record = mechanics.step(np.full(n, opening), np.full(n, force), np.full(n, lift))
    assert not record.failed.any(), mechanics.failure
    return record


def pad_sites(mechanics: Mechanics) -> list[Any]:
    """Of environment 0, as it is."""
    model, data = mechanics.env_model(0), mechanics.env_data(0)
    mujoco.mj_forward(model, data)
    return [data.site(f"pad_{tip}") for tip in ("left", "right")]


def pad_frames(mechanics: Mechanics) -> np.ndarray:
    """(2, 3, 3): columns are the pads' axes in the world: out of the pad, across, towards the wrist."""
    return np.array([site.xmat.reshape(3, 3).copy() for site in pad_sites(mechanics)])


def pad_places(mechanics: Mechanics) -> np.ndarray:
    """(2, 3) m, the pads' middles."""
    return np.array([site.xpos.copy() for site in pad_sites(mechanics)])


@pytest.mark.parametrize("name", SLIDES)
def test_a_sliding_gripper_is_what_its_file_says(name: str):
    gripper = read(TWO[name])
    assert sorted(gripper.fingers) == ["one", "two"] and gripper.palm == "base"
    assert sorted(gripper.pads) == ["face_one", "face_two"]
    assert gripper.areas == pytest.approx((0.024 * 0.06,) * 2)
    assert gripper.wedges == pytest.approx((0.0, 0.0), abs=1e-4)
    assert (gripper.narrowest, gripper.widest) == pytest.approx((0.0, WIDEST), abs=1e-5)


@pytest.mark.parametrize(
    ("rest", "newtons", "strongest"),
    # of each actuator for a newton on the pads, by the virtual work of a newton through the opening
    [
        (POSITIONS, {"push_one": 1.0, "push_two": 1.0}, 15.0),
        (MOTORS, {"push_one": 1.0, "push_two": 0.5}, 8.0),
        (TENDON, {"pull": 1.0}, 30.0),
        (COUPLED, {"push": 2.0}, 40.0),
    ],
)
def test_forces_of_actuators_follow_from_the_force_on_the_pads(
    rest: str, newtons: dict[str, float], strongest: float
):
    gripper = read(slides(rest))
    assert gripper.actuator_limits(1.0) == pytest.approx(newtons, rel=1e-6)
    assert gripper.strongest == pytest.approx(strongest)


def test_the_controls_of_an_opening_are_those_of_the_joints():
    gripper = read(slides(POSITIONS))
    for opening in (0.0, 0.031, WIDEST):
        inwards = (0.08 - opening) / 2
        assert gripper.control(opening) == pytest.approx({"push_one": inwards, "push_two": inwards}, abs=1e-5)


@pytest.mark.parametrize("name", TWO)
def test_it_grasps_lifts_and_holds_with_the_force_of_the_limit(name: str):
    mechanics = Mechanics((ObjectSpec(mass=0.1),), gripper=read(TWO[name]))
    closed = drive(mechanics, 1.4)
    assert closed.touching[0, -1].all()
    drive(mechanics, 1.0, lift=0.05)
    before = drive(mechanics, 0.4)
    after = drive(mechanics, 2.0)
    assert after.force[0, -1, :, 0, 0] == pytest.approx((8.0, 8.0), rel=0.05)
    assert after.object_pose[0, -1, 0, 2] - 0.02 == pytest.approx(0.05, abs=2e-3)
    assert np.linalg.norm(after.object_pose[0, -1, 0, :3] - before.object_pose[0, -1, 0, :3]) < 2e-4
    # both pads together carry the weight, upwards, whatever the file's frame was
    upwards = pad_frames(mechanics)[:, 2]
    assert (upwards * after.force[0, -1, :, 0]).sum() == pytest.approx(0.1 * 9.81, rel=0.02)


@pytest.mark.parametrize("name", TWO)
def test_the_pads_meet_about_the_grasp_centre_and_the_reading_is_their_distance(name: str):
    gripper = read(TWO[name])
    mechanics = Mechanics((ObjectSpec(size=(0.01, 0.01, 0.04), position=(0.0, 0.09)),), gripper=gripper)
    for opening in (0.06, 0.04, 0.025):
        record = drive(mechanics, 1.2, opening=opening)
        spots = pad_places(mechanics)
        assert record.opening[0, -1] == pytest.approx(opening, abs=1e-4)
        assert spots[1, 0] - spots[0, 0] == pytest.approx(opening, abs=6e-4)
        if name != "lone jaw":
            assert spots.mean(axis=0)[:2] == pytest.approx((0.0, 0.0), abs=6e-4)
    frames = pad_frames(mechanics)
    lean = 1e-2 if name != "hinges" else 0.2
    assert frames[:, :, 0] == pytest.approx(np.array([[1.0, 0, 0], [-1.0, 0, 0]]), abs=lean)
    assert frames[:, 2, 2] == pytest.approx((1.0, 1.0), abs=lean)


def test_hinged_fingers_are_fitted_so_that_the_pads_are_parallel_where_asked():
    for opening in (0.03, 0.05):
        gripper = read(HINGE, parallel_at=opening)
        mechanics = Mechanics((ObjectSpec(size=(0.01, 0.01, 0.04), position=(0.0, 0.09)),), gripper=gripper)
        drive(mechanics, 1.5, opening=opening)
        assert pad_frames(mechanics)[:, :, 0] == pytest.approx(
            np.array([[1.0, 0, 0], [-1.0, 0, 0]]), abs=0.02
        )
    assert gripper.flat[0] < 0.05 < gripper.flat[1]


def test_a_closed_linkage_swings_as_its_lengths_say():
    """Fingers on cranks of length l at angle a are 2 l sin a nearer, and stay parallel. Each newton on a pad takes
    2 l cos a on the one driven crank, which moves both."""
    gripper = read(parallelograms())
    assert gripper.fingers == ("finger_one", "finger_two")
    assert gripper.wedges == pytest.approx((0.0, 0.0), abs=1e-3)
    between = 0.08 - 2 * 0.003 - 2 * 0.006  # m, of the fingertips at angle 0
    for opening in (0.03, between, 0.075):
        angle = np.arcsin((between - opening) / (2 * 0.06))
        assert gripper.control(opening)["turn"] == pytest.approx(angle, abs=2e-3)
    at = np.arcsin((between - 0.04) / (2 * 0.06))
    assert gripper.actuator_limits(1.0)["turn"] == pytest.approx(2 * 0.06 * np.cos(at), rel=0.01)
    assert gripper.flat == (gripper.narrowest, gripper.widest)


def test_the_command_is_bounded_by_what_the_gripper_can():
    gripper = read(slides(MOTORS))
    mechanics = Mechanics((ObjectSpec(mass=0.1),), gripper=gripper)
    assert mechanics.opening[0] == pytest.approx(WIDEST, abs=1e-5)
    assert drive(mechanics, 1.0, opening=0.085).opening[0, -1] == pytest.approx(WIDEST, abs=1e-4)
    assert drive(mechanics, 1.5, force=40.0).force[0, -1, :, 0, 0] == pytest.approx((8.0, 8.0), rel=0.02)
    with pytest.raises(InvalidValueError, match="opening"):
        drive(mechanics, 0.02, opening=0.2)


def test_an_object_that_does_not_fit_is_refused():
    gripper = read(slides())
    with pytest.raises(InvalidValueError, match=r"80.0 mm wide along x, slides opens 80.0 mm"):
        Mechanics((ObjectSpec(size=(0.08, 0.02, 0.04)),), gripper=gripper)
    ajar = read(slides(POSITIONS.replace("0 .045", "0 .035").replace("0 .045", "0 .035")))
    with pytest.raises(InvalidValueError, match=r"8.0 mm thin along x, slides closes to 10.0 mm"):
        Mechanics((ObjectSpec(size=(0.008, 0.02, 0.04)),), gripper=ajar)
    tall = ObjectSpec(size=(0.04, 0.04, 0.2), elements=(0.009, 0.003))
    with pytest.raises(InvalidValueError, match="reaches"):
        Mechanics((tall,), gripper=gripper)


@pytest.mark.parametrize("tips", [("thumb", "pinky"), ("thu", "ind"), ("index", "thumb")])
def test_fingertips_go_where_they_are_named(tips: tuple[str, str]):
    gripper = read(THREE, fingertips=tips)
    assert all(any(tip in finger for finger in gripper.fingers) for tip in tips)


def test_the_third_finger_closes_along():
    gripper = read(THREE, fingertips=("thumb", "index"))
    model = Mechanics((ObjectSpec(),), gripper=gripper).model
    (pinky,) = (j for j in gripper.polynomials if gripper.model.joint(j).name == "pinky")
    (index,) = (j for j in gripper.polynomials if gripper.model.joint(j).name == "index")
    for opening in (0.02, 0.07):
        half = opening / 2
        openings = [np.polynomial.polynomial.polyval(half, gripper.polynomials[j]) for j in (pinky, index)]
        assert openings[0] == pytest.approx(openings[1], abs=1e-4)
    assert model.njnt == 3 + 1 + 1 + 4 + 1  # fingers, drive, lift, hinges of the tips, the object's


def test_pads_can_be_placed_by_hand():
    here = ((0.0, 0.0, -0.01), (1.0, 0.0, 0.0))
    second = ((0.0, 0.0, -0.01), (-1.0, 0.0, 0.0))
    gripper = read(ROUND, fingertips=("one", "two"), pads=(here, second))
    assert gripper.pads == ("given", "given")
    mechanics = Mechanics((ObjectSpec(mass=0.05),), gripper=gripper)
    assert drive(mechanics, 1.4, force=5.0).force[0, -1, :, 0, 0] == pytest.approx((5.0, 5.0), rel=0.02)


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (slides(""), {}, "no actuator moves a joint"),
        (ROUND, {}, "flat faces"),
        (ROUND, {"fingertips": ("one", "two")}, "no flat face"),
        (slides(), {"actuators": ["push_one", "pull_two"]}, "unknown actuator 'pull_two'"),
        (slides(), {"fingertips": ("one", "three")}, "unknown finger or body 'three'"),
        (slides(), {"fingertips": ("one",)}, "name two"),
        (slides(), {"fingertips": ("one", "one")}, "name two"),
        (slides(), {"pads": ("face_two", None)}, "unknown geom"),
        (slides(), {"pads": (((0, 0), (1, 0, 0)), None)}, "position"),
        (slides(), {"parallel_at": -1.0}, "parallel_at"),
        (HINGE.replace('range="-40 20"', 'range="-.7 .35"'), {}, "1 degrees at most.*compiler angle=.radian"),
        (TWO_ARMS, {}, "not fingers of one hand. Name the actuators"),
        (two_arms(0.1, 0.1), {}, "not fingers of one hand. Name the actuators"),
        (two_arms(0.05, 0.04), {}, "not fingers of one hand. Name the actuators"),
        (TWO_ARMS, {"fingertips": ("left_one", "right_one")}, "not fingers of one hand"),
        (TWO_ARMS, {"fingertips": ("left_one", "left_two")}, "by way of arms"),
        (slides(POSITIONS.replace(".045", ".0001")), {}, "mm between"),
    ],
)
def test_what_cannot_grasp_is_refused_with_the_reason(text: str, options: dict[str, object], message: str):
    with pytest.raises((GripperError, UnknownNameError, InvalidValueError), match=message):
        read(text, **options)


def test_one_hand_of_two_arms_is_a_gripper_by_its_actuators():
    gripper = read(TWO_ARMS, actuators=("left_one", "left_two"))
    assert gripper.fingers == ("left_one", "left_two")
    assert gripper.widest == pytest.approx(WIDEST, abs=1e-4)


def test_a_name_of_two_digits_is_refused():
    with pytest.raises(InvalidValueError, match="several digits"):
        read(THREE, fingertips=("thumb", "in"))


def test_files_that_are_no_gripper_are_refused(tmp_path: Path):
    def write(name: str, content: str) -> Path:
        (tmp_path / name).write_text(content, encoding="utf-8")
        return tmp_path / name

    for file, message in (
        (tmp_path / "none.xml", "no file"),
        (tmp_path, "folder"),
        (write("text.xml", "my gripper, version 2"), "not XML"),
        (write("empty.xml", ""), "not XML"),
        (write("open.xml", "<mujoco><worldbody>"), "no MJCF"),
        (write("other.xml", "<robot name='r'/>"), "no MJCF|does not compile|no actuator"),
        (
            write("unknown.xml", slides("<actuator><motor joint='gone'/></actuator>")),
            "does not compile|no MJCF",
        ),
        (write("world.xml", "<mujoco/>"), "no actuator"),
        (write("mesh.xml", MESH), "not there, finger.stl: .*meshdir"),
        (write("include.xml", '<mujoco><include file="hand.xml"/></mujoco>'), "not there, hand.xml"),
    ):
        with pytest.raises(GripperError, match=message):
            load_gripper(file)


def test_what_is_no_file_is_refused():
    with pytest.raises(GripperError, match="give an MJCF file"):
        load_gripper(85)  # pyright: ignore[reportArgumentType]


def test_every_environment_takes_it(tmp_path: Path):
    file = tmp_path / "mine.xml"
    file.write_text(slides(name="mine"), encoding="utf-8")
    for name in ("Grasp", "Identify", "Sort"):
        material: dict[str, Any] = {"material": ["glass", "steel"] if name != "Grasp" else "glass"}
        env = gymnasium.make(f"thermograsp/{name}-v0", gripper=str(file), **material)
        shipped = gymnasium.make(f"thermograsp/{name}-v0", **material)
        assert env.observation_space == shipped.observation_space and env.action_space == shipped.action_space
        observation, _ = env.reset(seed=1)
        assert env.observation_space.contains(observation)
        for _ in range(3):
            observation, *_ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)


def test_glass_and_aluminium_feel_as_with_the_shipped_gripper():
    """The heat depends on force and patch only, which are the same."""
    drops = {}
    for gripper in (None, read(slides())):
        for material in ("glass", "aluminium"):
            env = gymnasium.make(
                "thermograsp/Grasp-v0", gripper=gripper, material=material, placement=(0.0, 0.0)
            )
            env.reset(seed=0)
            contact, info = 0, {}
            while contact < 50:
                *_, info = env.step(action_of(0.0, 10.0, 0.0))
                contact += bool(info["contact_area"].min() > 0)
            drops[gripper is None, material] = info["temperature_drop"]
    for material in ("glass", "aluminium"):
        assert drops[False, material] == pytest.approx(drops[True, material], rel=0.02)
    assert drops[False, "aluminium"].min() > 2 * drops[False, "glass"].max()


def test_a_vector_is_many_of_the_single_one_and_states_are_restored():
    gripper = read(HINGE)
    shapes = [(ObjectSpec(size=(d, d, 0.04), mass=0.1),) for d in (0.03, 0.04, 0.05)]
    many = Mechanics(shapes[0], 3, gripper=gripper)
    many.reset(objects=shapes)
    for k, objects in enumerate(shapes):
        one = Mechanics(objects, gripper=gripper)
        many.reset([k], [objects])
        assert one.opening[0] == many.opening[k]
    many.reset(objects=shapes)
    together = drive(many, 0.8)
    for k, objects in enumerate(shapes):
        one = Mechanics(shapes[0], gripper=gripper)
        one.reset(objects=[objects])
        alone = drive(one, 0.8)
        for field in ("force", "opening", "object_pose"):
            assert (getattr(alone, field)[0] == getattr(together, field)[k]).all()
    state = many.state()
    first = drive(many, 0.2)
    many.set_state(state)
    assert (drive(many, 0.2).object_pose == first.object_pose).all()


def test_a_gripper_can_be_copied_and_tells_what_it_is():
    gripper = read(slides())
    gripper.scene()
    copy = pickle.loads(pickle.dumps(gripper))
    assert str(copy) == str(gripper) and copy.document() == gripper.document()
    words = str(gripper)
    for part in ("palm 'base'", "1440 mm2 of geom 'face_one'", "0.0 to 80.0 mm", "push_two", "15 N"):
        assert part in words


def test_only_the_pads_collide_and_only_with_objects():
    model = Mechanics((ObjectSpec(),), gripper=read(THREE)).model
    colliding = {
        model.geom(g).name for g in range(model.ngeom) if model.geom_contype[g] or model.geom_conaffinity[g]
    }
    assert colliding == {"pad_left", "pad_right", "object_0", "floor", "table"}
    named = [
        (kind, i)
        for kind, n in (
            ("body", model.nbody),
            ("joint", model.njnt),
            ("geom", model.ngeom),
            ("equality", model.neq),
        )
        for i in range(n)
        if not getattr(model, kind)(i).name
    ]
    assert not named


def test_the_shipped_gripper_is_found_as_any_other_and_carries_a_second_pair_of_fingertips():
    gripper = load_gripper(asset("gripper.xml"))
    assert gripper.palm == "wrist" and gripper.fingers == ("finger_left", "finger_right")
    assert gripper.pads == ("pad_left", "pad_right")
    assert gripper.widest == pytest.approx(SHIPPED_GRIPPER.widest - 4 * 0.003, abs=1e-5)
    assert [actuator.name for actuator in gripper.actuators] == ["grip"]
    mechanics = Mechanics((ObjectSpec(mass=0.1),), gripper=gripper)
    assert drive(mechanics, 1.4).force[0, -1, :, 0, 0] == pytest.approx((8.0, 8.0), rel=0.01)


def test_the_shipped_gripper_answers_as_its_file_says():
    model = SHIPPED_GRIPPER.scene().compile()
    ranges = [model.joint(name).range for name in SHIPPED_GRIPPER.joints]
    assert sum(high for _, high in ranges) == pytest.approx(SHIPPED_GRIPPER.widest)
    assert model.actuator("grip").forcerange == pytest.approx(
        (-SHIPPED_GRIPPER.strongest, SHIPPED_GRIPPER.strongest)
    )
    places, values = SHIPPED_GRIPPER.rest(model, 0.05)
    assert values.sum() == pytest.approx(0.05)
    assert list(places) == [model.joint(name).qposadr[0] for name in SHIPPED_GRIPPER.joints]


def test_an_object_with_the_methods_of_a_model_is_the_gripper():
    own, shipped = GraspEnv(gripper=SHIPPED_GRIPPER, material="glass"), GraspEnv(material="glass")
    own.reset(seed=0)
    shipped.reset(seed=0)
    for _ in range(30):
        found, expected = (env.step(action_of(0.0, 10.0, 0.0))[0] for env in (own, shipped))
        assert all(np.array_equal(found[name], expected[name]) for name in expected)
    with pytest.raises(GripperError, match="give an MJCF file"):
        GraspEnv(gripper=object())
