"""The pads of others' hands lie on the side to which their fingers bend."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.touch.scene import Fingertip, PadPlace, pads

ROBOTICS, SUITE = "gymnasium_robotics", "robosuite"
SHORT = ("ff", "mf", "rf", "lf", "th")
LONG = ("index", "middle", "ring", "pinky", "thumb")
HANDS = {  # package, file, names of the fingertips' bodies, the thumb last
    "Shadow": (ROBOTICS, "envs/assets/hand/manipulate_block.xml", [f"robot0:{n}distal" for n in SHORT]),
    "Adroit": (ROBOTICS, "envs/assets/adroit_hand/adroit_relocate.xml", [f"{n}distal" for n in SHORT]),
    "Inspire": (SUITE, "models/assets/grippers/inspire_right_hand.xml", [f"r_{n}_distal" for n in LONG]),
    "Jaco": (
        SUITE,
        "models/assets/grippers/jaco_three_finger_gripper.xml",
        [f"{n}_distal" for n in ("index", "pinky", "thumb")],
    ),
    "Fourier": (
        SUITE,
        "models/assets/grippers/fourier_right_hand.xml",
        [*(f"R_{n}_intermediate_link" for n in LONG[:4]), "R_thumb_distal_link"],
    ),
}


def in_world(data: mujoco.MjData, tips: list[str], vectors: list[np.ndarray]) -> np.ndarray:
    """(F, 3) of vectors in the frames of the fingertips' bodies."""
    return np.array(
        [data.body(tip).xmat.reshape(3, 3) @ each for tip, each in zip(tips, vectors, strict=True)]
    )


def middles(data: mujoco.MjData, tips: list[str], places: Sequence[PadPlace]) -> np.ndarray:
    """(F, 3) m of the pads."""
    return in_world(data, tips, [pad.position for pad in places]) + [data.body(tip).xpos for tip in tips]


@pytest.mark.parametrize("hand", HANDS)
def test_fingers_of_a_hand_move_towards_where_their_pads_look_as_they_bend(hand: str) -> None:
    package, file, tips = HANDS[hand]
    found = importlib.util.find_spec(package)
    if found is None or not found.submodule_search_locations:
        pytest.skip(f"needs {package}: make test-engines")
    model = mujoco.MjModel.from_xml_path(str(Path(found.submodule_search_locations[0]) / file))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    places = pads(model, {tip: Fingertip(tip) for tip in tips}, ())
    looks = in_world(data, tips, [pad.axes[:, 0] for pad in places])
    before = middles(data, tips, places)
    for tip in tips:
        joint = int(model.body_jntadr[model.body(tip).id])
        bend = max(model.jnt_range[joint], key=abs)
        data.qpos[model.jnt_qposadr[joint]] = 0.02 * bend
    mujoco.mj_kinematics(model, data)
    moved = middles(data, tips, places) - before
    assert (np.einsum("fi,fi->f", moved, looks) > 0.7 * np.linalg.norm(moved, axis=1)).all()
