"""Starts training mjlab's arm to lift the cube that is asked for out of two that look alike.

On a GPU: --device cuda:0 --worlds 4096 --iterations 5000. On a CPU a few iterations show that it runs.
"""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import argparse
from dataclasses import asdict

import mjlab.tasks  # noqa: F401  (registers the tasks, ours too)
from mjlab.envs import ManagerBasedRlEnv
from mjlab.rl import MjlabOnPolicyRunner, RslRlVecEnvWrapper
from mjlab.tasks.registry import load_env_cfg, load_rl_cfg

TASK = "Thermograsp-Sort-Cube-Yam"

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--device", default="cpu")
parser.add_argument("--worlds", type=int, default=8)
parser.add_argument("--iterations", type=int, default=2)
parser.add_argument("--out", default="out/sort_cube", help="where the log and the networks go")
arguments = parser.parse_args()

cfg, learning = load_env_cfg(TASK), load_rl_cfg(TASK)
cfg.scene.num_envs, cfg.seed = arguments.worlds, learning.seed
learning.logger = "tensorboard"
env = RslRlVecEnvWrapper(ManagerBasedRlEnv(cfg, device=arguments.device), clip_actions=learning.clip_actions)
runner = MjlabOnPolicyRunner(env, asdict(learning), arguments.out, arguments.device)
runner.learn(arguments.iterations, init_at_random_ep_len=True)
env.close()
