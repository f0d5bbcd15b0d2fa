"""Fingertips on anyone's model: where their pads are, which way they look and how large they are."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, celsius, length, numbers

from ...thermal import Material, Pad, SensorStack, Skin, Surface, Surround, Thermostat, material
from ...thermal.contact import touching
from ...thermal.matter import skin as named_skin
from ...thermal.matter import surround as named_surround
from ...thermal.stack import HeatedStack, any_sensor, heated_core
from .bodies import BodyShape
from .closing import closing
from .faces import flat_faces, largest_face, rotation, triangles
from .names import collides, find, geom_label, geoms_of, names

SMALLEST = 4e-6  # m2, of a face that can be a pad
_METAL = 1.74e-3  # m, of the seed's thermostat plate
_STEP = 0.01  # s; what is in front of a heater does not depend on it
_DEFAULT = 0.02  # m, the side of a pad at a site that has no size of its own
_LEANING = 10.0  # degrees of a straight fingertip, beyond which its sensor's face is off what it touches
_WITHIN = 0.8  # of a round geom's radius, half the width of its pad


@dataclass(frozen=True, slots=True)
class Fingertip:
    """A fingertip that feels heat. name: of a geom, a site or a body. sensor: a preset's name, a .toml file or a
    SensorStack, or a HeatedStack, whose heater follows its own law; None for a bare thermostat, which touches elements
    that are glued on objects (O mode). temperature: °C of its thermostat, or of a heated sensor before anything is
    touched. thermostat: one of finite power, whose setpoint is that temperature; None for one that stays there. skin:
    over the sensor's face, a name of thermal.SKINS or a Skin, None for bare alumina. Heat passes it, the
    contact's conductance is its own, and bodies press its springs; bare, what is curved touches a rigid face.
    surround: the pad around the sensor, which gives heat to the sensor's sides and to objects: its material by name or
    a Material, as wide as a square of the pad's area, or a Surround that is no wider; None for a sensor by itself. A
    fingertip with one is flat and sits on an ideal thermostat.

    The pad is the largest flat face of the geom or of the body's geoms that looks at the other fingertips, or the way
    in which the fingertip's own joint closes it, where they are beside it, as on a hand; or at the objects where there
    is one fingertip or no such face. Of a round geom it is where that direction leaves it, and as curved as that is
    there. A site's pad lies in its y and z and looks along its x. Or it is given in the frame of the
    body that carries it, and flat: position (3,) m and normal (3,) together, and size (2,) m."""

    name: str
    position: tuple[float, float, float] | None = None
    normal: tuple[float, float, float] | None = None
    size: tuple[float, float] | None = None
    sensor: str | SensorStack | HeatedStack | None = "seed"
    temperature: float = 36.0
    thermostat: Thermostat | None = None
    skin: str | Skin | None = None
    surround: str | Material | Surround | None = None

    def __post_init__(self) -> None:
        celsius(f"fingertip {self.name!r}: temperature (°C)", self.temperature)
        if self.surround is not None:
            for value, why in (
                (self.thermostat is not None, "a thermostat of finite power: leave thermostat out"),
                (
                    self.sensor is None,
                    "no sensor (sensor=None), around which it could be: leave surround out",
                ),
                (
                    isinstance(self.sensor, HeatedStack),
                    "a sensor with a heater of its own: leave surround out",
                ),
            ):
                if value:
                    raise InvalidValueError(f"fingertip {self.name!r}: no pad (surround) goes with {why}")
        if (self.position is None) != (self.normal is None):
            raise InvalidValueError(f"fingertip {self.name!r}: give position and normal together, or neither")
        for field, count in (("position", 3), ("normal", 3), ("size", 2)):
            value = getattr(self, field)
            if value is None:
                continue
            numbers(f"fingertip {self.name!r}: {field}", value, count)
        for side in () if self.size is None else self.size:
            length(f"fingertip {self.name!r}: size (m)", side)
        if self.normal is not None and not np.linalg.norm(self.normal) > 0:
            raise InvalidValueError(f"fingertip {self.name!r}: its normal must not be zero")


@dataclass(frozen=True, slots=True, eq=False)
class PadPlace:
    """A fingertip's pad. label: the fingertip's. body: number of the MuJoCo body that carries it; geoms: whose contacts
    are its. position (3,) m and axes (3, 3), columns normal, y and z, in the body's frame. size (2,) m along y and z.
    stack: the sensor, or what of it is in front of its heater. temperature: °C of the thermostat or, at first, of the
    heater's place. heated: the whole sensor, where it has a heater of its own. bare: the thermostat
    itself, no sensor. glued: the number of the object that it is an element on, None for a fingertip. thermostat: of
    finite power, None for an ideal one. skin: over the sensor's face, whose last layer it is, None for a bare one.
    curvature: 1/m along y and z, of a pad that bulges out. surround: the pad around the sensor, with its depth."""

    label: str
    body: int
    geoms: tuple[int, ...]
    position: np.ndarray
    axes: np.ndarray
    size: np.ndarray
    stack: SensorStack
    temperature: float
    heated: HeatedStack | None = None
    bare: bool = False
    glued: int | None = None
    thermostat: Thermostat | None = None
    skin: Skin | None = None
    curvature: tuple[float, float] = (0.0, 0.0)
    surround: Surround | None = None

    @property
    def face(self) -> Surface:
        """What touches."""
        return touching(self.skin)

    @property
    def half_sides(self) -> np.ndarray:
        """(2,) m from its middle along y and z up to which contacts are on it. A capsule that leans touches with its
        round end, beyond its straight part."""
        (y, z), leaning = self.curvature, math.sin(math.radians(_LEANING))
        if y > 0 and z == 0:
            return self.size / 2 + (0.0, leaning / y)
        if z > 0 and y == 0:
            return self.size / 2 + (leaning / z, 0.0)
        return self.size / 2

    @property
    def silicone(self) -> Pad:
        """The pad without its skin, as wide as a square of its area. A sensor's face that is wider than a side of the
        pad touches with what the pad bears of it, a square of that area."""
        borne = self.size if self.bare else np.minimum(self.stack.width, self.size)
        return Pad(width=math.sqrt(self.size.prod()), face=math.sqrt(borne.prod()))


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
    middles = {label: _middle(data, where, geoms[label]) for label, where in found.items()}
    bodies = {label: _carrier(model, where) for label, where in found.items()}
    placed = []
    for label, one in given.items():
        middle = middles[label]
        towards = [place for shape in objects for place in _within(data, shape, middle)]
        others = [other for other in given if other != label]
        if others:
            ahead = np.mean([middles[other] for other in others], axis=0)
            carriers = [bodies[other] for other in others]
            way = closing(model, data, bodies[label], middle, carriers, ahead, towards)
            towards = [*([] if way is None else [middle + way]), ahead, *towards]
        placed.append(_pad(model, data, label, one, found[label], geoms[label], towards, middle))
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
        for geom in shape.geoms:
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


def _within(data: mujoco.MjData, shape: BodyShape, near: np.ndarray) -> list[np.ndarray]:
    """Where an object is as seen from a place: the nearest point of what is left of its box less half its least side
    all round, which is a table's part below the place, a rod's beside it and a cube's centre; and its centre."""
    body = data.xmat[shape.body].reshape(3, 3)
    centre, axes = data.xpos[shape.body] + body @ shape.centre, body @ shape.axes
    half = (shape.extent - shape.extent.min()) / 2
    return [centre + axes @ np.clip(axes.T @ (near - centre), -half, half), centre]


