"""Small grippers as MJCF text: fingers that slide or turn, driven in every way that MJCF knows."""

from __future__ import annotations

SLIDE = """
<mujoco model="{name}">
  <worldbody>
    <body name="base" {pose}>
      <geom type="box" size=".05 .02 .01" mass=".3"/>
      <body name="one" pos="-.05 0 -.06">
        <joint name="one" type="slide" axis="1 0 0" range="0 .045"/>
        <geom name="face_one" type="box" size=".004 .012 .03" mass=".05"/>
      </body>
      <body name="two" pos=".05 0 -.06">
        <joint name="two" type="slide" axis="-1 0 0" range="0 .045"/>
        <geom name="face_two" type="box" size=".004 .012 .03" mass=".05"/>
      </body>
    </body>
  </worldbody>
  {rest}
</mujoco>
"""
"""Two fingers that slide along x of the base: 92 mm between the faces at joint positions 0, 80 mm with fingertips."""

HINGE = """
<mujoco model="hinges">
  <worldbody>
    <body name="base">
      <geom type="box" size=".04 .02 .01" mass=".3"/>
      <body name="one" pos="-.03 0 0">
        <joint name="one" type="hinge" axis="0 1 0" range="-40 20"/>
        <geom name="face_one" type="box" size=".003 .012 .03" pos="0 0 -.07" mass=".05"/>
      </body>
      <body name="two" pos=".03 0 0">
        <joint name="two" type="hinge" axis="0 -1 0" range="-40 20"/>
        <geom name="face_two" type="box" size=".003 .012 .03" pos="0 0 -.07" mass=".05"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="turn_one" joint="one" kp="10" ctrlrange="-.9 .4" inheritrange="0"/>
    <position name="turn_two" joint="two" kp="10" ctrlrange="-.9 .4" inheritrange="0"/>
  </actuator>
</mujoco>
"""

POSITIONS = """
  <actuator>
    <position name="push_one" joint="one" kp="500" ctrlrange="0 .045" forcerange="-15 15"/>
    <position name="push_two" joint="two" kp="500" ctrlrange="0 .045" forcerange="-15 15"/>
  </actuator>
"""

MOTORS = """
  <actuator>
    <motor name="push_one" joint="one" ctrlrange="-8 8"/>
    <motor name="push_two" joint="two" gear="2" ctrlrange="-8 8"/>
  </actuator>
"""

TENDON = """
  <tendon>
    <fixed name="both"><joint joint="one" coef="1"/><joint joint="two" coef="1"/></fixed>
  </tendon>
  <equality><joint joint1="one" joint2="two"/></equality>
  <actuator><motor name="pull" tendon="both" ctrlrange="-30 30"/></actuator>
"""

COUPLED = """
  <equality><joint joint1="two" joint2="one" polycoef="0 1 0 0 0"/></equality>
  <actuator><position name="push" joint="one" kp="500" ctrlrange="0 .045"/></actuator>
"""

LONE_JAW = """
<mujoco model="jaw">
  <worldbody>
    <body name="base">
      <geom name="fixed_jaw" type="box" size=".004 .012 .03" pos=".05 0 -.06" mass=".1"/>
      <geom name="block" type="box" size=".05 .02 .01" mass=".3"/>
      <body name="jaw" pos="-.05 0 -.06">
        <joint name="jaw" type="slide" axis="1 0 0" range="0 .09"/>
        <geom name="jaw" type="box" size=".004 .012 .03" mass=".05"/>
      </body>
    </body>
  </worldbody>
  <actuator><position name="push" joint="jaw" kp="500" ctrlrange="0 .09"/></actuator>
</mujoco>
"""

THREE = """
<mujoco model="three">
  <worldbody>
    <body name="palm">
      <geom type="cylinder" size=".05 .01" mass=".3"/>
      <body name="thumb" pos="-.05 0 -.06">
        <joint name="thumb" type="slide" axis="1 0 0" range="0 .045"/>
        <geom type="box" size=".004 .02 .03" mass=".05"/>
      </body>
      <body name="index" pos=".05 -.02 -.06">
        <joint name="index" type="slide" axis="-1 0 0" range="0 .045"/>
        <geom type="box" size=".004 .015 .03" mass=".05"/>
      </body>
      <body name="pinky" pos=".05 .02 -.06">
        <joint name="pinky" type="slide" axis="-1 0 0" range="0 .045"/>
        <geom type="box" size=".004 .015 .03" mass=".05"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="thumb" joint="thumb" kp="500" ctrlrange="0 .045"/>
    <position name="index" joint="index" kp="500" ctrlrange="0 .045"/>
    <position name="pinky" joint="pinky" kp="500" ctrlrange="0 .045"/>
  </actuator>
</mujoco>
"""

