"""dm_control's finger pokes a spinner of aluminium, then one of wood, and feels which is which."""

# pyright: reportMissingImports=false

import numpy as np
from dm_control import suite

import thermograsp

tip = thermograsp.Fingertip("fingertip", position=(0.025, 0, -0.155), normal=(1, 0, 0), size=(0.04, 0.04))
for material in ("aluminium", "wood"):
    env = suite.load("finger", "spin", {"random": 0})
    env = thermograsp.wrappers.DmControlThermalWrapper(
        env, fingertips={"tip": tip}, objects={"spinner": material}
    )
    env.reset()
    drops = []
    for step in range(300):
        env.step(np.full(2, 1.0 if step % 60 < 30 else -1.0))
        drops.append(env.touch.reading.temperature_drop.max())
    print(f"{material}: {max(drops):.2f} K")
