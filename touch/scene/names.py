"""Names in a MuJoCo model: found, or refused with names that are near."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Literal

import mujoco

from thermograsp.errors import InvalidValueError, unknown_name

Kind = Literal["geom", "site", "body"]
_OBJECTS = {
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "site": mujoco.mjtObj.mjOBJ_SITE,
    "body": mujoco.mjtObj.mjOBJ_BODY,
}
_COUNTS = {"geom": "ngeom", "site": "nsite", "body": "nbody"}


def find(model: mujoco.MjModel, name: str, kinds: tuple[Kind, ...], what: str) -> tuple[Kind, int]:
    """The first of the kinds that has something of that name, and its number. Raises UnknownNameError; what: of the
    message, such as "fingertip"."""
    if not isinstance(name, str):
        raise InvalidValueError(f"{what}: give the name of a {' or '.join(kinds)}, got {name!r}")
    for kind in kinds:
        number = mujoco.mj_name2id(model, _OBJECTS[kind], name)
        if number >= 0:
            return kind, number
    known = {n for kind in kinds for n in names(model, kind)}
    raise unknown_name(f"{' or '.join(kinds)} ({what})", name, known)


def names(model: mujoco.MjModel, kind: Kind) -> list[str]:
    """All that are named."""
    every = (mujoco.mj_id2name(model, _OBJECTS[kind], n) for n in range(getattr(model, _COUNTS[kind])))
    return [name for name in every if name]


def geom_label(model: mujoco.MjModel, geom: int) -> str:
    """A geom's name, or its number and its body's name."""
    name = mujoco.mj_id2name(model, _OBJECTS["geom"], geom)
    body = mujoco.mj_id2name(model, _OBJECTS["body"], int(model.geom_bodyid[geom]))
    return repr(name) if name else f"{geom} of body {body!r}"


def geoms_of(model: mujoco.MjModel, kind: Kind, number: int) -> tuple[int, ...]:
    """The geoms of what was found: itself, or those of the body, of which only the ones that collide count where any
    does."""
    if kind == "geom":
        return (number,)
    body = number if kind == "body" else int(model.site_bodyid[number])
    first, count = int(model.body_geomadr[body]), int(model.body_geomnum[body])
    of_body = range(first, first + count) if count else range(0)
    return tuple(g for g in of_body if collides(model, g)) or tuple(of_body)


def collides(model: mujoco.MjModel, geom: int) -> bool:
    """Whether MuJoCo looks for contacts of a geom: by its masks, or as one of a <pair>."""
    masks = model.geom_contype[geom] or model.geom_conaffinity[geom]
    return bool(masks or geom in model.pair_geom1 or geom in model.pair_geom2)