def _pad(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    label: str,
    one: Fingertip,
    where: tuple[str, int],
    geoms: tuple[int, ...],
    towards: list[np.ndarray],
    middle: np.ndarray,
) -> PadPlace:
    (kind, number), body = where, _carrier(model, where)
    turn, curvature = data.xmat[body].reshape(3, 3), (0.0, 0.0)
    if one.position is not None:
        normal = np.asarray(one.normal, float)
        found = np.asarray(one.position, float), frame(normal / np.linalg.norm(normal)), np.full(2, _DEFAULT)
    elif kind == "site":
        size = model.site_size[number]
        flat = model.site_type[number] == mujoco.mjtGeom.mjGEOM_BOX
        found = (
            model.site_pos[number].copy(),
            rotation(model.site_quat[number]),
            2 * size[1:].copy() if flat else np.full(2, _DEFAULT),
        )
    else:
        found = None
        for goal in towards:
            away = turn.T @ (goal - middle)
            if np.linalg.norm(away) > 1e-6:
                away = away / np.linalg.norm(away)
                found = _face(model, geoms, away)
                if found is None and (bulge := _bulge(model, geoms, away)) is not None:
                    *found, curvature = bulge
            if found is not None:
                break
    if found is None:
        raise InvalidValueError(
            f"fingertip {label!r}: no face of {one.name!r} of {1e6 * SMALLEST:g} mm2 or more points towards the other "
            "fingertips or the objects; give its pad: Fingertip(name, position=(x, y, z), normal=(x, y, z), "
            "size=(y, z))"
        )
    position, axes, size = found
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
        body,
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


