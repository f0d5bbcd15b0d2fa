"""Two objects beside each other, under a gripper that also moves along the table, and what is asked of them.

The gripper grasps along y, object 0 at y < 0 and object 1 at y > 0, alike in shape, colour, mass and friction; where on
them its fingers close is their spec's `position`, as of a single object.

B: environments, O = 2 objects, F = 2 fingertips, G: what can be asked.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, distinct_text, unknown_name

from ..bodies import DEFAULT_FRICTION, DEFAULT_MASS, ObjectSpec
from ..footprint import GraspBody
from ..limits import LATERAL_REACH
from .config import SimulationConfig, check_fields
from .layouts import Episode, EpisodeLabels, Scene, any_of
from .randomization import draw
from .simulated import SimulatedPlant
from .truth import Truth

OBJECTS = 2
GOALS = ("material", "hotter")
HOTTER = "the hotter one"
GAP = 0.03  # m between the two objects, wider than a pad

Goal = Literal["material", "hotter"]


@dataclass(frozen=True, slots=True)
class PairConfig:
    """What is asked of a pair. goal: "material", the one of the asked material, the two being of two of the
    simulation's materials; or "hotter", both of one material. temperatures: °C of the two, for "hotter" the cooler one
    first; which lies where is drawn. simulation: the rest; its objects' mass and friction are .1 kg and .8 where not
    given, whatever the material. Raises UnknownNameError (goal) and InvalidValueError."""

    goal: Goal
    temperatures: tuple[float, float]
    simulation: SimulationConfig

    def __post_init__(self) -> None:
        if self.goal not in GOALS:
            raise unknown_name("goal", self.goal, GOALS)
        if self.simulation.mode != "T":
            raise InvalidValueError(
                f"mode {self.simulation.mode!r}: elements glued to the objects can't be sorted by touch; give 'T'"
            )
        cooler, hotter = (celsius("object_temperature (°C)", value) for value in self.temperatures)
        if not (cooler < hotter if self.goal == "hotter" else cooler == hotter):
            raise InvalidValueError(
                f"object_temperature {self.temperatures} °C: give one for goal 'material', and for 'hotter' two, the "
                "cooler one first"
            )
        if self.goal == "material" and (
            len(set(self.materials)) < len(self.materials) or len(self.materials) < OBJECTS
        ):
            raise InvalidValueError(
                f"material {list(self.materials)}: give two at least that are to be told apart, each once"
            )

    @property
    def materials(self) -> tuple[str, ...]:
        """Names of those that an episode draws from."""
        return tuple(each.name for each in self.simulation.choices)

    @property
    def goals(self) -> tuple[str, ...]:
        """What can be asked, in the order of the goal's numbers."""
        return self.materials if self.goal == "material" else (HOTTER,)


def pair_config(*, goal: Goal = "material", **simulation: Any) -> PairConfig:
    """Keywords as in SimulationConfig, but object_temperature: °C of both, or a pair, for goal "hotter" the cooler one
    first (20 and 28 by default). Raises InvalidValueError, and TypeError for an unknown keyword."""
    default = (20.0, 28.0) if goal == "hotter" else 24.0
    given = np.ravel(simulation.pop("object_temperature", default)).tolist()
    if len(given) not in (1, OBJECTS):
        raise InvalidValueError(f"object_temperature must be one °C or two, got {given}")
    settings = SimulationConfig(object_temperature=given[0], **simulation)
    alike = [_of_one_weight(shape) for shape in settings.shapes]
    return PairConfig(
        goal,
        (given[0], given[-1]),
        replace(settings, objects=alike, material=settings.choices, skin=settings.worn),
    )


def _of_one_weight(spec: ObjectSpec) -> ObjectSpec:
    """Mass and friction do not follow from the material."""
    mass = DEFAULT_MASS if spec.mass is None and spec.density is None else spec.mass
    friction = DEFAULT_FRICTION if spec.friction is None else spec.friction
    return replace(spec, mass=mass, friction=friction, material=spec.material if spec.parts else None)


