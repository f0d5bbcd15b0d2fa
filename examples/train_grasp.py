"""Trains PPO on Grasp-v0 with stakes, with and without the sense of heat. Needs the extra `rl`; see docs/learning.md.

python examples/train_grasp.py --seed 0 --out out/learning
python examples/train_grasp.py --seed 0 --out out/learning --without-heat
"""

from __future__ import annotations

import argparse
import csv
import json
import time
from pathlib import Path
from typing import Any

import gymnasium
import torch  # pyright: ignore[reportMissingImports]
from stable_baselines3 import PPO  # pyright: ignore[reportMissingImports]
from stable_baselines3.common.callbacks import BaseCallback, CallbackList  # pyright: ignore[reportMissingImports]
from stable_baselines3.common.utils import LinearSchedule  # pyright: ignore[reportMissingImports]

import thermograsp  # noqa: F401  registers the environments
from thermograsp.agents import Network, rollout
from thermograsp.envs import STAKES, action_of
from thermograsp.envs.sb3 import StableBaselinesVecEnv
from thermograsp.envs.spaces import Senses, arm_waits
from thermograsp.files import write_text

ENV = "thermograsp/Grasp-v0"
NUM_ENVS = 32
REPEAT = 5  # control steps of 20 ms
EVALUATION_SEED = 3_000_000  # of the first of the fresh episodes; no training seed comes near
FEW = 96  # episodes for a point of the learning curve
CURVE_SEED = 2_000_000


def make(num_envs: int) -> gymnasium.vector.VectorEnv:
    """The task."""
    return gymnasium.make_vec(ENV, num_envs=num_envs, vectorization_mode="vector_entry_point", **STAKES)


def network_of(model: PPO, senses: Senses, about: dict[str, Any]) -> Network:
    """The policy's mean, as arrays."""
    policy: Any = model.policy
    linear = [each for each in policy.mlp_extractor.policy_net if isinstance(each, torch.nn.Linear)]
    layers = tuple(
        (each.weight.detach().numpy().copy(), each.bias.detach().numpy().copy())
        for each in (*linear, policy.action_net)
    )
    return Network(layers, senses, REPEAT, about)


class Curve(BaseCallback):
    """Evaluates now and then what has been learnt, and writes it to a file as it comes."""

    def __init__(self, path: Path, senses: Senses, every: int) -> None:
        super().__init__()
        self.path, self.senses, self.every, self.next = path, senses, every, 0
        self.env, self.spent = make(FEW), 0.0
        self.begun = time.perf_counter()

    def _on_rollout_start(self) -> None:
        if self.num_timesteps >= self.next:
            self.next += self.every
            self.measure()

    def _on_step(self) -> bool:
        return True

    def measure(self) -> None:
        """One row of the file."""
        started = time.perf_counter()
        path = network_of(self.model, self.senses, {}).save(self.path.with_suffix(".now.npz"))  # pyright: ignore
        found = rollout(self.env, FEW, CURVE_SEED, str(path))
        path.unlink()
        new = not self.path.exists()
        row = {
            "control_steps": self.num_timesteps * REPEAT,
            "success": found.successes / FEW,
            "mean_return": round(found.mean_return, 4),
            "training_s": round(started - self.begun - self.spent, 1),
        }
        with self.path.open("a", newline="") as file:
            writer = csv.DictWriter(file, row)
            if new:
                writer.writeheader()
            writer.writerow(row)
        self.spent += time.perf_counter() - started


class Quieter(BaseCallback):
    """Bounds the noise's standard deviation, its logarithm falling from first to last over 60 % of the steps: what is
    learnt under much noise is a grip that stands it, and not the one that is best without."""

    def __init__(self, first: float, last: float, steps: int) -> None:
        super().__init__()
        self.first, self.last, self.steps = first, last, 0.6 * steps

    def _on_step(self) -> bool:
        return True

    def _on_rollout_end(self) -> None:
        share = min(self.num_timesteps / self.steps, 1.0)
        with torch.no_grad():
            self.model.policy.log_std.clamp_(max=self.first + share * (self.last - self.first))  # pyright: ignore


def main() -> None:
    """Trains one agent and evaluates it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--steps", type=int, default=600_000, help="control steps of all environments together"
    )
    parser.add_argument("--out", type=Path, default=Path("out/learning"))
    parser.add_argument("--without-heat", action="store_true", help="voltages and thermostats read 0")
    parser.add_argument("--without-load", action="store_true", help="load cells read 0")
    parser.add_argument("--episodes", type=int, default=500, help="fresh ones, at the end")
    parser.add_argument(
        "--start-force", type=float, default=15.0, help="N that an untrained agent closes with"
    )
    parser.add_argument(
        "--noise",
        type=float,
        nargs=2,
        default=(-2.0, -3.5),
        metavar=("FIRST", "LAST"),
        help="logarithms of the noise's standard deviation at first and from 60 percent of the steps on",
    )
    parser.add_argument("--settings", type=json.loads, default={}, help="of PPO, as JSON")
    args = parser.parse_args()

    torch.set_num_threads(1)
    senses = Senses(heat=not args.without_heat, load=not args.without_load)
    name = f"{'heat' if senses.heat else 'no-heat'}-{'load' if senses.load else 'no-load'}-{args.seed}"
    args.out.mkdir(parents=True, exist_ok=True)
    curve = Curve(args.out / f"{name}.csv", senses, args.steps // REPEAT // 12)
    curve.path.unlink(missing_ok=True)
    settings: dict[str, Any] = {
        "n_steps": 96,
        "batch_size": 512,
        "n_epochs": 10,
        "target_kl": 0.03,
        "gamma": 0.99,
        "gae_lambda": 0.95,
        "learning_rate": 3e-4,
        "use_sde": True,
        "sde_sample_freq": 16,
        **args.settings,
    }
    policy = {"net_arch": [64, 64], "activation_fn": torch.nn.Tanh, "log_std_init": args.noise[0]}
    env = StableBaselinesVecEnv(make(NUM_ENVS), senses, REPEAT, bootstrap=False, adjust=arm_waits)
    falling = LinearSchedule(settings["learning_rate"], 0.0, 1.0)
    model = PPO(
        "MlpPolicy",
        env,
        seed=args.seed * 1000,
        device="cpu",
        policy_kwargs=policy,
        **{**settings, "learning_rate": falling},
    )
    with torch.no_grad():
        start = action_of(opening=0.0, force_limit=args.start_force, lift_rate=0.035)
        model.policy.action_net.bias.copy_(torch.from_numpy(start))  # pyright: ignore
    quieter = Quieter(args.noise[0], args.noise[1], args.steps // REPEAT)
    model.learn(args.steps // REPEAT, callback=CallbackList([curve, quieter]))
    curve.measure()
    about = {"env": ENV, "seed": args.seed, "control_steps": model.num_timesteps * REPEAT, "ppo": settings}
    about |= {"start_force": args.start_force, "noise": args.noise}
    path = network_of(model, senses, about).save(args.out / f"{name}.npz")
    training = time.perf_counter() - curve.begun - curve.spent
    found = rollout(make(100), args.episodes, EVALUATION_SEED, str(path))
    result = {
        **about,
        "heat": senses.heat,
        "load": senses.load,
        "training_s": training,
        "episodes": args.episodes,
        "successes": found.successes,
        "mean_return": found.mean_return,
    }
    write_text(args.out / f"{name}.json", json.dumps(result, indent=2) + "\n")
    print(f"{name}: {found.successes} of {args.episodes} succeed after {training:.0f} s of training")


if __name__ == "__main__":
    main()
