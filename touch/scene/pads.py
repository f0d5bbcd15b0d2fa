"""Where the pads of a model's fingertips are, which way they look and how large they are."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import product

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import SensorStack, Surround, material
from ...thermal.matter import skin as named_skin
from ...thermal.matter import surround as named_surround
from ...thermal.stack import HeatedStack, any_sensor, heated_core
from .bodies import BodyShape
from .faces import flat_faces, frame, largest_face, rotation, triangles
from .fingertips import Fingertip, PadPlace
from .looking import Hands
from .names import collides, find, geom_label, geoms_of, names
from .round_faces import FLAT, Place, bulge

SMALLEST = 4e-6  # m2, of a face that can be a pad
_METAL = 1.74e-3  # m, of the seed's thermostat plate
_STEP = 0.01  # s; what is in front of a heater does not depend on it
_FAR = 10.0  # m up to which objects are looked for
_ROUGH = 1e-3  # m, by which places that are nearest to one another may lie apart more than they are told to
_LEVEL, _PLANE = 0.999, 2e-4  # least cosine and m between faces of geoms in one plane
_FILLED = 0.95  # of the rectangle round such faces, from which on it is one pad
_DEFAULT = 0.02  # m, the side of a pad at a site that has no size of its own


def pads(
    model: mujoco.MjModel, fingertips: Mapping[str, str | Fingertip], objects: Sequence[BodyShape]
) -> tuple[PadPlace, ...]:
    """The pads of a model's fingertips, found where nothing has moved yet. Raises UnknownNameError and
    InvalidValueError."""
    if not fingertips:
        raise InvalidValueError('fingertips: none given; name at least one, such as {"thumb": "thumb_pad"}')
    given = {
        label: one if isinstance(one, Fingertip) else Fingertip(one) for label, one in fingertips.items()
    }
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = {
        label: find(model, one.name, ("geom", "site", "body"), f"fingertip {label!r}")
        for label, one in given.items()
    }
    geoms = {label: geoms_of(model, *where) for label, where in found.items()}
    _require_different_geoms(model, geoms, objects)
    _require_labels(fingertips, objects)
    middles = [_middle(data, where, geoms[label]) for label, where in found.items()]
    hands = Hands(model, data, tuple(_carrier(model, where) for where in found.values()), np.array(middles))
    placed = []
    for tip, (label, one) in enumerate(given.items()):
        ways = hands.ways(tip, _objects(model, data, geoms[label], middles[tip], objects))
        placed.append(_pad(model, data, label, one, found[label], geoms[label], ways))
        if placed[-1].surround is not None:
            _require_no_elements(label, objects)
    return tuple(placed)


def _require_labels(labels: Iterable[object], objects: Sequence[BodyShape]) -> None:
    """Raises InvalidValueError for labels by which `touching` could not tell what is touched."""
    taken = {shape.name for shape in objects}
    for label in labels:
        if not isinstance(label, str) or not label:
            raise InvalidValueError(
                f'fingertips: {label!r} is no name; give one to each, such as {{"thumb": "thumb_pad"}}'
            )
        if label in taken:
            raise InvalidValueError(
                f"fingertip {label!r} is called as an object is, and `touching` would not tell the two apart: give the "
                "fingertip another name"
            )


def _require_no_elements(label: str, objects: Sequence[BodyShape]) -> None:
    """Raises InvalidValueError for an object that a fingertip in its pad cannot touch."""
    for shape in objects:
        if shape.elements:
            raise InvalidValueError(
                f"fingertip {label!r}: a pad (surround) touches objects alone, and elements are glued on "
                f"{shape.name!r}: leave surround out"
            )


def _require_different_geoms(
    model: mujoco.MjModel, geoms: Mapping[str, tuple[int, ...]], objects: Sequence[BodyShape]
) -> None:
    owner: dict[int, str] = {}
    for label, pad_geoms in geoms.items():
        if not pad_geoms:
            raise InvalidValueError(
                f"fingertip {label!r} has no geom that could touch anything; geoms: {', '.join(names(model, 'geom'))}"
            )
        if not any(collides(model, geom) for geom in pad_geoms):
            raise InvalidValueError(
                f"fingertip {label!r}: {geom_label(model, pad_geoms[0])} is only seen and never touches (its contype "
                "and conaffinity are 0): name the geom that collides, or its body"
            )
        for geom in pad_geoms:
            if geom in owner:
                raise InvalidValueError(
                    f"fingertips {owner[geom]!r} and {label!r} are on one geom, {geom_label(model, geom)}: give each "
                    "its own geom, since MuJoCo tells contacts apart only by their geoms"
                )
            owner[geom] = label
    for shape in objects:
        for geom in shape.touched:
            if geom in owner:
                raise InvalidValueError(
                    f"geom {geom_label(model, geom)} is fingertip {owner[geom]!r} and part of object {shape.name!r}: "
                    "use different geoms for the two"
                )


def _carrier(model: mujoco.MjModel, where: tuple[str, int]) -> int:
    """The body that carries what was found."""
    kind, number = where
    if kind == "body":
        return number
    return int((model.geom_bodyid if kind == "geom" else model.site_bodyid)[number])


def _middle(data: mujoco.MjData, where: tuple[str, int], geoms: tuple[int, ...]) -> np.ndarray:
    if where[0] == "site":
        return data.site_xpos[where[1]].copy()
    return data.geom_xpos[list(geoms)].mean(axis=0)


def _objects(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geoms: tuple[int, ...],
    middle: np.ndarray,
    objects: Sequence[BodyShape],
) -> list[np.ndarray]:
    """Where the objects are as seen from the middle (3,) m of a fingertip's geoms, the nearest first: as far and along
    as from the fingertip to the nearest point of each, and its centre; the centre first where the nearest points are
    not as near as they are told to be."""
    found = []
    for shape in objects:
        nearest = min(
            (_gap(model, data, *pair) for pair in product(geoms, shape.touched)), key=lambda gap: gap[0]
        )
        centre = data.xpos[shape.body] + data.xmat[shape.body].reshape(3, 3) @ shape.centre
        places = [middle + nearest[1], centre]
        # MuJoCo 3.3.7 tells of some boxes a tenth of a millimetre apart that they touch, at places far from one another
        far = np.linalg.norm(nearest[1]) > 2 * abs(nearest[0]) + _ROUGH
        found.append((nearest[0], places[::-1] if far else places))
    return [place for _, places in sorted(found, key=lambda each: each[0]) for place in places]


def _gap(model: mujoco.MjModel, data: mujoco.MjData, one: int, other: int) -> tuple[float, np.ndarray]:
    """m between two geoms, negative where they overlap, and (3,) m from one to the nearest place of the other."""
    # in the other order MuJoCo 3.3.0 gives the ends of a box and a cylinder the other way round
    if model.geom_type[one] > model.geom_type[other]:
        gap, along = _gap(model, data, other, one)
        return gap, -along
    ends = np.zeros(6)
    gap = mujoco.mj_geomDistance(model, data, one, other, _FAR, ends)
    return gap, math.copysign(1.0, gap) * (ends[3:] - ends[:3])


def _pad(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    label: str,
    one: Fingertip,
    where: tuple[str, int],
    geoms: tuple[int, ...],
    ways: list[np.ndarray],
) -> PadPlace:
    found = _given(model, one, where) or _found(model, data, one, where, geoms, ways)
    if found is None:
        towards_what = (
            "the other fingertips or the objects" if one.normal is None else "where its normal does"
        )
        raise InvalidValueError(
            f"fingertip {label!r}: no face of {one.name!r} of {1e6 * SMALLEST:g} mm2 or more points towards "
            f"{towards_what}; give its pad: Fingertip(name, position=(x, y, z), normal=(x, y, z), size=(y, z))"
        )
    position, axes, size, curvature = found
    if one.size is not None:
        size = np.asarray(one.size, float)
    stack = bare_thermostat(size) if one.sensor is None else any_sensor(one.sensor)
    surround = _surround(label, one, stack, size, curvature)
    skin = named_skin(one.skin)
    if skin is not None:
        stack = skin.over(stack)
    heated = None
    if isinstance(stack, HeatedStack):
        if one.thermostat is not None:
            raise InvalidValueError(
                f"fingertip {label!r}: {stack.name!r} has a heater of its own in place of a thermostat: leave "
                "thermostat out"
            )
        heated, stack = stack, heated_core(stack, _STEP).element
    return PadPlace(
        label,
        _carrier(model, where),
        geoms,
        position,
        axes,
        size,
        stack,
        float(one.temperature),
        heated,
        one.sensor is None,
        None,
        one.thermostat,
        skin,
        curvature,
        surround,
    )


def _given(model: mujoco.MjModel, one: Fingertip, where: tuple[str, int]) -> Place | None:
    """The pad whose place is told, or that is a site."""
    kind, number = where
    if one.position is not None:
        axes = frame(_unit(np.asarray(one.normal, float)))
        return np.asarray(one.position, float), axes, np.full(2, _DEFAULT), FLAT
    if kind != "site":
        return None
    if one.normal is not None:
        raise InvalidValueError(
            f"fingertip {one.name!r} is a site, which looks along its x axis: leave normal out, or give position too"
        )
    flat, size = model.site_type[number] == mujoco.mjtGeom.mjGEOM_BOX, model.site_size[number]
    sides = 2 * size[1:].copy() if flat else np.full(2, _DEFAULT)
    return model.site_pos[number].copy(), rotation(model.site_quat[number]), sides, FLAT


def _found(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    one: Fingertip,
    where: tuple[str, int],
    geoms: tuple[int, ...],
    ways: list[np.ndarray],
) -> Place | None:
    """The pad that looks where the fingertip's normal does, or along the first of the ways that a face of it does."""
    turn = data.xmat[_carrier(model, where)].reshape(3, 3)
    own = [turn.T @ way for way in ways] if one.normal is None else [np.asarray(one.normal, float)]
    for way in own:
        if np.linalg.norm(way) > 1e-6:
            way = _unit(way)
            found = _face(model, geoms, way) or bulge(model, geoms, way, one.normal is not None)
            if found is not None:
                return found
    return None


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def _surround(
    label: str,
    one: Fingertip,
    stack: SensorStack | HeatedStack,
    size: np.ndarray,
    curvature: tuple[float, float],
) -> Surround | None:
    """The pad around a fingertip's bare sensor, of size (2,) m and curvature 1/m. Raises InvalidValueError for what it
    cannot be around, or as wide as."""
    around = named_surround(one.surround)
    if around is None:
        return None
    if isinstance(stack, HeatedStack):
        raise InvalidValueError(
            f"fingertip {label!r}: no pad (surround) goes with {stack.name!r}, a sensor with a heater of its own: "
            "leave surround out"
        )
    if sum(curvature) > 0:
        raise InvalidValueError(
            f"fingertip {label!r}: its pad bulges out, and the heat of a pad (surround) is known of flat ones: leave "
            "surround out, or give a flat pad by position=, normal= and size="
        )
    width = math.sqrt(size.prod())
    if not isinstance(one.surround, Surround):
        around = replace(around, width=width)
    elif around.width > width * (1 + 1e-9):
        raise InvalidValueError(
            f"fingertip {label!r}: surround is {around.width:g} m wide, and the pad is as large as a square of "
            f"{width:g} m: give Surround(width=) at most that"
        )
    return around.around(stack)


