"""Scenes as somebody else would write them: a three-fingered hand over a can and a ball, and how it grasps; a fingertip
over a block."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import math

import mujoco

from thermograsp.touch import ThermalTouch

RADIUS = 0.03
SOFT_LOAD = 7.0  # N
SOFT = """
<mujoco><option timestep=".002" gravity="0 0 -70"/><worldbody>
  <body name="ball"><geom name="ball" type="sphere" size=".03" solref="-400 -40"/></body>
  <body name="tip" pos="0 0 .0341"><joint type="slide" axis="0 0 -1" damping="20"/>
    <geom name="pad" type="box" size=".01 .01 .004" mass=".1" solref="-400 -40"/></body>
</worldbody></mujoco>"""
"""A light pad that is pulled into a ball by that force, many millimetres deep."""

ONE_PRESS = """
<mujoco>
  <option timestep=".002" gravity="0 0 0" cone="{cone}"/>
  <worldbody>
    <body name="block"><geom name="block" type="box" size=".02 .02 .02"/></body>
    <body name="tip" pos="0 0 .0241">
      <joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
      <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
  <actuator><motor joint="tip"/></actuator>
</mujoco>"""
"""A fingertip over a block."""


def _finger(number: int, name: str) -> tuple[str, str]:
    angle = 2 * math.pi * number / 3
    x, y = math.cos(angle), math.sin(angle)
    body = f"""
      <body name="{name}" pos="{0.07 * x} {0.07 * y} 0" euler="0 0 {math.degrees(angle)}">
        <joint name="{name}" type="slide" axis="-1 0 0" damping="20" armature=".05"/>
        <geom name="{name}_pad" type="box" size=".004 .01 .01" mass=".02"/>
        <geom name="{name}_back" type="box" pos=".01 0 0" size=".006 .008 .008" mass=".02" contype="0" conaffinity="0"/>
      </body>"""
    drive = f'<motor name="{name}" joint="{name}" ctrlrange="-20 20"/>'
    return body, drive


FINGERS = ("thumb", "index", "middle")
PADS = {name: f"{name}_pad" for name in FINGERS}


def scene(objects: str = "", custom: str = "", options: str = "") -> str:
    bodies, drives = zip(*(_finger(n, name) for n, name in enumerate(FINGERS)), strict=True)
    return f"""
<mujoco>
  <option timestep=".002" integrator="implicitfast" cone="elliptic" impratio="10" {options}/>
  <custom>{custom}</custom>
  <worldbody>
    <geom name="table" type="box" pos="0 0 -.01" size=".3 .3 .01"/>
    <body name="can" pos="0 0 .05">
      <freejoint/>
      <geom name="can_wall" type="cylinder" size="{RADIUS} .05" mass=".3"/>
    </body>
    <body name="ball" pos=".25 0 .05">
      <joint name="ball" type="slide" axis="1 0 0" damping="50"/>
      <geom name="ball_skin" type="sphere" size="{RADIUS}" mass=".3"/>
    </body>
    {objects}
    <body name="palm" pos="0 0 .05" >
      <geom type="sphere" size=".01" pos="0 0 .12" mass=".3"/>
      <joint name="palm" type="slide" axis="1 0 0" damping="20" armature=".1"/>
      <joint name="palm_z" type="slide" axis="0 0 1" damping="20" armature=".1"/>
      {"".join(bodies)}
    </body>
  </worldbody>
  <actuator>
    {"".join(drives)}
    <position name="palm" joint="palm" kp="2000" kv="150"/>
    <position name="palm_z" joint="palm_z" kp="2000" kv="150"/>
  </actuator>
</mujoco>"""


def hand(**words: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(scene(**words))
    return model, mujoco.MjData(model)


def press(data: mujoco.MjData, force: float, *fingers: str) -> None:
    """Sets the fingers' forces, N, towards the middle; the others draw back."""
    for name in FINGERS:
        data.actuator(name).ctrl[0] = force if name in (fingers or FINGERS) else -5.0


def make(model: mujoco.MjModel, objects: dict | None = None, **words: object) -> ThermalTouch:
    words = {"chain": "ideal", **words}
    return ThermalTouch(model, fingertips=PADS, objects=objects or {"can": "aluminium"}, **words)  # pyright: ignore


def run(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch, seconds: float) -> None:
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        touch.update(data)
