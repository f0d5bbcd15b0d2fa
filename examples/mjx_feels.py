"""Grippers in MJX close on cubes of aluminium and of wood and feel which is which: mechanics and heat in one jit."""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportPossiblyUnboundVariable=false

import jax
import jax.numpy as jnp
import mujoco
from mujoco import mjx

from thermograsp import thermal

FINGER = """<body pos="{0}.03 0 .02"> <joint name="{1}" type="slide" axis="{0}1 0 0" damping="20"/>
  <geom name="{1}" type="box" size=".005 .01 .01" mass=".1"/> </body>"""
SCENE = f"""<mujoco> <option timestep=".005"/> <worldbody> <geom type="plane" size="1 1 .1"/>
  <body pos="0 0 .02"> <freejoint/> <geom name="cube" type="box" size=".02 .02 .02" mass=".1"/> </body>
  {FINGER.format("+", "right")} {FINGER.format("-", "left")} </worldbody>
  <actuator> <motor joint="right"/> <motor joint="left"/> </actuator> <sensor>
    <contact geom1="right" geom2="cube" data="force" reduce="maxforce" num="4"/>
    <contact geom1="left" geom2="cube" data="force" reduce="maxforce" num="4"/> </sensor> </mujoco>"""
MATERIALS, WORLDS, SUBSTEPS = ("aluminium", "wood"), 8, 4

model = mjx.put_model(mujoco.MjModel.from_xml_string(SCENE))
which = jnp.arange(WORLDS) % len(MATERIALS)  # each world's cube
tips = thermal.array_fingertips(MATERIALS, dt=SUBSTEPS * 0.005, like=jnp.zeros(0))


@jax.jit
def control_step(data, heat):
    def substep(data, _):
        data = jax.vmap(mjx.step, (None, 0))(model, data)
        # of each fingertip up to four contacts, each with its normal force first
        return data, data.sensordata.reshape(WORLDS, 2, 4, 3)[..., 0].sum(-1)

    data, force = jax.lax.scan(substep, data, None, SUBSTEPS)  # N, (substeps, worlds, fingertips)
    conductance = tips.conductance(force.swapaxes(0, 1), which).mean(1)
    return data, *tips.step(heat, conductance, which), force[-1]


data = jax.vmap(lambda _: mjx.make_data(model).replace(ctrl=jnp.full(2, -8.0)))(which)
heat = tips.start(WORLDS)
for _ in range(50):  # 1 s
    data, heat, voltage, reading, force = control_step(data, heat)
for number, material in enumerate(MATERIALS):
    felt = which == number
    print(f"{material}: {reading.drop[felt].mean():.2f} K at {force[felt].mean():.2f} N")
