"""What lies in a gripper's reach: the objects of each episode, drawn anew, and what a reading tells of them.

B: environments, O: objects of a scene, F = 2 fingertips.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Protocol

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import Material, material
from ..bodies import ObjectSpec
from ..footprint import GraspBody
from .config import SimulationConfig
from .randomization import draw
from .truth import Truth

Scene = tuple[GraspBody, ...]
"""The objects in one gripper's reach."""


@dataclass(frozen=True, slots=True)
class Episode:
    """What is drawn for one episode. scene: the objects where they lie. centred: the same before placement moves them,
    so that episodes share their thermal networks. drawn: value of every cause of randomization by its name in info.
    task: whole numbers that the layout keeps through the episode."""

    scene: Scene
    centred: Scene
    drawn: dict[str, float]
    task: tuple[int, ...] = ()


class EpisodeLabels(NamedTuple):
    """Labels of one scene or, as arrays, of a batch: names of the material and the model of its heat, and the force N
    from which on the object is crushed."""

    material: Any
    rung: Any
    crushing_force: Any


class Layout(Protocol):
    """Draws the scenes of a simulated plant.

    specs: the objects of a scene at first. possible: every object that may lie in one. lateral: whether the arm slides
    along y. build_when_touched: objects beside the first get their thermal networks when they are touched. task_size:
    how many whole numbers an episode keeps. info: names of what info holds beside what it holds of any plant."""

    config: SimulationConfig
    specs: Sequence[ObjectSpec]
    possible: Sequence[GraspBody]
    lateral: bool
    build_when_touched: bool
    task_size: int
    info: tuple[str, ...]

    def draw(self, rng: np.random.Generator, options: Mapping[str, Any]) -> Episode:
        """One episode. Raises InvalidValueError for options that are none."""
        ...

    def labels(self, scene: Scene, centred: Scene, rungs: tuple[str, ...]) -> EpisodeLabels:
        """The labels of one scene, each object's heat computed by one of `rungs`. centred: as in Episode."""
        ...

    def extend(self, truth: Truth, task: np.ndarray, lift: np.ndarray, force: np.ndarray) -> None:
        """Adds what else this layout's readings tell. task: (B, task_size). lift: (B, O) m. force: (B, O, F, 3) N on
        each object. truth has object_temperatures and touched where there are several objects."""
        ...


class SceneLayout:
    """One object that is to be grasped, and maybe others beside it that stay where they were put. Reset option:
    material, for this episode."""

    lateral, build_when_touched, task_size = False, True, 0

    def __init__(self, config: SimulationConfig) -> None:
        self.config, self._stack = config, config.stack
        self.possible: Sequence[GraspBody] = config.possible_bodies(self._stack)
        self.specs: Sequence[ObjectSpec] = (self.possible[0].spec, *config.others)
        self.info: tuple[str, ...] = ("touched", "object_temperatures") if config.others else ()
        self._choices, self._shapes = config.choices, config.shapes
        self._causes = config.causes

    def draw(self, rng: np.random.Generator, options: Mapping[str, Any]) -> Episode:
        """See Layout."""
        unknown = set(options) - {"material"}
        if unknown:
            raise InvalidValueError(f"unknown reset options {sorted(unknown)}; the known one is 'material'")
        config, choices = self.config, self._choices
        if "material" in options:
            config = replace(config, material=options["material"])
            choices = config.choices
        reach, turn = config.placement
        chosen = choices[int(rng.integers(len(choices)))]
        x, y, angle = rng.uniform(-1.0, 1.0, 3)
        shape = any_of(self._shapes, rng)
        middle = shape.position
        spec = replace(
            shape,
            position=(middle[0] + x * reach, middle[1] + y * reach),
            yaw=shape.yaw + np.deg2rad(angle * turn),
        )
        drawn = draw(self._causes, rng)
        first = config.body(self._stack, chosen, spec, drawn)
        centred = replace(first, spec=replace(first.spec, position=middle, yaw=shape.yaw))
        others = self._others(config, choices, drawn, rng)
        return Episode((first, *others), (centred, *others), drawn)

    def labels(self, scene: Scene, centred: Scene, rungs: tuple[str, ...]) -> EpisodeLabels:
        """See Layout; of the object that is to be grasped."""
        return EpisodeLabels(scene[0].material.name, rungs[0], scene[0].crushing_force)

    def extend(self, truth: Truth, task: np.ndarray, lift: np.ndarray, force: np.ndarray) -> None:
        """See Layout; nothing else."""

    def _others(
        self,
        config: SimulationConfig,
        choices: tuple[Material, ...],
        drawn: dict[str, float],
        rng: np.random.Generator,
    ) -> Scene:
        """The objects beside the first, where they were put and of their own size; else of the first's draws."""
        bodies, drawn = [], {**drawn, "size_factor": 1.0}
        for spec in config.others:
            chosen = choices[int(rng.integers(len(choices)))]
            if spec.material is not None:
                chosen = material(spec.material)
            bodies.append(config.body(self._stack, chosen, spec, drawn))
        return tuple(bodies)


def any_of(shapes: tuple[ObjectSpec, ...], rng: np.random.Generator) -> ObjectSpec:
    """One of the shapes; a single one takes nothing from the generator."""
    return shapes[int(rng.integers(len(shapes))) if len(shapes) > 1 else 0]