_BAR = """
      <body name="crank_{side}" pos="{x} 0 0">
        <joint name="crank_{side}" type="hinge" axis="0 {way} 0" range="-40 40"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.06" size=".003" mass=".02"/>
        <body name="finger_{side}" pos="0 0 -.06">
          <joint name="knuckle_{side}" type="hinge" axis="0 {way} 0"/>
          <geom name="face_{side}" type="box" size=".003 .012 .025" pos="0 0 -.03" mass=".05"/>
        </body>
      </body>
      <body name="rocker_{side}" pos="{out} 0 0">
        <joint name="rocker_{side}" type="hinge" axis="0 {way} 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.06" size=".003" mass=".02"/>
      </body>
"""

_LOOP = '<connect body1="finger_{side}" body2="rocker_{side}" anchor="{arm} 0 0"/>'


def parallelograms() -> str:
    """Two fingers on parallel cranks of 60 mm, closed by `connect`, one driven and the other coupled to it: they swing
    without turning, at most 40 degrees either way of 80 mm between the cranks."""
    sides = ({"side": "one", "x": -0.04, "out": -0.06, "way": -1, "arm": -0.02},
             {"side": "two", "x": 0.04, "out": 0.06, "way": 1, "arm": 0.02})  # fmt: skip
    bars = "".join(_BAR.format(**side) for side in sides)
    loops = "".join(_LOOP.format(**side) for side in sides)
    return f"""
<mujoco model="parallelograms">
  <worldbody>
    <body name="base"><geom type="box" size=".07 .02 .01" pos="0 0 .02" mass=".3"/>{bars}</body>
  </worldbody>
  <equality>{loops}<joint joint1="crank_two" joint2="crank_one"/></equality>
  <actuator><position name="turn" joint="crank_one" kp="10" ctrlrange="-.69 .69"/></actuator>
</mujoco>
"""


ROUND = """
<mujoco model="round">
  <worldbody>
    <body name="base">
      <geom type="sphere" size=".02" mass=".3"/>
      <body name="one" pos="-.05 0 -.06">
        <joint name="one" type="slide" axis="1 0 0" range="0 .045"/>
        <geom type="capsule" size=".01 .02" mass=".05"/>
      </body>
      <body name="two" pos=".05 0 -.06">
        <joint name="two" type="slide" axis="-1 0 0" range="0 .045"/>
        <geom type="capsule" size=".01 .02" mass=".05"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="push_one" joint="one" kp="500" ctrlrange="0 .045"/>
    <position name="push_two" joint="two" kp="500" ctrlrange="0 .045"/>
  </actuator>
</mujoco>
"""


def slides(rest: str = POSITIONS, pose: str = "", name: str = "slides") -> str:
    """The sliding gripper with that drive. pose: attributes of its base, such as pos and euler."""
    return SLIDE.format(name=name, pose=pose, rest=rest)


_ARM = """
      <body name="{side}_upper" pos="0 {y} 0">
        <joint name="{side}_shoulder" type="hinge" axis="1 0 0" range="-60 60"/>
        <geom type="capsule" size=".03" fromto="0 0 0 0 0 -{upper}" mass="1"/>
        <body name="{side}_lower" pos="0 0 -{upper}">
          <joint name="{side}_elbow" type="hinge" axis="1 0 0" range="-60 60"/>
          <geom type="capsule" size=".03" fromto="0 0 0 0 0 -{lower}" mass="1"/>
          <body name="{side}_hand" pos="0 0 -{lower}">
            <geom type="box" size=".05 .02 .01" mass=".3"/>
            <body name="{side}_one" pos="-.05 0 -.06">
              <joint name="{side}_one" type="slide" axis="1 0 0" range="0 .045"/>
              <geom type="box" size=".004 .012 .03" mass=".05"/>
            </body>
            <body name="{side}_two" pos=".05 0 -.06">
              <joint name="{side}_two" type="slide" axis="-1 0 0" range="0 .045"/>
              <geom type="box" size=".004 .012 .03" mass=".05"/>
            </body>
          </body>
        </body>
      </body>
"""
_JOINTS = [f"{side}_{joint}" for side in ("left", "right") for joint in ("shoulder", "elbow", "one", "two")]


def two_arms(upper: float = 0.3, lower: float = 0.35) -> str:
    """A hand of two sliding fingers on each of two arms. upper, lower: m of their parts."""
    arms = "".join(
        _ARM.format(side=side, y=y, upper=upper, lower=lower) for side, y in (("left", -0.2), ("right", 0.2))
    )
    motors = " ".join(f'<motor name="{name}" joint="{name}" ctrlrange="-8 8"/>' for name in _JOINTS)
    return f"""
<mujoco model="arms">
  <worldbody>
    <body name="torso">
      <geom type="box" size=".1 .15 .1" mass="9"/>
{arms}
    </body>
  </worldbody>
  <actuator>
    {motors}
  </actuator>
</mujoco>
"""


TWO_ARMS = two_arms()

MESH = """
<mujoco>
  <asset><mesh name="finger" file="finger.stl"/></asset>
  <worldbody><geom type="mesh" mesh="finger"/></worldbody>
</mujoco>
"""
