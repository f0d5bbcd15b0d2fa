"""Grippers in mujoco-warp close on cubes of aluminium and of wood, and feel which is which: tensors on one device."""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportPossiblyUnboundVariable=false

import mujoco
import mujoco_warp as mjw
import warp as wp

import thermograsp
from thermograsp.touch import prepare

FINGER = """<body pos="{0}.03 0 .02"> <joint name="{1}" type="slide" axis="{0}1 0 0" damping="20"/>
  <geom name="{1}" type="box" size=".005 .01 .01" mass=".1"/> </body>"""
SCENE = f"""<mujoco> <option timestep=".005"/> <worldbody> <geom type="plane" size="1 1 .1"/>
  <body pos="0 0 .02"> <freejoint/> <geom name="cube" type="box" size=".02 .02 .02" mass=".1"/> </body>
  {FINGER.format("+", "right")} {FINGER.format("-", "left")} </worldbody>
  <actuator> <motor joint="right"/> <motor joint="left"/> </actuator> </mujoco>"""
WORLDS, FINGERS = 8, {"right": "right", "left": "left"}
CUBES = {"cube": ["aluminium", "wood"] * (WORLDS // 2)}  # each world's

scene = prepare(mujoco.MjSpec.from_string(SCENE), FINGERS, CUBES)  # with contact sensors
model, data = mjw.put_model(scene), mjw.make_data(scene, nworld=WORLDS, nconmax=32, njmax=128)
sensed = wp.to_torch(data.sensordata)  # the same memory: nothing is copied
wp.to_torch(data.ctrl).fill_(-8.0)
touch = thermograsp.ThermalTouch(scene, fingertips=FINGERS, objects=CUBES, worlds=WORLDS)
fixed = touch.fixed_touch(like=sensed)
state, record = fixed.start(), sensed.new_zeros(WORLDS, fixed.substeps, scene.nsensordata)
for _ in range(100):  # 1 s
    for substep in range(fixed.substeps):
        mjw.step(model, data)
        record[:, substep] = sensed
    state, reading = fixed.advance(state, fixed.contacts(record))
for number, material in enumerate(fixed.materials[0]):
    rows = state.material[:, 0] == number
    print(
        f"{material.name}: {reading.temperature_drop[rows].mean():.2f} K at {reading.force[rows].mean():.2f} N"
    )