class PairLayout:
    """Draws what is asked, where the right object lies, materials and placement. An episode keeps the number of the
    right object and of what is asked."""

    lateral, build_when_touched, task_size = True, False, 2
    info: tuple[str, ...] = ("asked", "right", "object_temperatures")

    def __init__(self, pair: PairConfig) -> None:
        self.pair, self.config, config = pair, pair.simulation, pair.simulation
        self._stack, self._causes = config.stack, config.causes
        self._choices, self._shapes = config.choices, config.shapes
        self.possible: Sequence[GraspBody] = config.possible_bodies(self._stack)
        for body in self.possible:
            self._check_reach(body.spec)
        self.specs: Sequence[ObjectSpec] = self._placed(self.possible[0].spec, np.zeros((OBJECTS, 3)))

    @property
    def places(self) -> tuple[float, float]:
        """m along y, where the gripper is over the two objects, before what placement draws; of the first shape."""
        middle = (_depth(self._shapes[0]) + GAP) / 2
        return -middle, middle

    @property
    def one_of_each(self) -> list[GraspBody]:
        """An object of the first shape of each material, where nothing is randomised."""
        plain = draw((), np.random.default_rng(0))
        return [self.config.body(self._stack, each, self._shapes[0], plain) for each in self._choices]

    def draw(self, rng: np.random.Generator, options: Mapping[str, Any]) -> Episode:
        """See Layout."""
        if options:
            raise InvalidValueError(f"a pair of objects has no reset options, got {sorted(options)}")
        config, count = self.config, len(self._choices)
        right = int(rng.integers(OBJECTS))
        goal = int(rng.integers(count))
        other = goal
        if self.pair.goal == "material":
            other = int(rng.integers(count - 1))
            other += other >= goal
        shape = any_of(self._shapes, rng)
        places = rng.uniform(-1.0, 1.0, (OBJECTS, 3))
        drawn = draw(self._causes, rng)
        pair: list[GraspBody] = []
        for number in range(OBJECTS):
            material = self._choices[goal if number == right else other]
            celsius = self.pair.temperatures[int(number == right)]
            body = replace(config, object_temperature=celsius).body(self._stack, material, shape, drawn)
            pair.append(body)
        specs = self._placed(pair[0].spec, places)
        scene = tuple(replace(t, spec=spec) for t, spec in zip(pair, specs, strict=True))
        centred = tuple(
            replace(t, spec=replace(t.spec, position=shape.position, yaw=shape.yaw)) for t in scene
        )
        return Episode(scene, centred, drawn, (right, goal if self.pair.goal == "material" else 0))

    def labels(self, scene: Scene, centred: Scene, rungs: tuple[str, ...]) -> EpisodeLabels:
        """See Layout; of both objects, under a gripper that is over each."""
        return EpisodeLabels(
            tuple(body.material.name for body in scene), rungs, [body.crushing_force for body in centred]
        )

    def extend(self, truth: Truth, task: np.ndarray, lift: np.ndarray, force: np.ndarray) -> None:
        """See Layout."""
        goals, goal = self.pair.goals, task[:, 1]
        truth["object_temperature"] = truth.get("object_temperatures", truth["object_temperature"])
        truth["lift"], truth["object_force"] = lift, force
        truth["right"], truth["asked"] = task[:, 0].copy(), np.array(goals, object)[goal]
        truth["goal"] = np.eye(len(goals))[goal]

    def _placed(self, spec: ObjectSpec, places: np.ndarray) -> tuple[ObjectSpec, ...]:
        """Both objects on the table. places: (O, 3) of x, y and angle in -1 .. 1 of what the config allows."""
        (reach, turn), (ahead, aside) = self.config.placement, spec.position
        middle = (_depth(spec) + GAP) / 2
        return tuple(
            replace(
                spec,
                name=f"{spec.name}_{number}",
                position=(ahead + x * reach, side * middle + aside + y * reach),
                yaw=spec.yaw + np.deg2rad(angle * turn),
            )
            for number, (side, (x, y, angle)) in enumerate(zip((-1, 1), places.tolist(), strict=True))
        )

    def _check_reach(self, spec: ObjectSpec) -> None:
        most = 2 * (LATERAL_REACH - self.config.placement[0]) - GAP
        if _depth(spec) > most:
            raise InvalidValueError(
                f"objects are {distinct_text(1e3 * _depth(spec), 1e3 * most)} mm deep along y: two beside each other "
                f"are in the gripper's reach up to {1e3 * most:.1f} mm"
            )


def _depth(spec: ObjectSpec) -> float:
    """m, extent along y at this yaw; of the bounding box for a mesh."""
    if spec.shape in ("sphere", "cylinder"):
        return spec.size[1]
    return spec.size[0] * abs(math.sin(spec.yaw)) + spec.size[1] * abs(math.cos(spec.yaw))


def pair_plant(url: str, num_envs: int, **config: Any) -> SimulatedPlant:
    """The plant behind plant="simulated-pair", of two objects. Keywords as pair_config's. Raises UnknownKeywordError
    for others."""
    check_fields(url, config, "goal")
    pair = pair_config(**config)
    return SimulatedPlant(num_envs, pair.simulation, PairLayout(pair))
