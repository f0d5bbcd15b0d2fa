"""Bodies without a joint, as importers of URDF make them of fixed links: they move with a fingertip or an object, but
their geoms are not its own."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence

import mujoco

from ..bodies import BodyShape
from ..fingertips import Fingertip, PadPlace
from ..names import collides, find, geom_label

_NAMED = 3  # geoms that a warning names


def warn_of_fixed_bodies(
    model: mujoco.MjModel,
    fingertips: Mapping[str, str | Fingertip],
    pads: Sequence[PadPlace],
    shapes: Sequence[BodyShape],
) -> None:
    """Warns the caller's caller of geoms that are fixed to a fingertip or an object which was named by its body, and
    that collide, but are nobody's: nothing is felt there."""
    owned = {geom for one in (*pads, *shapes) for geom in one.touched}
    named = []
    for pad in pads:
        given = fingertips[pad.label]
        name = given.name if isinstance(given, Fingertip) else given
        if find(model, name, ("geom", "site", "body"), "fingertip")[0] == "body":
            cure = "name the body or geom whose face feels"
            named.append((f"fingertip {pad.label!r}", pad.body, cure))
    for shape in shapes:
        if find(model, shape.name, ("body", "geom"), "object")[0] == "body":
            named.append(
                (f"object {shape.name!r}", shape.body, "name each of these bodies as an object of its own")
            )
    for what, body, cure in named:
        left = [geom for geom in _fixed_to(model, body) if geom not in owned and collides(model, geom)]
        if left:
            warnings.warn(
                f"{what}: contacts with {_labels(model, left)} are not felt, since bodies that are fixed to body "
                f"{model.body(body).name!r} are no part of it: {cure}, or write <compiler "
                'fusestatic="true"/> into the MJCF, which makes them one body',
                RuntimeWarning,
                stacklevel=3,
            )


def _labels(model: mujoco.MjModel, geoms: Sequence[int]) -> str:
    more = len(geoms) - _NAMED
    labels = ", ".join(f"geom {geom_label(model, geom)}" for geom in geoms[:_NAMED])
    return labels if more <= 0 else f"{labels} and {more} more"


def _fixed_to(model: mujoco.MjModel, body: int) -> list[int]:
    """The geoms of the bodies below a body that have no joint with it."""
    fixed, geoms = {body}, []
    for child in range(body + 1, model.nbody):  # parents come first
        if model.body_parentid[child] in fixed and model.body_jntnum[child] == 0:
            fixed.add(child)
            first = int(model.body_geomadr[child])
            geoms += range(first, first + int(model.body_geomnum[child]))
    return geoms
