"""Bodies and places on them that the studies of places compare."""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import trimesh
from place_drops import at

from thermograsp import thermal
from thermograsp.thermal import Solid, SurfacePatch
from thermograsp.thermal.surfaces import SolidPart

MATERIALS = "wood", "ceramic", "stainless_steel", "aluminium"


def mug(radius: float = 0.03, wall: float = 0.003) -> trimesh.Trimesh:
    """80 mm high, its foot as thick as its wall."""
    inner, foot = radius - wall, wall - 0.04
    profile = [(0, -0.04), (radius, -0.04), (radius, 0.04), (inner, 0.04), (inner, foot), (0, foot)]
    return trimesh.creation.revolve(profile, sections=128)


def _block(*size: float) -> Callable[[], trimesh.Trimesh]:
    return lambda: trimesh.creation.box(size)


def _round(radius: float, height: float) -> Callable[[], trimesh.Trimesh]:
    return lambda: trimesh.creation.cylinder(radius, height, sections=96)


def _egg() -> trimesh.Trimesh:
    return trimesh.creation.icosphere(subdivisions=4).apply_transform(np.diag([0.02, 0.02, 0.028, 1]))


def beside(angle: float, height: float, radius: float = 0.03) -> SurfacePatch:
    """On a mug's wall."""
    x, y = math.cos(angle), math.sin(angle)
    return at((radius * x, radius * y, height), (x, y, 0.0))


def on(axis: int, x: float, y: float, z: float) -> SurfacePatch:
    return at((x, y, z), tuple(np.sign((x, y, z)[axis]) * np.eye(3)[axis]))


