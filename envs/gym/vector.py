"""What all vector environments share: one plant, one array step."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.seeding import np_random
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, iterate

from thermograsp.errors import InvalidValueError, UnknownNameError, unknown_name, whole_number

from ..spaces import Observation
from ..tasks import Task, cleared
from .batch import BatchState, GraspBatch, Step, infos_of, reset_options
from .copies import Copied
from .keywords import check_keywords
from .single import frames_per_second

_Returned = tuple[Observation, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]


@dataclass(frozen=True, slots=True)
class VectorState:
    """The state of a vector environment in mid-episode; picklable. ended (B,): environments whose episode is over.
    steps (B,): steps of each episode so far."""

    batch: BatchState
    ended: np.ndarray
    steps: np.ndarray


class TouchVectorEnv(Copied, VectorEnv[Observation, np.ndarray, np.ndarray]):
    """`num_envs` environments of a task; observation, action, info and keywords as the single one's. Pickle and
    copy.deepcopy make another one in the same state.

    Environment i of a batch reset with seed s is the single environment reset with s + i, bit for bit.

    autoreset_mode: what becomes of an environment that ended, one of Gymnasium's, or its value. NEXT_STEP: the next
    step resets it and ignores its action. SAME_STEP: it is reset at once; its last observation and info are in
    info["final_obs"] and info["final_info"]. DISABLED: it is to be reset with options={"reset_mask": ...} before the
    next step. max_episode_steps: truncates sooner than the task does. render_mode: "rgb_array" or None; camera, width,
    height: of each environment's picture.
    """

    metadata: dict[str, Any] = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": ["rgb_array"]}  # noqa: RUF012
    _renderer: Any = None

    def __init__(
        self,
        task: Task,
        num_envs: int = 1,
        *,
        render_mode: str | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        max_episode_steps: int | None = None,
        camera: str = "overview",
        width: int = 480,
        height: int = 360,
        **config: Any,
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise InvalidValueError(
                f"render_mode {render_mode!r}: a vector environment draws pictures, 'rgb_array', and opens no windows"
            )
        if max_episode_steps is not None:
            whole_number("max_episode_steps", max_episode_steps, 1)
        self.autoreset_mode = _mode(autoreset_mode)
        check_keywords(type(self), config)
        self.batch = GraspBatch(num_envs, task=task, **config)
        self.metadata = {
            **self.metadata,
            "autoreset_mode": self.autoreset_mode,
            "render_fps": frames_per_second(self.batch.dt),
        }
        self.num_envs = num_envs = self.batch.num_envs
        self.single_observation_space = self.batch.observation_space
        self.single_action_space = self.batch.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        limits = (self.batch.time_limit, max_episode_steps)
        self._limit = min((limit for limit in limits if limit is not None), default=None)
        self._ended, self._steps = np.zeros(num_envs, bool), np.zeros(num_envs, int)
        self._spec: EnvSpec | None = None
        self._attributes: dict[str, list[Any]] = {}
        self.render_mode = render_mode
        self._picture = (camera, whole_number("width", width, 1), whole_number("height", height, 1))

    @property
    def spec(self) -> EnvSpec | None:  # pyright: ignore[reportIncompatibleVariableOverride]
        """What gymnasium.make_vec made it of, with the time limit as max_episode_steps."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:  # pyright: ignore[reportIncompatibleVariableOverride]
        self._spec = None if spec is None else replace(spec, max_episode_steps=self._limit)

    @property
    def _max_episode_steps(self) -> int | None:
        """By the name that Gymnasium's TimeLimit gives it."""
        return self._limit

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment."""
        return getattr(self.batch.plant, "model", None)

    @property
    def dt(self) -> float:
        """s, the control period."""
        return self.batch.dt

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts all environments, or those of options={"reset_mask": (B,) bool}. seed: s for s, s + 1, ..., or a list
        of one each. Raises ClosedEnvironmentError after close, as step does."""
        self.batch.require_open("reset")
        options = reset_options(options)
        mask = np.asarray(options.pop("reset_mask", np.ones(self.num_envs, bool)), bool)
        if mask.shape != (self.num_envs,) or not mask.any():
            raise InvalidValueError(
                f"reset_mask must be ({self.num_envs},) with one True at least, got {mask.tolist()}"
            )
        if isinstance(seed, list | tuple | np.ndarray):
            seeds: list[int | None] = list(seed)
        elif seed is None:
            seeds = [None] * self.num_envs
        else:
            seeds = [whole_number("seed", seed) + i for i in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise InvalidValueError(f"seed lists {len(seeds)} values for {self.num_envs} environments")
        rows = [int(row) for row in np.flatnonzero(mask)]
        seen, reading = self._restart(rows, [seeds[row] for row in rows], options)
        return seen, infos_of(reading, None, mask)

    def step(self, actions: np.ndarray) -> _Returned:
        """One control step; what becomes of environments that ended before, or end now, says autoreset_mode."""
        self.batch.require_open("step")
        try:
            actions = np.asarray(actions)
        except ValueError:  # lists of several lengths
            actions = np.asarray(actions, object)
        if actions.shape != self.action_space.shape:
            raise InvalidValueError(
                f"step takes actions of shape {self.action_space.shape}, one for each environment; got {actions.shape}"
            )
        starting = self._ended.copy()
        if not starting.any():
            step = self._advance(actions)
            ended = step.terminated | step.truncated
            self._ended = ended.copy()
            if self.autoreset_mode is AutoresetMode.SAME_STEP and ended.any():
                return self._renewed(step, ended)
            infos = infos_of(step.reading, step.outcome, ~starting)
            return step.observation, step.reward, step.terminated, step.truncated, infos
        rows = [int(row) for row in np.flatnonzero(starting)]
        if self.autoreset_mode is AutoresetMode.DISABLED:
            raise InvalidValueError(
                f"environments {rows} have ended: reset them with options={{'reset_mask': ...}} before the next step"
            )
        # What the step does to a row that is about to start anew does not matter; its action must only be valid, and
        # the random numbers that it takes are given back.
        generators = [self.batch.generators[row] for row in rows]
        before = [generator.bit_generator.state for generator in generators]
        step = self._advance(np.where(starting[:, None], 0.0, actions))
        for generator, state in zip(generators, before, strict=True):
            generator.bit_generator.state = state
        seen, reading = self._restart(rows)
        outcome = cleared(step.outcome, starting)
        self._ended = outcome.terminated | outcome.truncated
        infos = infos_of(reading, outcome, np.ones(self.num_envs, bool), ~starting)
        return seen, outcome.reward, outcome.terminated, outcome.truncated, infos

    def state(self) -> VectorState:
        """Everything that decides the future, for set_state; picklable."""
        return VectorState(self.batch.state(), self._ended.copy(), self._steps.copy())

    def set_state(self, state: VectorState) -> None:
        """Continues from a state, bit for bit, in this or another environment of the same keywords.
        Raises InvalidValueError for what is no state of a vector."""
        if not isinstance(state, VectorState):
            raise InvalidValueError(f"set_state takes what state() returned, got {type(state).__name__}")
        self.batch.set_state(state.batch)
        self._ended, self._steps = state.ended.copy(), state.steps.copy()

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """What each environment has by that name. Raises UnknownNameError, an AttributeError too, for what none has."""
        if name in self._attributes:
            return tuple(self._attributes[name])
        if name in ("action_space", "observation_space"):
            return (getattr(self, f"single_{name}"),) * self.num_envs
        if name == "np_random":
            return tuple(self.batch.generators)
        if name == "model" and hasattr(self.batch.plant, "mechanics"):
            mechanics: Any = self.batch.plant.mechanics  # pyright: ignore[reportAttributeAccessIssue]
            return tuple(mechanics.env_model(row) for row in range(self.num_envs))
        if not hasattr(self, name):
            public = [each for each in dir(self) if not each.startswith("_")]
            raise _NoAttribute(str(unknown_name("attribute", name, [*public, *self._attributes])))
        return (getattr(self, name),) * self.num_envs

    def set_attr(self, name: str, values: Any) -> None:
        """Puts an attribute on each environment, for get_attr: a list or tuple has one for each, anything else is for
        all. Raises InvalidValueError for one that the environments have already: they are one array."""
        listed = list(values) if isinstance(values, list | tuple) else [values] * self.num_envs
        if len(listed) != self.num_envs:
            raise InvalidValueError(f"{name} lists {len(listed)} values for {self.num_envs} environments")
        if name == "np_random" or hasattr(self, name):
            raise InvalidValueError(
                f"cannot set {name!r} of single environments, which are one array: make a new one with other keywords"
            )
        self._attributes[name] = listed

    def call(self, name: str, *args: Any, **keywords: Any) -> tuple[Any, ...]:
        """get_attr, and where each environment has a callable of its own there, what that returns. Raises
        InvalidValueError for this environment's own methods, which act on all at once."""
        found = self.get_attr(name)
        if name not in self._attributes and callable(found[0]):
            raise InvalidValueError(
                f"cannot call {name!r} of single environments, which are one array: call it once for all"
            )
        return tuple(one(*args, **keywords) if callable(one) else one for one in found)

    def render(self) -> tuple[np.ndarray, ...] | None:
        """A picture (height, width, 3) uint8 of each environment, as the single one's. Raises MissingDependencyError,
        naming the packages, where there is no GL library, and InvalidValueError before the first reset."""
        self.batch.require_open("render")
        if self.render_mode is None:
            gymnasium.logger.warn("render() without a render_mode: give render_mode='rgb_array'")
            return None
        if self.batch.reading is None:
            raise InvalidValueError("call reset before render")
        if self._renderer is None:
            from ..pictures import GraspPicture  # loads GL

            self._renderer = GraspPicture(self.batch.plant, self.render_mode, *self._picture)
        frames = (self._renderer.draw(self.batch.reading, row) for row in range(self.num_envs))
        return tuple(frames)

    def close_extras(self, **kwargs: Any) -> None:
        """Frees the pictures' buffers and releases the plant."""
        del kwargs
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
        if "batch" in vars(self):  # gymnasium closes what has been refused, too
            self.batch.close()

    def _restart(
        self, rows: list[int], seeds: list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Any]:
        """Starts the rows anew; those without a seed go on with their generators, and get one where they have none."""
        rngs = []
        for row, seed in zip(rows, seeds or [None] * len(rows), strict=True):
            fresh = seed is not None or self.batch.never_reset(row)
            rngs.append(np_random(seed)[0] if fresh else self.batch.generators[row])
        seen, reading = self.batch.reset(rows, rngs, options)
        self._ended[rows], self._steps[rows] = False, 0
        return seen, reading

    def _advance(self, actions: np.ndarray) -> Step:
        """The batch's step, truncated at the limit of steps."""
        step = self.batch.step(actions)
        self._steps += 1
        if self._limit is None or not (self._steps >= self._limit).any():
            return step
        truncated = step.truncated | ((self._steps >= self._limit) & ~step.terminated)
        return step._replace(truncated=truncated, outcome=step.outcome._replace(truncated=truncated))

    def _renewed(self, step: Step, ended: np.ndarray) -> _Returned:
        """What a step returns after which the ended environments (B,) begin anew."""
        final = np.full(self.num_envs, None, object)
        for row, one in enumerate(iterate(self.observation_space, step.observation)):
            if ended[row]:
                final[row] = {name: value.copy() for name, value in one.items()}
        final_info = infos_of(step.reading, step.outcome, ended)
        seen, reading = self._restart([int(row) for row in np.flatnonzero(ended)])
        outcome = cleared(step.outcome, ended)
        infos = infos_of(reading, outcome, np.ones(self.num_envs, bool), ~ended)
        infos |= {
            "final_obs": final,
            "_final_obs": ended.copy(),
            "final_info": final_info,
            "_final_info": ended.copy(),
        }
        return seen, step.reward, step.terminated, step.truncated, infos


class _NoAttribute(UnknownNameError, AttributeError):
    """As the built-in's, so that hasattr and the wrappers of others understand it."""


def _mode(given: AutoresetMode | str) -> AutoresetMode:
    try:
        return AutoresetMode(given)
    except ValueError:
        raise unknown_name("autoreset_mode", given, [mode.value for mode in AutoresetMode]) from None
