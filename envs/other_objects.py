"""The objects of a scene beside the first one, which is grasped: what they are, and how the gripper meets them all.

B: environments, O: objects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thermograsp.plant import Command

from .mechanics import Mechanics
from .mechanics_kernel import Motion
from .scene import ObjectSpec
from .scene_heat import SceneHeat, SceneHeatStep


def apart(scene: Sequence[ObjectSpec]) -> tuple[ObjectSpec, ...]:
    """The objects with names of their own: a name that came before gets its number."""
    names: list[str] = []
    for number, spec in enumerate(scene):
        names.append(f"{spec.name}_{number}" if spec.name in names else spec.name)
    return tuple(replace(spec, name=name) for spec, name in zip(scene, names, strict=True))


def advance_scene(
    mechanics: Mechanics, heat: SceneHeat, command: Command, substeps: int
) -> tuple[Motion, SceneHeatStep]:
    """One control step of all environments. The motion's force is that on all objects, its height the first one's."""
    motions = mechanics.advance_all(command.opening, command.force_limit, command.lift_rate, substeps)
    step = heat.advance(
        np.stack([motion.normal for motion in motions], axis=1),
        np.stack([motion.place for motion in motions], axis=1),
    )
    force = motions[0].force.copy()
    for other in motions[1:]:
        force += other.force
    return motions[0]._replace(force=force), step
