"""Contacts read in arrays are those that the compiled reader reads."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from thermograsp.touch import Fingertip, prepare
from thermograsp.touch.contacts import (
    AREA,
    ASIDE,
    BESIDE,
    CONDUCTANCE,
    FORCE,
    LENGTH,
    ContactReader,
    TouchContacts,
    array_contacts,
    sense_contacts,
    sensor_places,
)
from thermograsp.touch.scene import bodies, pads

OBJECTS = {
    "box": '<geom type="box" size=".02 .015 .02" mass=".2"/>',
    "turned box": '<geom type="box" size=".02 .02 .02" euler="0 0 30" mass=".2"/>',
    "ball": '<geom type="sphere" size=".02" mass=".2"/>',
    "can": '<geom type="cylinder" size=".02 .03" mass=".2"/>',
    "lying can": '<geom type="cylinder" size=".02 .02" euler="0 90 0" mass=".2"/>',
    "mesh": '<geom type="mesh" mesh="tent" mass=".2"/>',
    "egg": '<geom type="ellipsoid" size=".02 .02 .03" mass=".2"/>',
    "turned egg": '<geom type="ellipsoid" size=".02 .008 .03" euler="0 40 20" mass=".2"/>',
}
SCENE = """
<mujoco><option timestep=".002" cone="elliptic" impratio="10"/><asset><mesh name="tent"
    vertex="-.02 -.02 -.02  .02 -.02 -.02  -.02 .02 -.02  .02 .02 -.02  -.015 0 .02  .015 0 .02"/></asset><worldbody>
  <body name="thing" euler="3 5 20"><joint type="ball" damping=".02"/>{}</body>
  <body name="left" pos="-.045 .004 .003"><joint name="left" type="slide" axis="1 0 0" damping="20"/>
    <geom name="left_pad" {} mass=".05"/></body>
  <body name="right" pos=".045 -.006 0"><joint name="right" type="slide" axis="-1 0 0" damping="20"/>
    <geom name="right_pad" {} mass=".05"/></body>
</worldbody><actuator><motor joint="left" gear="6"/><motor joint="right" gear="9"/></actuator></mujoco>"""
FLAT = {
    side: Fingertip(f"{side}_pad", position=(at, 0, 0), normal=(at, 0, 0), size=(0.016, 0.016))
    for side, at in (("left", 0.004), ("right", -0.004))
}
BOX, SMALL = 'type="box" size=".004 .008 .008"', 'type="box" size=".004 .003 .003"'
TIPS: dict[str, tuple[str, str, dict[str, str | Fingertip]]] = {
    "flat": (BOX, BOX, {**FLAT}),
    "narrow": (SMALL, SMALL, {side: replace(pad, size=(0.006, 0.006)) for side, pad in FLAT.items()}),
    "round": (
        'type="sphere" size=".008"',
        'type="capsule" size=".008 .01" euler="0 5 0"',
        {"left": "left_pad", "right": "right_pad"},
    ),
    "one round": (BOX, 'type="ellipsoid" size=".006 .008 .01"', {**FLAT, "right": "right_pad"}),
}


@pytest.mark.parametrize(
    ("shape", "tip"),
    [
        pytest.param(shape, tip, marks=pytest.mark.slow if shape == "mesh" and tip != "round" else ())
        for shape in OBJECTS
        for tip in TIPS
    ],
)
def test_it_reads_what_the_compiled_reader_reads(shape: str, tip: str) -> None:
    if not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors")
    # the tables of a mesh take long: its two are of one material
    materials = ("wood", "wood" if shape == "mesh" else "aluminium")
    left, right, fingers = TIPS[tip]
    # a capsule or an ellipsoid meets an edge beside its pad
    feeling = 1 if (shape, tip) in (("turned box", "round"), ("mesh", "one round")) else 2
    model = prepare(
        mujoco.MjSpec.from_string(SCENE.format(OBJECTS[shape], left, right)), fingers, {"thing": materials[0]}
    )
    kinds = [bodies(model, {"thing": name}, 24.0) for name in materials]
    tips = pads(model, fingers, kinds[0])
    contacts = array_contacts(model, tips, kinds, np.zeros(0))
    places = sensor_places(model, tips, kinds[0])
    readers = [ContactReader(model, tips, shapes, 1) for shapes in kinds]
    data, touched = mujoco.MjData(model), 0
    data.ctrl[:] = 1.0
    bearers, geom = [pad.body for pad in tips], kinds[0][0].geoms[0]
    for _ in range(150):
        mujoco.mj_step(model, data)
        force = np.zeros((2, 1, 2, 1, 1, 3))
        place = force.copy()
        for f, target, at in places.pairs:
            if target < 1:  # of the object, not of the other fingertip
                force[:, 0, f, 0, 0] = data.sensordata[at + 1 : at + 4]
                place[:, 0, f, 0, 0] = data.sensordata[at + 4 : at + 7]
        poses = TouchContacts(
            force,
            place,
            np.tile(data.xpos[bearers], (2, 1, 1, 1)),
            np.tile(data.xmat[bearers].reshape(1, 1, 2, 3, 3), (2, 1, 1, 1, 1)),
            np.tile(data.geom_xpos[[geom]], (2, 1, 1, 1)),
            np.tile(data.geom_xmat[[geom]].reshape(1, 1, 1, 3, 3), (2, 1, 1, 1, 1)),
        )
        step = contacts.of_step(poses, np.array([[0], [1]]), np.ones((1, 1)))
        for world, reader in enumerate(readers):
            reader.clear()
            record = data.sensordata[None, None]
            assert sense_contacts(record.ctypes.data, 0, 1, reader.sensing(places, 1))
            read = reader.touches[0, :, 0]
            for values, column in ((step.force, FORCE), (step.conductance, CONDUCTANCE), (step.area, AREA)):
                np.testing.assert_allclose(values[world, :, 0], read[:, column], rtol=1e-6)
            area = read[:, AREA]
            np.testing.assert_allclose(step.length[world, :, 0] * area, read[:, LENGTH], rtol=1e-6)
            shares = step.shares[world, :, 0] * area[:, None]
            np.testing.assert_allclose(
                shares, read[:, ASIDE:BESIDE], rtol=1e-6, atol=1e-9 * area.max(initial=1e-9)
            )
        touched += (step.conductance > 0).all(axis=(0, 2)).sum() >= feeling
    assert touched > 50