def bare_thermostat(size: np.ndarray) -> SensorStack:
    """What stands for the sensor of a fingertip without one, of size (2,) m: its metal."""
    metal = (material("aluminium").layer(_METAL),)
    return SensorStack("none", metal, width=float(np.sqrt(size.prod())), sensed=0, seebeck=1e-3)


def _face(model: mujoco.MjModel, geoms: tuple[int, ...], direction: np.ndarray) -> Place | None:
    """The face of these geoms that looks along a direction of their body's frame, with those of other geoms that make
    one rectangle with it."""
    parts = [(str(geom), triangles(model, geom, hull=True)) for geom in geoms]
    faces = flat_faces([part for part in parts if len(part[1])], direction)
    face = largest_face(faces, direction)
    if face is None or face.area < SMALLEST:
        return None
    level = [
        each
        for each in faces
        if each.normal @ face.normal > _LEVEL and abs((each.centre - face.centre) @ face.normal) < _PLANE
    ]
    place, wide = (
        _rectangle(face.normal, face.corners),
        _rectangle(face.normal, np.concatenate([each.corners for each in level])),
    )
    filled = sum(each.area for each in level) > _FILLED * wide[2].prod()
    return wide if filled else place


def _rectangle(normal: np.ndarray, corners: np.ndarray) -> Place:
    """The narrowest round the corners (n, 3) m of a flat face, in whose plane they are in the mean."""
    axes = frame(normal)
    flat = corners @ axes[:, 1:]
    # the side lengths along the axes in which the face is narrowest
    angles = np.radians(np.arange(0, 90, 1.0))
    turns = np.array([[[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]] for a in angles])
    turned = flat @ turns
    spans = np.ptp(turned, axis=1)
    best = int(np.argmin(np.round(spans.prod(axis=1), 12)))
    axes = np.column_stack((axes[:, 0], axes[:, 1:] @ turns[best]))
    middle = (turned[best].max(axis=0) + turned[best].min(axis=0)) / 2
    return axes @ [float((corners @ axes[:, 0]).mean()), *middle], axes, spans[best], FLAT
