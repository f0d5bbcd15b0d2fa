"""FetchPickAndPlace of gymnasium-robotics grasps a block of aluminium, then one of wood, and feels which is which."""

# pyright: reportMissingImports=false

import gymnasium
import gymnasium_robotics
import numpy as np

import thermograsp

gymnasium.register_envs(gymnasium_robotics)
fingers = {side: f"robot0:{side}_gripper_finger_link" for side in ("r", "l")}
for material in ("aluminium", "wood"):
    env = gymnasium.make("FetchPickAndPlace-v4")
    env = thermograsp.wrappers.AddThermalObservation(env, fingertips=fingers, objects={"object0": material})
    seen, info = env.reset(seed=3)
    for step in range(49):
        reach = seen["observation"][3:6] - seen["observation"][:3] + (0, 0, 0.1 * (step < 12))
        action = np.append(np.clip(10 * reach, -1, 1), 1.0 if step < 24 else -1.0)
        seen, _, _, _, info = env.step(action.astype(np.float32))
    print(f"{material}: {info['touch'].temperature_drop.max():.2f} K")
