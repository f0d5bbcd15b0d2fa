"""Trains mjlab's arm, on a CPU, to keep the cube in its hand or to let it go: only heat tells which cube it is.

python examples/train_keep_cube.py --seed 1
python examples/train_keep_cube.py --seed 1 --without-heat
"""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import argparse
from dataclasses import asdict

import mjlab.tasks  # noqa: F401  (registers the tasks, ours too)
import torch
from mjlab.envs import ManagerBasedRlEnv
from mjlab.rl import MjlabOnPolicyRunner, RslRlVecEnvWrapper
from mjlab.tasks.registry import load_env_cfg, load_rl_cfg

TASK = "Thermograsp-Keep-Cube-Yam"

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--device", default="cpu")
parser.add_argument("--worlds", type=int, default=64)
parser.add_argument("--iterations", type=int, default=60)
parser.add_argument("--rounds", type=int, default=4, help="episodes of every world after the training")
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--without-heat", action="store_true", help="the voltages are not observed")
parser.add_argument("--out", default="out/keep_cube", help="where the log and the networks go")
arguments = parser.parse_args()

cfg, learning = load_env_cfg(TASK), load_rl_cfg(TASK)
cfg.scene.num_envs, cfg.seed = arguments.worlds, arguments.seed
learning.seed, learning.logger = arguments.seed, "tensorboard"
if arguments.without_heat:
    for group in cfg.observations.values():
        del group.terms["voltage"]
env = RslRlVecEnvWrapper(ManagerBasedRlEnv(cfg, device=arguments.device))
runner = MjlabOnPolicyRunner(env, asdict(learning), arguments.out, arguments.device)
runner.learn(arguments.iterations)

policy = runner.get_inference_policy(arguments.device)
right = []
with torch.inference_mode():  # as in the training, whose tensors it goes on with
    observation, _ = env.reset()
    for _ in range(arguments.rounds * env.max_episode_length):
        observation, _, done, extras = env.step(policy(observation))
        if done.any():  # every world's episode ends at once
            right.append(float(extras["log"]["Episode_Metrics/right"]))
env.close()
episodes = arguments.rounds * arguments.worlds
print(f"kept or let go as asked in {sum(right) / len(right):.1%} of {episodes} episodes")
