"""The objects that a configuration names: read from the library, numbered, and checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError

from ..bodies import ObjectSpec


def check_objects(name: str, given: Any) -> None:
    """Raises InvalidValueError for what is no list of objects and names of the library; None is none."""
    several = isinstance(given, Sequence | np.ndarray) and not isinstance(given, str)
    if given is not None and not (several and all(isinstance(one, str | ObjectSpec) for one in given)):
        raise InvalidValueError(
            f"{name} must be ObjectSpecs or names of the library, several of them in a list, got {given!r}"
        )


def drawn_objects(given: str | ObjectSpec | Sequence[str | ObjectSpec] | None) -> tuple[ObjectSpec, ...]:
    """The shapes that an episode draws from, a box for None. Raises UnknownNameError; InvalidValueError for an empty
    list, and where their names or numbers of convex pieces differ, which all environments of a batch share."""
    given = ObjectSpec() if given is None else given
    listed = tuple(map(_from_library, [given] if isinstance(given, str | ObjectSpec) else given))
    if not listed:
        raise InvalidValueError("objects is an empty list: give at least one, or None for a box")
    if len({(shape.name, shape.hulls) for shape in listed}) != 1:
        raise InvalidValueError(
            f"objects {[shape.name for shape in listed]} of {[shape.hulls for shape in listed]} convex pieces: "
            "give only those of one name and one number of pieces"
        )
    return listed


def scene_objects(scene: Sequence[str | ObjectSpec]) -> tuple[ObjectSpec, ...]:
    """The objects with a name each: a name that came before gets its number. Raises UnknownNameError."""
    names: list[str] = []
    listed = tuple(map(_from_library, scene))
    for number, spec in enumerate(listed):
        names.append(f"{spec.name}_{number}" if spec.name in names else spec.name)
    return tuple(replace(spec, name=name) for spec, name in zip(listed, names, strict=True))


def all_plain_boxes(given: str | ObjectSpec | Sequence[str | ObjectSpec] | None) -> bool:
    """Whether all are boxes without a material of their own, on which a bare, rigid face lies flat; None is one."""
    several = [given] if given is None or isinstance(given, str | ObjectSpec) else given
    return all(
        one is None or (isinstance(one, ObjectSpec) and one.shape == "box" and one.material is None)
        for one in several
    )


def _from_library(one: str | ObjectSpec) -> ObjectSpec:
    if isinstance(one, ObjectSpec):
        return one
    from ..bodies import library_object

    return library_object(one).spec()
