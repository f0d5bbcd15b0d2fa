"""What fingertips touch: bodies and geoms of a model, their materials and temperatures, and the boxes of their heat."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, celsius, unknown_name

from ...thermal import Material, Reservoir, SensorStack, Solid
from ...thermal import material as named_material
from .faces import rotation, triangles
from .names import collides, find, geom_label, geoms_of

PREFIX = "thermograsp:"
"""Of the names of an MJCF's custom texts that tell an object's material and temperature."""
SHAPE = "shape="
"""Before the name of a geom that tells the object's shape, at such a text's end."""

_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
_SAME = 0.05  # of the least side, by which boxes of geoms in one place may differ
_AS_LARGE = 0.1  # of a side, by which the end of an object that is seen may lie from that of its pieces
_ROUND = (math.pi / 6) ** (1 / 3)  # side of the cube of a sphere's volume, of its diameter
_DISC = math.sqrt(math.pi) / 2  # side of the square of a disc's area, of its diameter


@dataclass(frozen=True, slots=True)
class SensorElement:
    """A sensor's element that is glued on an object (O mode), and a place: position (3,) m, the middle of the face that
    is glued, and normal (3,), outward, both in the body's frame. sensor: a preset's name, a .toml file or a
    SensorStack; its first layer, on the thermostat's side, looks outward."""

    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    sensor: str | SensorStack = "seed"

    def __post_init__(self) -> None:
        for field in ("position", "normal"):
            value = getattr(self, field)
            if np.shape(value) != (3,) or not np.isfinite(value).all():
                raise InvalidValueError(f"SensorElement: {field} must be 3 finite numbers, got {value!r}")
        if not np.linalg.norm(self.normal) > 0:
            raise InvalidValueError("SensorElement: its normal must not be zero")


@dataclass(frozen=True, slots=True)
class ThermalBody:
    """What an object is to heat. material: a name of thermal.materials() or a Material. temperature: °C at the start,
    None for that of the air. elements: sensor elements that are glued on it, on an object that is one box; they start
    as warm as it. contents: what keeps it hot or cold from inside, thermal.water or another Reservoir, None for
    nothing; they wet the walls of the hollow of a mesh or of several geoms, and meet any other object at its mean
    temperature. shape: the name of a geom of the same body that is shaped as the object is, such as the mesh to be seen
    of one that collides as convex pieces; whatever touches the pieces is felt on it, and its heat flows in it. None for
    the geoms that collide."""

    material: str | Material
    temperature: float | None = None
    elements: Sequence[SensorElement] = ()
    contents: Reservoir | None = None
    shape: str | None = None

    def __post_init__(self) -> None:
        if self.temperature is not None:
            celsius("ThermalBody: temperature (°C)", self.temperature)
        if not isinstance(self.elements, Sequence) or not all(
            isinstance(e, SensorElement) for e in self.elements
        ):
            raise InvalidValueError(
                f"ThermalBody: elements must be a list of SensorElement, got {self.elements!r}"
            )
        if self.contents is not None and not isinstance(self.contents, Reservoir):
            raise InvalidValueError(
                "ThermalBody: contents must be a thermal.Reservoir such as thermal.water(0.2, conductance=8.0), got "
                f"{self.contents!r}"
            )


@dataclass(frozen=True, slots=True, eq=False)
class BodyShape:
    """An object of a model, and the box that its heat flows in.

    name: as it was asked for. body: number of the MuJoCo body. geoms: the numbers of those that are felt. material.
    temperature: °C. size (3,) m of the box, centre (3,) m and axes (3, 3), its sides' directions in columns, in the
    body's frame. extent (3,) m: the object's true size along them. surface: m2 that the air touches. elements: glued on
    it. contents: in it. pieces: other geoms, which are felt as the only one of `geoms`. shape_name: of
    that one, None where the object's own geoms are felt.

    A box stands as it is; a round or composed object is a box of its volume and proportions. solid: what heat flows in
    instead (own_shape.py), a body of that material in the box's frame, which is as large as it."""

    name: str
    body: int
    geoms: tuple[int, ...]
    material: Material
    temperature: float
    size: np.ndarray
    centre: np.ndarray
    axes: np.ndarray
    extent: np.ndarray
    surface: float
    elements: tuple[SensorElement, ...] = ()
    contents: Reservoir | None = None
    pieces: tuple[int, ...] = ()
    shape_name: str | None = None
    solid: Solid | None = None

    @property
    def touched(self) -> tuple[int, ...]:
        """The numbers of all geoms whose contacts are this object's; those that are felt come last."""
        return (*self.pieces, *self.geoms)

    @property
    def heat_capacity(self) -> float:
        """J/K."""
        volume = float(np.prod(self.size))
        if self.solid is not None:
            volume = sum(part.volume for part in self.solid.parts)
        return volume * self.material.volumetric_heat_capacity

    def of(self, made_of: Material) -> BodyShape:
        """The same of another material."""
        solid = None if self.solid is None else _solid_of(self.solid, made_of)
        return replace(self, material=made_of, solid=solid)


