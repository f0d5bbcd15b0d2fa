"""Training with stable-baselines3: imitation, then PPO, with checkpoints from which an interrupted run goes on."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from thermograsp.errors import InvalidValueError, MissingDependencyError, install
from thermograsp.files import atomic_write, made_folder, write_text

try:
    import tensorboard  # noqa: F401  # pyright: ignore[reportMissingImports]
    import torch  # pyright: ignore[reportMissingImports]
    from stable_baselines3 import PPO  # pyright: ignore[reportMissingImports]
    from stable_baselines3.common.callbacks import BaseCallback  # pyright: ignore[reportMissingImports]
    from stable_baselines3.common.logger import configure  # pyright: ignore[reportMissingImports]
    from stable_baselines3.common.utils import LinearSchedule  # pyright: ignore[reportMissingImports]
    from stable_baselines3.common.vec_env import VecMonitor  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise MissingDependencyError(f"{error.name} is not installed: {install('rl')}") from error

from thermograsp.agents.episodes import rollout

from .agent import Acting, Agent
from .imitation import Seen, imitate, watched
from .inputs import REPEAT
from .perceiving import Perceiving
from .recipe import Recipe
from .tasks import LearningTask
from .teachers import TEACHERS

VALIDATION = 900_000_000
"""Seed of the first episode that chooses among a training's checkpoints. Training itself uses seeds below 1e8."""
MOST_SEED = 999
_ROUND, _HALF, _PPO = 1_000, 500, 50_000
"""Seeds of a round and of half of it, and PPO's first, within a training's 1e5."""
POLICY, STATE, MODEL, SEEN = "policy.npz", "state.json", "model.zip", "seen.npz"


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a training is. doing: "imitation" or "ppo". steps: control steps so far. success, mean_return: of the
    evaluation just done, or None."""

    doing: str
    steps: int
    success: float | None = None
    mean_return: float | None = None


class Training:
    """One agent in the making, in a folder of its own. report: called with the progress.

    drawn: imitate in two halves, of which one has everything drawn that can differ between episodes, and choose the
    checkpoint by both. resume: go on where a run in that folder was interrupted, or begin there. Raises
    InvalidValueError for a seed beyond 0 .. MOST_SEED, and for a folder that holds another training or damaged files,
    or with `resume` off any training."""

    def __init__(
        self,
        task: LearningTask,
        out: str | Path,
        *,
        seed: int = 0,
        recipe: Recipe | None = None,
        heat: bool = True,
        load: bool = True,
        drawn: bool = False,
        resume: bool = False,
        report: Callable[[Progress], None] = lambda progress: None,
    ) -> None:
        if not 0 <= seed <= MOST_SEED:
            raise InvalidValueError(f"seed must be 0 .. {MOST_SEED}, got {seed}")
        self.task, self.out, self.seed, self.recipe = task, Path(out), seed, recipe or Recipe()
        self._report = report
        whole = {
            "task": task.name,
            "randomize": drawn,
            "seed": seed,
            "heat": heat,
            "load": load,
            "recipe": asdict(self.recipe),
        }
        self.about: dict[str, Any] = json.loads(json.dumps(whole))
        self._state: dict[str, Any] = {**self.about, "rounds_done": 0, "evaluations": []}
        self._take_up(resume)
        torch.set_num_threads(1)
        conditions = (task, task.drawn()) if drawn else (task,)
        at_once = self.recipe.num_envs // len(conditions)
        self._practice = [Perceiving(each, at_once, heat, load, practice=True) for each in conditions]
        self._env = Perceiving(task, self.recipe.num_envs, heat, load)
        self._judging = [each.make(self.recipe.evaluated // len(conditions)) for each in conditions]
        made_folder(self.out)
        self._model = self._loaded() if (self.out / MODEL).exists() and resume else self._fresh()
        self._model.set_logger(configure(str(self.out / "tensorboard"), ["tensorboard"]))

    @property
    def steps(self) -> int:
        """Control steps so far."""
        taught = self._state["rounds_done"] * self._per_round * self.recipe.num_envs * REPEAT
        return taught + self._model.num_timesteps * REPEAT

    def run(self) -> dict[str, Any]:
        """All that is left to do; returns the best evaluation. The agent is then in POLICY of the folder."""
        self._imitation()
        left = round(self.recipe.steps * (1 - self.recipe.taught)) // REPEAT - self._model.num_timesteps
        if left > 0:
            self._env.seed(self.seed * 100_000 + _PPO + self._model.num_timesteps)
            self._model.learn(left, callback=_Checkpoints(self), reset_num_timesteps=False)
            self.evaluate("ppo")
        for env in (*self._practice, self._env, *self._judging):
            env.close()
        return dict(self.best)

    @property
    def best(self) -> dict[str, Any]:
        """The evaluation with the most successes; of equals the last, which has learned from most."""
        return max(reversed(self._state["evaluations"]), key=lambda each: each["success"])

    def evaluate(self, doing: str) -> None:
        """Evaluates what has been learnt without noise, keeps it where it is the best, and writes a checkpoint."""
        steps = self.steps
        agent = Agent(
            self.task.name, self._env.inputs, _layers(self._model.policy), {**self.about, "steps": steps}
        )
        found = [rollout(env, env.num_envs, VALIDATION, Acting(env, agent)) for env in self._judging]
        success = sum(each.successes for each in found) / sum(env.num_envs for env in self._judging)
        mean_return = float(np.mean([each.mean_return for each in found]))
        one = {"doing": doing, "steps": steps, "success": success, "mean_return": mean_return}
        self._state["evaluations"].append(one)
        if self.best is one:
            agent.save(self.out / POLICY)
        self._model.logger.record("evaluation/success", success)
        self._model.logger.record("evaluation/mean_return", mean_return)
        self._model.logger.dump(steps)
        self._keep()
        self._report(Progress(doing, steps, success, mean_return))

    def report_steps(self, doing: str, steps: int) -> None:
        """Reports control steps."""
        self._report(Progress(doing, steps))

    @property
    def _per_round(self) -> int:
        """Decisions of each environment in a round of imitation."""
        recipe = self.recipe
        return max(round(recipe.steps * recipe.taught / recipe.rounds / recipe.num_envs / REPEAT), 1)

    def _imitation(self) -> None:
        """The rounds that are left."""
        recipe, seen = self.recipe, self._seen()
        teachers = [TEACHERS[self.task.name](env.batch) for env in self._practice]
        while (done := self._state["rounds_done"]) < recipe.rounds:
            steps = self.steps

            def advance(more: int) -> None:
                nonlocal steps
                steps += more
                self.report_steps("imitation", steps)

            agent = self._mean_action if done else None
            for half, (env, teacher) in enumerate(zip(self._practice, teachers, strict=True)):
                env.seed(self.seed * 100_000 + done * _ROUND + half * _HALF)
                new = watched(env, teacher, agent, self._per_round, recipe.gamma, advance)
                seen = new if seen is None else seen.and_also(new)
            assert seen is not None
            last = done + 1 == recipe.rounds
            minibatches = recipe.last_minibatches if last else recipe.minibatches
            error = imitate(
                self._model.policy, seen, minibatches, recipe, self.seed + done, teachers[0].averaged
            )
            self._model.logger.record("imitation/error", error)
            self._state["rounds_done"] = done + 1
            if not last:
                with atomic_write(self.out / SEEN) as temporary:
                    np.savez(temporary, vector=seen.vector, right=seen.right, gained=seen.gained)
            self.evaluate("imitation")
        (self.out / SEEN).unlink(missing_ok=True)

    def _mean_action(self, vector: np.ndarray) -> np.ndarray:
        """What the network does without noise."""
        return self._model.predict(vector, deterministic=True)[0]

    def _seen(self) -> Seen | None:
        """What an interrupted imitation has seen."""
        if not 0 < self._state["rounds_done"] < self.recipe.rounds:
            return None
        try:
            with np.load(self.out / SEEN) as file:
                return Seen(file["vector"], file["right"], file["gained"])
        except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
            raise InvalidValueError(f"{self.out / SEEN} is damaged ({error}): give another --out") from error

    def _fresh(self) -> Any:
        """A network that nobody has taught anything: the same for all tasks and grippers."""
        recipe = self.recipe
        return PPO(
            "MlpPolicy",
            VecMonitor(self._env),
            seed=self.seed,
            device="cpu",
            n_steps=recipe.decisions,
            batch_size=recipe.batch,
            n_epochs=recipe.epochs,
            learning_rate=LinearSchedule(recipe.learning_rate, 0.0, 1.0),
            gamma=recipe.gamma,
            gae_lambda=recipe.gae_lambda,
            clip_range=recipe.clip,
            target_kl=recipe.target_kl,
            policy_kwargs={
                "net_arch": {"pi": list(recipe.hidden), "vf": list(recipe.hidden)},
                "activation_fn": torch.nn.Tanh,
                "log_std_init": recipe.noise,
            },
        )

    def _loaded(self) -> Any:
        """The network and its optimizer as the last checkpoint has them."""
        try:
            return PPO.load(self.out / MODEL, VecMonitor(self._env), device="cpu")
        except (OSError, ValueError, KeyError, EOFError, AttributeError, RuntimeError, BadZipFile) as error:
            raise InvalidValueError(f"{self.out / MODEL} is damaged ({error}): give another --out") from error

    def _keep(self) -> None:
        """Writes a checkpoint. A run that is killed between the two files does its last part again."""
        with atomic_write(self.out / MODEL) as temporary:
            self._model.save(temporary)
        write_text(self.out / STATE, json.dumps(self._state, indent=2) + "\n")

    def _take_up(self, resume: bool) -> None:
        """Reads the state of an interrupted run where that is asked for."""
        path = self.out / STATE
        if not resume:
            if path.exists():
                raise InvalidValueError(
                    f"{self.out} holds a training: go on with --resume, or give another --out"
                )
            return
        if not path.exists():
            return
        try:
            state = dict(json.loads(path.read_text(encoding="utf-8")))
        except (ValueError, TypeError) as error:
            raise InvalidValueError(f"{path} is damaged ({error}): give another --out") from error
        differing = [name for name, value in self.about.items() if state.get(name) != value]
        if differing:
            raise InvalidValueError(
                f"{self.out} holds another training ({', '.join(differing)} differ): resume it with the same options"
            )
        self._state = state


class _Checkpoints(BaseCallback):
    """Reports PPO's steps, and evaluates after each part of them."""

    def __init__(self, training: Training) -> None:
        super().__init__()
        recipe = training.recipe
        self._training = training
        self._every = recipe.steps * (1 - recipe.taught) / REPEAT / recipe.checkpoints
        self._next = 0.0

    def _on_training_start(self) -> None:
        self._next = self.num_timesteps + self._every

    def _on_rollout_start(self) -> None:
        if self.num_timesteps >= self._next:
            self._next += self._every
            self._training.evaluate("ppo")

    def _on_step(self) -> bool:
        self._training.report_steps("ppo", self._training.steps)
        return True


def _layers(policy: Any) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """The policy's mean, as arrays."""
    linear = [each for each in policy.mlp_extractor.policy_net if isinstance(each, torch.nn.Linear)]
    return tuple(
        (each.weight.detach().numpy().copy(), each.bias.detach().numpy().copy())
        for each in (*linear, policy.action_net)
    )
