"""What it changes that heat in a mesh flows in its own shape: ThermalTouch beside a solid box of the same volume.

    python studies/meshes/own_shapes.py
    python studies/meshes/own_shapes.py mug egg --materials ceramic wood --conductance 2000 --json

The whole face of one sensor, 12 K warmer, touches an object of the library at the height of its file's origin. `press`
is thermal.press_body at the same place: a grid that is fine there, other states and no kernel of the place.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace

import numpy as np

from thermograsp.envs.bodies.library import library_object
from thermograsp.thermal import material, sensor
from thermograsp.thermal.anywhere import surface_patch
from thermograsp.thermal.meshes import press_body
from thermograsp.thermal.surfaces import Solid, SolidPart
from thermograsp.touch.contacts import AREA, CLOSED, COLUMNS, CONDUCTANCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat
from thermograsp.touch.scene import BodyShape, PadPlace

OBJECTS = "mug", "bowl", "beer_bottle", "pill_bottle", "plastic_cup", "water_bottle", "egg", "apple"
MATERIALS = "aluminium", "ceramic"
SENSOR, SUBJECT = 36.0, 24.0  # °C
STEP = 0.01  # s
STACK = sensor("seed")
OUTWARD = np.array([-1.0, 0.0, 0.0])


def surface_of(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices m and faces of an object of the library."""
    surface = library_object(name).solid.surface
    if surface is None:
        raise SystemExit(f"object {name!r} is no mesh, whose heat would flow in its own shape")
    return surface


def shape_of(name: str, made_of: str) -> BodyShape:
    """An object of the library in the middle of its frame, all of one material, as ThermalTouch takes it."""
    vertices, faces = surface_of(name)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    solid = Solid((SolidPart(vertices - (low + high) / 2, faces, material(made_of)),))
    size = high - low
    return BodyShape(
        name,
        0,
        (),
        material(made_of),
        SUBJECT,
        size,
        np.zeros(3),
        np.eye(3),
        size,
        solid.surface,
        solid=solid,
    )


def as_box(shape: BodyShape) -> BodyShape:
    """A solid box of the shape's volume and proportions."""
    assert shape.solid is not None
    share = shape.solid.parts[0].volume / np.prod(shape.size)
    return replace(shape, size=shape.size * share ** (1 / 3), solid=None)


def place_of(name: str) -> np.ndarray:
    """(3,) m of a touch from -x, in the frame of shape_of."""
    vertices, _ = surface_of(name)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return np.array([(low - high)[0] / 2, -(low + high)[1] / 2, 0.0])


def held(shape: BodyShape, place: np.ndarray, conductance: float, seconds: float) -> float:
    """K of the drop after that time, of a whole face that conducts W/(m2 K)."""
    pad = PadPlace("tip", 0, (), np.zeros(3), np.eye(3), np.full(2, 0.02), STACK, SENSOR)
    heat = JoinedHeat((pad,), (), (shape,), worlds=1, dt=STEP, tolerance=0.05, film=0.0, ambient=SUBJECT)
    touch = np.zeros((1, 1, 2, COLUMNS))
    area = STACK.face_area
    touch[0, 0, 0, [CONDUCTANCE, AREA, LENGTH]] = conductance * area, area, area * STACK.width
    touch[0, 0, 0, CLOSED], touch[0, 0, 0, NORMAL] = 1.0, -OUTWARD[0]
    touch[0, 0, 0, PLACE : PLACE + 3] = place
    for _ in range(round(seconds / STEP)):
        heat.advance(touch, 1)
    return float(heat.drop[0, 0])


def pressed(shape: BodyShape, place: np.ndarray, conductance: float, seconds: float) -> float:
    """K by press_body."""
    assert shape.solid is not None
    patch = surface_patch(shape.solid, place, OUTWARD, STACK)
    found = press_body(shape.solid, patch, conductance=conductance, seconds=seconds, dt=2 * STEP)
    return float(found.temperature_drop[-1])


def row(name: str, made_of: str, conductance: float, seconds: float) -> dict[str, float | str]:
    """The three drops of an object, K."""
    shape, place = shape_of(name, made_of), place_of(name)
    return {
        "object": name,
        "material": made_of,
        "own_shape_K": held(shape, place, conductance, seconds),
        "press_K": pressed(shape, place, conductance, seconds),
        "box_K": held(as_box(shape), place, conductance, seconds),
    }


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("objects", nargs="*", default=OBJECTS, help="meshes of the library")
    parser.add_argument("--materials", nargs="+", default=MATERIALS)
    parser.add_argument("--conductance", type=float, default=5000.0, help="W/(m2 K)")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--json", action="store_true", help="print the result as JSON, a line each")
    arguments = parser.parse_args()
    for name in arguments.objects:
        for made_of in arguments.materials:
            found = row(name, made_of, arguments.conductance, arguments.seconds)
            if arguments.json:
                print(json.dumps(found), flush=True)
                continue
            drops = ", ".join(f"{key.removesuffix('_K')} {found[key]:.2f} K" for key in found if "_K" in key)
            print(f"{name:14}{made_of:11}{drops}", flush=True)


if __name__ == "__main__":
    main()
