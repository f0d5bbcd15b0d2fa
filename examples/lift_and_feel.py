"""Run the grasp environment with a policy of a few lines: close, wait until both fingertips press, lift, hold."""

import gymnasium

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.envs import action_of


def main() -> bool:
    """Prints what is felt, ten times a second of the hold; returns whether the object was lifted and held."""
    env = gymnasium.make("thermograsp/Grasp-v0", material=["glass", "aluminium"], mode="T")
    observation, info = env.reset(seed=1)
    print(f"The object is made of {info['material']}.")
    pressed, ended = 0, False
    while not ended:
        pressed += int((observation["force"][:, 0] > 5.0).all())
        height = observation["gripper"][2]
        lift = 0.05 if pressed > 15 and height < 0.052 else 0.0
        observation, _, terminated, truncated, info = env.step(
            action_of(opening=0.0, force_limit=10.0, lift_rate=lift)
        )
        ended = terminated or truncated
        if pressed % 25 == 1:
            millivolts = 1e3 * observation["voltage"][:, -1]
            print(
                f"height {1e3 * height:4.0f} mm, left {millivolts[0]:6.2f} mV, right {millivolts[1]:6.2f} mV"
            )
    env.close()
    return bool(info["success"])


if __name__ == "__main__":
    print("lifted and held" if main() else "failed")
