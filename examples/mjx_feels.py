"""Grippers in MJX close on cubes of aluminium and of wood and feel which is which: mechanics and heat in one jit."""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportPossiblyUnboundVariable=false

import jax
import jax.numpy as jnp
import mujoco
from mujoco import mjx

import thermograsp

FINGER = """<body pos="{0}.03 0 .02"> <joint name="{1}" type="slide" axis="{0}1 0 0" damping="20"/>
  <geom name="{1}" type="box" size=".005 .01 .01" mass=".1"/> </body>"""
SCENE = f"""<mujoco> <option timestep=".005"/> <worldbody> <geom type="plane" size="1 1 .1"/>
  <body pos="0 0 .02"> <freejoint/> <geom name="cube" type="box" size=".02 .02 .02" mass=".1"/> </body>
  {FINGER.format("+", "right")} {FINGER.format("-", "left")} </worldbody>
  <actuator> <motor joint="right"/> <motor joint="left"/> </actuator> <sensor>
    <contact geom1="right" geom2="cube" data="force pos normal" reduce="maxforce" num="4"/>
    <contact geom1="left" geom2="cube" data="force pos normal" reduce="maxforce" num="4"/> </sensor> </mujoco>"""
WORLDS, MATERIALS = 8, ("aluminium", "wood")

scene = mujoco.MjModel.from_xml_string(SCENE)
model = mjx.put_model(scene)
fingers = {"right": "right", "left": "left"}
touch = thermograsp.ThermalTouch(scene, fingertips=fingers, objects={"cube": "aluminium"})
fixed = touch.fixed_touch(like=jnp.zeros(0), materials={"cube": MATERIALS})
which = jnp.arange(WORLDS) % len(MATERIALS)  # each world's cube


@jax.jit
def control_step(data, state):
    def substep(data, _):
        data = jax.vmap(mjx.step, (None, 0))(model, data)
        # of each fingertip and the cube's one geom up to four contacts: force (along the normal first), place, normal
        sensed = data.sensordata.reshape(WORLDS, 2, 1, 4, 9)
        force = sensed[..., :1] * sensed[..., 6:]
        return data, (force, sensed[..., 3:6], data.xpos, data.xmat, data.geom_xpos, data.geom_xmat)

    data, substeps = jax.lax.scan(substep, data, None, fixed.substeps)
    contacts = fixed.posed(*(part.swapaxes(0, 1) for part in substeps))
    return data, *fixed.advance(state, contacts)


data = jax.vmap(lambda _: mjx.make_data(model).replace(ctrl=jnp.full(2, -8.0)))(which)
state = fixed.reset(fixed.start(WORLDS), material=which[:, None])
for _ in range(100):  # 1 s
    data, state, reading = control_step(data, state)
for number, material in enumerate(MATERIALS):
    rows = which == number
    print(f"{material}: {reading.temperature_drop[rows].mean():.2f} K at {reading.force[rows].mean():.2f} N")