@lru_cache(maxsize=256)
def _solid_of(solid: Solid, made_of: Material) -> Solid:
    """One object for each material, by which networks are known."""
    return Solid(tuple(replace(part, material=made_of) for part in solid.parts))


BodyMaterial = str | Material | ThermalBody
"""What an object is made of."""
Objects = Mapping[str, BodyMaterial | Sequence[BodyMaterial]]
"""By name; a sequence has one for each world."""


def bodies(model: mujoco.MjModel, objects: Objects | None, ambient: float) -> tuple[BodyShape, ...]:
    """The objects of a model: those asked for, and those that its MJCF names; of many worlds, the first one's. Raises
    UnknownNameError and InvalidValueError."""
    wanted: dict[str, BodyMaterial] = dict(described_in_model(model))
    for name, one in (objects or {}).items():
        wanted[name] = _first(name, one)
    if not wanted:
        raise InvalidValueError(
            'objects: none given; say what may be touched, such as {"can": "aluminium"}, or write '
            f'<text name="{PREFIX}can" data="aluminium"/> into the <custom> section of the MJCF'
        )
    found = [_body(model, name, one, ambient) for name, one in wanted.items()]
    owner: dict[int, str] = {}
    for shape in found:
        if not any(collides(model, geom) for geom in shape.touched):  # it may be one that is hidden for now
            warnings.warn(
                f"object {shape.name!r}: {geom_label(model, shape.geoms[0])} is only seen and never touched (its "
                "contype and conaffinity are 0): name the geom that collides, or its body, with this one as the "
                "ThermalBody's shape if it is what the object looks like",
                RuntimeWarning,
                stacklevel=3,
            )
        for first, second in combinations(shape.geoms, 2):
            if _in_one_place(model, first, second):
                warnings.warn(
                    f"object {shape.name!r}: {geom_label(model, first)} and {geom_label(model, second)} fill the same "
                    "place, so that the gas in a contact with both counts twice: give the one that is only to be seen "
                    'contype="0" and conaffinity="0"',
                    RuntimeWarning,
                    stacklevel=3,
                )
        if len(shape.geoms) > 1 and (whole := _seen_whole(model, shape)):
            warnings.warn(
                f"object {shape.name!r} collides as {len(shape.geoms)} geoms, each of which is felt by itself, so that "
                "pads that lean on several or are round may be off by kelvins where they meet. Geom "
                f"{whole!r} has the size of them all: if it is shaped as the object is, give ThermalBody(material, "
                f"shape={whole!r}), on which whatever presses them is felt then",
                RuntimeWarning,
                stacklevel=3,
            )
        for geom in shape.touched:
            if owner.setdefault(geom, shape.name) != shape.name:
                raise InvalidValueError(
                    f"objects {owner[geom]!r} and {shape.name!r} share geom {geom_label(model, geom)}: name it once"
                )
    return tuple(found)


def _seen_whole(model: mujoco.MjModel, shape: BodyShape) -> str:
    """The name of a geom of the object's body that is only to be seen and as large as all geoms that are felt; empty
    where there is none."""
    felt = np.concatenate([_corners(model, geom) for geom in shape.geoms])
    low, high = felt.min(axis=0), felt.max(axis=0)
    first, count = int(model.body_geomadr[shape.body]), int(model.body_geomnum[shape.body])
    for geom in sorted({*range(first, first + count)}.difference(shape.touched)):
        corners, name = _corners(model, geom), model.geom(geom).name
        off = np.abs([corners.min(axis=0) - low, corners.max(axis=0) - high])
        if name and not collides(model, geom) and np.all(off < _AS_LARGE * (high - low)):
            return name
    return ""


def _in_one_place(model: mujoco.MjModel, *geoms: int) -> bool:
    """Whether two geoms of a body have nearly the same box round them."""
    low, high = (np.stack([end(_corners(model, geom), axis=0) for geom in geoms]) for end in (np.min, np.max))
    largest_change = np.abs(np.diff((low, high), axis=1)).max()
    return bool(largest_change < _SAME * (high - low).min())


def _corners(model: mujoco.MjModel, geom: int) -> np.ndarray:
    """Of the box round a geom, (8, 3) m in its body's frame."""
    box = model.geom_aabb[geom]
    return (box[:3] + _CORNERS * box[3:]) @ rotation(model.geom_quat[geom]).T + model.geom_pos[geom]


