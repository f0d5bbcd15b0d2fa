"""Lift of robosuite grasps a cube of aluminium, then one of wood, and feels which is which."""

# pyright: reportMissingImports=false

import numpy as np
import robosuite

import thermograsp

pads = {n: f"gripper0_right_finger{n}_pad_collision" for n in "12"}
for material in ("aluminium", "wood"):
    env = robosuite.make(
        "Lift", "Panda", has_renderer=False, has_offscreen_renderer=False, use_camera_obs=False, seed=0
    )
    env = thermograsp.wrappers.RobosuiteThermalWrapper(env, fingertips=pads, objects={"cube_main": material})
    seen, info = env.reset(), {}
    for step in range(80):
        reach = seen["cube_pos"] - seen["robot0_eef_pos"] + (0, 0, 0.08 * (step < 25))
        action = np.concatenate((np.clip(10 * reach, -1, 1), np.zeros(3), [-1.0 if step < 45 else 1.0]))
        seen, _, _, info = env.step(action)
    print(f"{material}: {info['touch'].temperature_drop.max():.2f} K")