def _face(
    model: mujoco.MjModel, geoms: tuple[int, ...], direction: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Position, axes and size of the face of these geoms that looks along a direction of their body's frame."""
    parts = [(str(geom), triangles(model, geom)) for geom in geoms]
    face = largest_face(flat_faces([part for part in parts if len(part[1])], direction), direction)
    if face is not None and face.area >= SMALLEST:
        axes = frame(face.normal)
        flat = (face.corners - face.centre) @ axes[:, 1:]
        # the side lengths along the axes in which the face is narrowest
        angles = np.radians(np.arange(0, 90, 1.0))
        turns = np.array([[[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]] for a in angles])
        spans = np.ptp(flat @ turns, axis=1)
        best = int(np.argmin(np.round(spans.prod(axis=1), 12)))
        axes = np.column_stack((axes[:, 0], axes[:, 1:] @ turns[best]))
        return face.centre, axes, spans[best]
    return None


_Bulge = tuple[np.ndarray, np.ndarray, np.ndarray, tuple[float, float]]  # position, axes, size, curvature


def _bulge(model: mujoco.MjModel, geoms: tuple[int, ...], direction: np.ndarray) -> _Bulge | None:
    """Of the pad where a direction of the body's frame leaves the first round geom."""
    for geom in geoms:
        if is_round(model, geom):
            return _round(model, geom, direction)
    return None


def is_round(model: mujoco.MjModel, geom: int) -> bool:
    """Whether a geom bulges out somewhere: a ball, a capsule, an ellipsoid or a cylinder."""
    return mujoco.mjtGeom(int(model.geom_type[geom])) in _ROUND_KINDS


_ROUND_KINDS = (
    mujoco.mjtGeom.mjGEOM_SPHERE,
    mujoco.mjtGeom.mjGEOM_CAPSULE,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    mujoco.mjtGeom.mjGEOM_CYLINDER,
)


def _round(model: mujoco.MjModel, geom: int, direction: np.ndarray) -> _Bulge:
    """On a ball the pad is as wide as what looks within 53 degrees of the direction, on a rod as long as that is
    straight."""
    kinds, kind = mujoco.mjtGeom, model.geom_type[geom]
    turn, size = rotation(model.geom_quat[geom]), model.geom_size[geom]
    outward, at = turn.T @ direction, model.geom_pos[geom]
    radius, half = float(size[0]), float(size[1])
    side = float(np.hypot(outward[0], outward[1]))
    rod = kind == kinds.mjGEOM_CYLINDER or (kind == kinds.mjGEOM_CAPSULE and side > 0.5)
    if rod and side > 1e-6:
        out = np.array([outward[0], outward[1], 0.0]) / side
        # a short capsule is as straight along its length as the ellipsoid of its size
        short = kind == kinds.mjGEOM_CAPSULE and half < _WITHIN * radius
        straight = radius / (radius + half) ** 2 if short else 0.0
        axes = np.column_stack((turn @ out, turn @ np.cross([0.0, 0.0, 1.0], out), turn[:, 2]))
        wide = 2 * np.array([_WITHIN * radius, _WITHIN * radius if short else half])
        return at + turn @ (radius * out), axes, wide, (1 / radius, straight)
    if kind == kinds.mjGEOM_CAPSULE:
        point = radius * outward + [0.0, 0.0, math.copysign(half, outward[2])]
        return at + turn @ point, frame(direction), np.full(2, 2 * _WITHIN * radius), (1 / radius, 1 / radius)
    axes_of = size if kind == kinds.mjGEOM_ELLIPSOID else np.full(3, radius)
    point = outward / np.sqrt(np.sum((outward / axes_of) ** 2))
    steep = point / axes_of**2
    out = turn @ (steep / np.linalg.norm(steep))
    axes = frame(out)
    along = turn.T @ axes[:, 1:]
    bent = along.T @ (along / axes_of[:, None] ** 2) / np.linalg.norm(steep)
    if kind == kinds.mjGEOM_ELLIPSOID:  # y and z where it is bent the most and the least
        turned = np.linalg.eigh(bent)[1][:, ::-1]
        turned[:, 1] *= np.linalg.det(turned)
        axes = np.column_stack((out, axes[:, 1:] @ turned))
        bent = turned.T @ bent @ turned
    first, second = (float(bent[i, i]) for i in range(2))
    return at + turn @ point, axes, np.full(2, 2 * _WITHIN * float(axes_of.min())), (first, second)


def frame(normal: np.ndarray) -> np.ndarray:
    """(3, 3) of a unit vector: columns the normal, y and z, along the body's axes where it can be."""
    z = np.eye(3)[2] if abs(normal[2]) < 0.9 else np.eye(3)[0]
    z = z - (z @ normal) * normal
    z = z / np.linalg.norm(z)
    return np.stack([normal, np.cross(z, normal), z], axis=1)