def require_box(model: mujoco.MjModel, shape: BodyShape, wanted: str, instead: str) -> None:
    """Raises InvalidValueError for an object that is not one box. wanted: who needs one; instead: what to do."""
    kinds = [mujoco.mjtGeom(int(model.geom_type[geom])) for geom in shape.geoms]
    if kinds != [mujoco.mjtGeom.mjGEOM_BOX]:
        what = ", ".join(
            f"{geom_label(model, geom)} ({kind.name.removeprefix('mjGEOM_').lower()})"
            for geom, kind in zip(shape.geoms, kinds, strict=True)
        )
        raise InvalidValueError(f"{wanted}, and {shape.name!r} is {what}: {instead}")


def _first(name: str, described: BodyMaterial | Sequence[BodyMaterial]) -> BodyMaterial:
    if isinstance(described, str | Material | ThermalBody) or not isinstance(described, list | tuple):
        return described  # pyright: ignore[reportReturnType]
    if not described:
        raise InvalidValueError(f"object {name!r}: its list of materials is empty: give one for each world")
    return described[0]


def materials_by_world(
    described: Objects, shapes: Sequence[BodyShape], worlds: int, ambient: float
) -> tuple[dict[str, list[Material]], dict[str, np.ndarray]]:
    """The objects given, by name: their materials in each world, and their first temperatures (worlds,) °C. shapes:
    what they are otherwise. Raises InvalidValueError and UnknownNameError."""
    known = {shape.name: shape for shape in shapes}
    materials, temperatures = {}, {}
    for name, one in described.items():
        if name not in known:
            raise unknown_name("object", name, known)
        every = list(one) if isinstance(one, list | tuple) else [one] * worlds
        if len(every) != worlds:
            raise InvalidValueError(
                f"object {name!r}: give one material or one for each of {worlds} worlds, got {len(every)}"
            )
        bodies_ = [_thermal_body(name, each) for each in every]
        if any(tuple(body.elements) != known[name].elements for body in bodies_ if body.elements):
            raise InvalidValueError(f"object {name!r}: its elements must be the same in every world")
        if any(body.contents != known[name].contents for body in bodies_ if body.contents is not None):
            raise InvalidValueError(
                f"object {name!r}: its contents must be the same in every world and after every reset, those that the "
                "ThermalTouch was made with"
            )
        if any(body.shape not in (None, known[name].shape_name) for body in bodies_):
            raise InvalidValueError(
                f"object {name!r}: its shape must be the same in every world and after every reset, that which the "
                "ThermalTouch was made with"
            )
        materials[name] = [named_material(body.material) for body in bodies_]
        first = [ambient if body.temperature is None else float(body.temperature) for body in bodies_]
        temperatures[name] = np.array(first)
    return materials, temperatures


def _thermal_body(name: str, described: object) -> ThermalBody:
    if isinstance(described, ThermalBody):
        return described
    if not isinstance(described, str | Material):
        raise InvalidValueError(
            f"object {name!r}: give a material's name, a Material or a ThermalBody, got {described!r}"
        )
    return ThermalBody(described)


def described_in_model(model: mujoco.MjModel) -> dict[str, ThermalBody]:
    """The objects that the MJCF itself describes: custom texts "thermograsp:NAME" of a material and, behind it, °C and
    "shape=GEOM". Where MjSpec.attach has renamed them with the rest, "PREFIXthermograsp:NAME", they are of PREFIXNAME
    and PREFIXGEOM."""
    found = {}
    for number in range(model.ntext):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TEXT, number) or ""
        attached, ours, label = name.partition(PREFIX)
        if not ours:
            continue
        first, count = int(model.text_adr[number]), int(model.text_size[number])
        text = bytes(model.text_data)[first : first + count].split(b"\0")[0].decode()
        words, told, shape = (part.strip() for part in text.partition(SHAPE))
        try:
            made_of, *rest = words.split()
            (degrees,) = map(float, rest) if rest else (None,)
            if told and not shape:
                raise ValueError
        except ValueError:
            raise InvalidValueError(
                f'<text name="{name}" data="{text}"/>: write a material, a temperature in °C if it is not the air\'s, '
                'and last the geom that is shaped as the whole if there is one, such as "aluminium 5.0" or "ceramic '
                f'60 {SHAPE}mug_visual"'
            ) from None
        found[attached + label] = ThermalBody(made_of, degrees, shape=attached + shape if shape else None)
    return found