BODIES: dict[str, Callable[[], trimesh.Trimesh]] = {
    "mug": mug,
    "pot of 1 mm": lambda: mug(0.045, 0.001),
    "cup of .6 mm": lambda: mug(0.03, 0.0006),
    "tube of .2 mm": lambda: mug(0.02, 0.0002),
    "cube": _block(0.04, 0.04, 0.04),
    "small cube": _block(0.012, 0.012, 0.012),
    "bar": _block(0.01, 0.07, 0.024),
    "sheet of 1 mm": _block(0.04, 0.04, 0.001),
    "sheet of .3 mm": _block(0.06, 0.03, 0.0003),
    "cylinder": _round(0.015, 0.05),
    "can": _round(0.025, 0.05),
    "handle": _round(0.01, 0.06),
    "rod": _round(0.006, 0.06),
    "ball": lambda: trimesh.creation.icosphere(subdivisions=4, radius=0.02),
    "egg": _egg,
    "cone": lambda: trimesh.creation.cone(0.02, 0.05, sections=96),
    "ring": lambda: trimesh.creation.torus(0.025, 0.006),
}
SLANT = math.sqrt(0.5)
ONE: dict[str, tuple[str, SurfacePatch]] = {
    "mug, wall": ("mug", beside(0.0, 0.0)),
    "mug, low": ("mug", beside(0.0, -0.0352)),
    "mug, just above the foot": ("mug", beside(0.0, -0.031)),
    "mug, just below the rim": ("mug", beside(0.0, 0.0353)),
    "mug, over the rim": ("mug", beside(0.0, 0.0365)),
    "mug, half over the rim": ("mug", beside(0.0, 0.04)),
    "mug, over the foot's edge": ("mug", beside(0.0, -0.036)),
    "mug, on the rim": ("mug", at((0.0285, 0.0, 0.04), (0.0, 0.0, 1.0))),
    "mug, foot": ("mug", at((0.0, 0.0, -0.04), (0.0, 0.0, -1.0))),
    "mug, foot below the wall": ("mug", at((0.024, 0.0, -0.04), (0.0, 0.0, -1.0))),
    "pot of 1 mm": ("pot of 1 mm", beside(0.0, 0.0, 0.045)),
    "cup of .6 mm": ("cup of .6 mm", beside(0.0, 0.0)),
    "tube of .2 mm": ("tube of .2 mm", beside(0.0, 0.0, 0.02)),
    "cube": ("cube", on(0, 0.02, 0.0, 0.0)),
    "cube, corner": ("cube", on(0, 0.02, 0.0154, 0.0153)),
    "cube, half over an edge": ("cube", on(0, 0.02, 0.02, 0.0)),
    "cube, on an edge": ("cube", at((0.02, 0.02, 0.0), (SLANT, SLANT, 0.0))),
    "small cube": ("small cube", on(0, 0.006, 0.0, 0.0)),
    "bar": ("bar", on(0, 0.005, 0.02, 0.0)),
    "sheet of 1 mm": ("sheet of 1 mm", on(2, 0.0, 0.0, 0.0005)),
    "sheet of .3 mm": ("sheet of .3 mm", on(2, 0.02, 0.0, 0.00015)),
    "cylinder": ("cylinder", on(0, 0.015, 0.0, 0.0)),
    "cylinder, near its end": ("cylinder", on(0, 0.015, 0.0, 0.0204)),
    "cylinder, end": ("cylinder", on(2, 0.0, 0.0, 0.025)),
    "cylinder, side of its end": ("cylinder", on(2, 0.009, 0.0, 0.025)),
    "can, slanted": ("can", at((0.02, 0.015, 0.01), (0.8, 0.6, 0.0))),
    "rod": ("rod", on(0, 0.006, 0.0, 0.0)),
    "ball": ("ball", on(0, 0.02, 0.0, 0.0)),
    "ball, slanted": ("ball", at((0.012, 0.012, 0.0105), (0.6, 0.6, 0.53))),
    "egg": ("egg", on(0, 0.02, 0.0, 0.0)),
    "egg, slanted": ("egg", at((0.012, 0.0, 0.022), (0.6, 0.0, 0.6))),
    "cone": ("cone", at((0.01, 0.0, 0.025), (0.9285, 0.0, 0.3714))),
    "ring": ("ring", on(0, 0.031, 0.0, 0.0)),
}
"""One place: body, and patch."""
TWO: dict[str, tuple[str, SurfacePatch, SurfacePatch]] = {
    "cube, opposite": ("cube", on(0, 0.02, 0.0, 0.0), on(0, -0.02, 0.0, 0.0)),
    "cube, overlapping": ("cube", on(0, 0.02, -0.006, 0.0), on(0, 0.02, 0.0, 0.003)),
    "cube, on either side of an edge": ("cube", on(0, 0.02, 0.014, 0.0), on(1, 0.014, 0.02, 0.0)),
    "bar, opposite": ("bar", on(0, 0.005, 0.01, 0.0), on(0, -0.005, 0.005, 0.0)),
    "mug, opposite": ("mug", beside(0.0, 0.0), beside(math.pi, 0.0)),
    "pot, round it": ("pot of 1 mm", beside(0.0, 0.0, 0.045), beside(0.3, 0.002, 0.045)),
    "cup, round it": ("cup of .6 mm", beside(0.0, 0.0), beside(0.4, 0.002)),
    "tube, round it": ("tube of .2 mm", beside(0.0, 0.0, 0.02), beside(0.6, 0.002, 0.02)),
    "mug, above each other": ("mug", beside(0.0, 0.0), beside(0.0, 0.006)),
    "mug, a quarter round": ("mug", beside(0.0, 0.0), beside(math.pi / 2, 0.0)),
    "mug, over and below the rim": ("mug", beside(0.0, 0.037), beside(0.0, 0.03)),
}
_UP = on(2, 0.0, 0.0, 0.02)
PARTS: dict[str, tuple[str, tuple[str, str], SurfacePatch, SurfacePatch]] = {
    "glass on aluminium, opposite": ("slab", ("glass", "aluminium"), _UP, on(2, 0.0, 0.0, -0.02)),
    "glass on aluminium, overlapping": ("slab", ("glass", "aluminium"), _UP, on(2, 0.006, 0.003, 0.02)),
    "aluminium on wood, overlapping": ("slab", ("aluminium", "wood"), _UP, on(2, 0.006, 0.003, 0.02)),
    "aluminium on wood, beside": ("slab", ("aluminium", "wood"), _UP, on(0, 0.02, 0.003, 0.0)),
    "wood round aluminium": ("core", ("wood", "aluminium"), on(0, 0.02, 0.0, 0.0), on(0, -0.02, 0.0, 0.0)),
}
"""Two places of a body of two materials, the outer or upper first."""


def whole(name: str, material: str) -> Solid:
    """A body of BODIES."""
    return Solid((_part(BODIES[name](), material),))


def parted(name: str, materials: tuple[str, str]) -> Solid:
    """A slab of 4 mm on a block, or a shell of 3 mm round a ball."""
    outer, inner = materials
    if name == "core":
        shells = (trimesh.creation.icosphere(subdivisions=4, radius=r) for r in (0.02, 0.017))
        return Solid(tuple(_part(mesh, of) for mesh, of in zip(shells, materials, strict=True)))
    slab, block = _block(0.04, 0.04, 0.004)(), _block(0.04, 0.04, 0.036)()
    slab.apply_translation((0.0, 0.0, 0.018))
    block.apply_translation((0.0, 0.0, -0.002))
    return Solid((_part(slab, outer), _part(block, inner)))


def _part(mesh: trimesh.Trimesh, material: str) -> SolidPart:
    return SolidPart(np.array(mesh.vertices), np.array(mesh.faces), thermal.material(material))
