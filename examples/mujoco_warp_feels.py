"""Grippers in mujoco-warp close on cubes of aluminium and of wood, and feel which is which: tensors on one device."""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportPossiblyUnboundVariable=false

import mujoco
import mujoco_warp as mjw
import torch
import warp as wp

from thermograsp import thermal

FINGER = """<body pos="{0}.03 0 .02"> <joint name="{1}" type="slide" axis="{0}1 0 0" damping="20"/>
  <geom name="{1}" type="box" size=".005 .01 .01" mass=".1"/> </body>"""
SCENE = f"""<mujoco> <option timestep=".005"/> <worldbody> <geom type="plane" size="1 1 .1"/>
  <body pos="0 0 .02"> <freejoint/> <geom name="cube" type="box" size=".02 .02 .02" mass=".1"/> </body>
  {FINGER.format("+", "right")} {FINGER.format("-", "left")} </worldbody>
  <actuator> <motor joint="right"/> <motor joint="left"/> </actuator> <sensor>
    <contact geom1="right" geom2="cube" data="force" reduce="netforce"/>
    <contact geom1="left" geom2="cube" data="force" reduce="netforce"/> </sensor> </mujoco>"""
MATERIALS, WORLDS, SUBSTEPS = ("aluminium", "wood"), 8, 4

scene = mujoco.MjModel.from_xml_string(SCENE)
model, data = mjw.put_model(scene), mjw.make_data(scene, nworld=WORLDS, nconmax=32, njmax=128)
sensed = wp.to_torch(data.sensordata).view(
    WORLDS, 2, 3
)  # N along x, y, z; the same memory: nothing is copied
wp.to_torch(data.ctrl).fill_(-8.0)
which = torch.arange(WORLDS, device=sensed.device) % len(MATERIALS)  # each world's cube
tips = thermal.array_fingertips(MATERIALS, dt=SUBSTEPS * 0.005, like=sensed)
heat, forces = tips.start(WORLDS), sensed.new_zeros(WORLDS, SUBSTEPS, 2)
for _ in range(50):  # 1 s
    for substep in range(SUBSTEPS):
        mjw.step(model, data)
        forces[:, substep] = sensed[..., 0].abs()  # the pads look along x
    heat, voltage, reading = tips.step(heat, tips.conductance(forces, which).mean(1), which)
for number, material in enumerate(MATERIALS):
    felt = which == number
    print(f"{material}: {reading.drop[felt].mean():.2f} K at {forces[felt, -1].mean():.2f} N")