def _body(model: mujoco.MjModel, name: str, described: BodyMaterial, ambient: float) -> BodyShape:
    kind, number = find(model, name, ("body", "geom"), "object")
    body = _thermal_body(name, described)
    geoms = geoms_of(model, kind, number)
    if not geoms:
        raise InvalidValueError(
            f"object {name!r} has no geom, so there is nothing to touch: name another body"
        )
    shaped = geoms if body.shape is None else (_shape_geom(model, name, body.shape, geoms),)
    size, centre, axes, extent, surface = _box(model, name, shaped)
    return BodyShape(
        name,
        int(model.geom_bodyid[geoms[0]]),
        shaped,
        named_material(body.material),
        ambient if body.temperature is None else float(body.temperature),
        size,
        centre,
        axes,
        extent,
        surface,
        tuple(body.elements),
        body.contents,
        tuple(geom for geom in geoms if geom not in shaped),
        body.shape,
    )


def _shape_geom(model: mujoco.MjModel, name: str, shape: str, geoms: tuple[int, ...]) -> int:
    """The geom that tells an object's shape."""
    _, geom = find(model, shape, ("geom",), f"shape of object {name!r}")
    body, own = (int(model.geom_bodyid[each]) for each in (geom, geoms[0]))
    if body != own:
        raise InvalidValueError(
            f"object {name!r}: geom {shape!r} is of body {model.body(body).name!r}, and a shape must be of the "
            f"object's own body, {model.body(own).name!r}"
        )
    return geom


def _box(
    model: mujoco.MjModel, name: str, geoms: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:
    measured = [_measured(model, name, geom) for geom in geoms]
    if len(geoms) == 1:
        geom, (size, extent, surface) = geoms[0], measured[0]
        turn = rotation(model.geom_quat[geom])
        middle = model.geom_aabb[geom, :3] if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH else 0.0
        return size, model.geom_pos[geom] + turn @ np.broadcast_to(middle, 3), turn, extent, surface
    corners = np.concatenate([_corners(model, geom) for geom in geoms])
    low, high = corners.min(axis=0), corners.max(axis=0)
    extent = high - low
    volume = sum(float(np.prod(size)) for size, _, _ in measured)
    size = extent * min((volume / float(np.prod(extent))) ** (1 / 3), 1.0)
    return size, (low + high) / 2, np.eye(3), extent, sum(surface for _, _, surface in measured)


def _measured(model: mujoco.MjModel, name: str, geom: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Of a geom: the size (3,) m of the box of its volume, its true size (3,) m and its surface, m2."""
    kind, (a, b, c) = mujoco.mjtGeom(int(model.geom_type[geom])), (float(s) for s in model.geom_size[geom])
    shapes = mujoco.mjtGeom
    if kind == shapes.mjGEOM_BOX:
        size = 2 * np.array([a, b, c])
        return size, size, 8 * (a * b + b * c + a * c)
    if kind == shapes.mjGEOM_SPHERE:
        return np.full(3, 2 * a * _ROUND), np.full(3, 2 * a), 4 * math.pi * a * a
    if kind == shapes.mjGEOM_ELLIPSOID:
        extent = 2 * np.array([a, b, c])
        mean = ((a * b) ** 1.6 + (b * c) ** 1.6 + (a * c) ** 1.6) / 3  # Thomsen's formula, to 1 %
        return extent * _ROUND, extent, 4 * math.pi * mean ** (1 / 1.6)
    if kind == shapes.mjGEOM_CYLINDER:
        extent = 2 * np.array([a, a, b])
        return extent * (_DISC, _DISC, 1), extent, 2 * math.pi * a * (a + 2 * b)
    if kind == shapes.mjGEOM_CAPSULE:
        extent = 2 * np.array([a, a, b + a])
        return (
            np.array([2 * a * _DISC, 2 * a * _DISC, 2 * b + 4 / 3 * a]),
            extent,
            4 * math.pi * a * (a + b),
        )
    if kind == shapes.mjGEOM_MESH:
        faces = triangles(model, geom)
        middle = faces.reshape(-1, 3).mean(axis=0)
        p, q, r = np.moveaxis(faces - middle, 1, 0)
        volume = float(np.einsum("fi,fi->", p, np.cross(q, r)) / 6)
        extent = 2 * model.geom_aabb[geom, 3:]
        if volume > 1e-12:
            surface = float(np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() / 2)
            return extent * min((volume / float(np.prod(extent))) ** (1 / 3), 1.0), extent, surface
        if volume < -1e-12:
            raise InvalidValueError(
                f"object {name!r}: the faces of mesh {geom_label(model, geom)} look inwards: turn them, e.g. with "
                "trimesh's invert()"
            )
    label = kind.name.removeprefix("mjGEOM_").lower()
    raise InvalidValueError(
        f"object {name!r}: geom {geom_label(model, geom)} is a {label} without volume, so it holds no heat: "
        "give it a box as thick as what it stands for, and name that"
    )
