"""What is asked of a pair of objects, and what the pair is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from thermograsp.errors import InvalidValueError, finite, unknown_name

from .scene import DEFAULT_FRICTION, DEFAULT_MASS, ObjectSpec
from .simulation_config import SimulationConfig

OBJECTS = 2
GOALS = ("material", "hotter")
HOTTER = "the hotter one"

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
        cooler, hotter = (finite("object_temperature (°C)", value) for value in self.temperatures)
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
        goal, (given[0], given[-1]), replace(settings, objects=alike, material=settings.choices)
    )


def _of_one_weight(spec: ObjectSpec) -> ObjectSpec:
    """Mass and friction do not follow from the material."""
    mass = DEFAULT_MASS if spec.mass is None and spec.density is None else spec.mass
    friction = DEFAULT_FRICTION if spec.friction is None else spec.friction
    return replace(spec, mass=mass, friction=friction, material=spec.material if spec.parts else None)
