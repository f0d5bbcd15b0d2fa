"""How a mesh is felt beside the MuJoCo geom that it stands for: ThermalTouch with a flat bare pad on either.

    python studies/meshes/beside_geoms.py
    python studies/meshes/beside_geoms.py capsule ball --material glass --seconds 1 --json

The pad of 20 mm presses with 8 N from above on an object that is turned about the y axis, its middle `aside` m beside
the object's; "top" is over the highest point. Neither is the truth: a mesh is as round as its hull's faces tell on the
side to which the pad belongs, and an ellipsoid's geom conducts what balls of radii on either side of its own do, within
2.5 %. Where the pad is between two sides of the mesh, as at 60 degrees, the geom is the truer one.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Sequence

import mujoco
import numpy as np
import trimesh

from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import CONDUCTANCE

FORCE = 8.0  # N
TIMESTEP = 0.002  # s
BLOCK, BAR, ELLIPSOID = (0.02, 0.02, 0.02), (0.003, 0.03, 0.01), (0.01, 0.02, 0.03)  # half sides m
RADIUS, HALF = 0.01, 0.02  # m


def _box(half: tuple[float, float, float]) -> tuple[str, trimesh.Trimesh]:
    size = " ".join(map(str, half))
    return f'type="box" size="{size}"', trimesh.creation.box([2 * each for each in half])


def _ellipsoid(half: tuple[float, float, float]) -> tuple[str, trimesh.Trimesh]:
    made = trimesh.creation.icosphere(4)
    made.apply_scale(half)
    return f'type="ellipsoid" size="{" ".join(map(str, half))}"', made


SOLIDS = {
    "block": _box(BLOCK),
    "bar": _box(BAR),
    "ball": (f'type="sphere" size="{RADIUS}"', trimesh.creation.icosphere(4, RADIUS)),
    "capsule": (
        f'type="capsule" size="{RADIUS} {HALF}"',
        trimesh.creation.capsule(2 * HALF, RADIUS, count=[32, 32]),
    ),
    "cylinder": (
        f'type="cylinder" size="{RADIUS} {HALF}"',
        trimesh.creation.cylinder(RADIUS, 2 * HALF, sections=64),
    ),
    "ellipsoid": _ellipsoid(ELLIPSOID),
}
"""The geom, and a mesh of the same body."""
TOUCHES: dict[str, Sequence[tuple[float, float | None]]] = {
    "block": ((0.0, 0.0), (0.0, 0.018), (10.0, 0.0)),
    "bar": ((0.0, 0.0), (90.0, 0.0)),
    "ball": ((0.0, 0.0), (30.0, None)),
    "capsule": ((0.0, 0.0), (10.0, None), (90.0, 0.0)),
    "cylinder": ((0.0, 0.0), (90.0, 0.0)),
    "ellipsoid": ((0.0, 0.0), (10.0, None), (45.0, None), (60.0, None), (90.0, 0.0)),
}
"""Degrees about the y axis, and m aside, None over the highest point."""


def felt(
    name: str, mesh: bool, degrees: float, aside: float | None, made_of: str, seconds: float
) -> tuple[float, float]:
    """W/K of the contact and K of drop in the end."""
    geom, solid = SOLIDS[name]
    turn, quat = np.zeros(9), np.zeros(4)
    mujoco.mju_axisAngle2Quat(quat, np.array([0.0, 1.0, 0.0]), math.radians(degrees))
    mujoco.mju_quat2Mat(turn, quat)
    points = solid.vertices @ turn.reshape(3, 3).T
    top = points[points[:, 2].argmax()] if aside is None else np.array([aside, 0.0, points[:, 2].max()])
    vertex, face = (" ".join(f"{x:.9g}" for x in part.ravel()) for part in (solid.vertices, solid.faces))
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep="{TIMESTEP}" gravity="0 0 0"/>
      <asset><mesh name="thing" vertex="{vertex}" face="{face}"/></asset><worldbody>
        <body name="thing" quat="{" ".join(map(str, quat))}">
          <geom {'type="mesh" mesh="thing"' if mesh else geom}/></body>
        <body name="tip" pos="{top[0]} {top[1]} {top[2] + 0.0045}">
          <joint type="slide" axis="0 0 -1" damping="20"/>
          <geom name="tip" type="box" size=".01 .01 .004" mass=".05"/></body>
      </worldbody></mujoco>""")
    data = mujoco.MjData(model)
    touch = ThermalTouch(
        model, fingertips={"tip": Fingertip("tip")}, objects={"thing": made_of}, air=0.0, chain="ideal"
    )
    data.qfrc_applied[:] = FORCE
    conducted = 0.0
    for _ in range(round(seconds / TIMESTEP)):
        mujoco.mj_step(model, data)
        touch.update(data)
        if touch._reader.substeps:
            conducted = touch._reader.touches[0, 0, 0, CONDUCTANCE] / touch._reader.substeps
    return float(conducted), float(touch.reading.temperature_drop[0])


def main(arguments: Sequence[str] | None = None) -> None:
    """Prints a line a touch."""
    parser = argparse.ArgumentParser(description="Meshes beside the geoms that they stand for.")
    parser.add_argument("solids", nargs="*", help=f"of {', '.join(SOLIDS)} (all)")
    parser.add_argument("--material", default="aluminium")
    parser.add_argument("--seconds", type=float, default=2.0, help="of the touch (2)")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    options = parser.parse_args(arguments)
    unknown = sorted(set(options.solids) - set(SOLIDS))
    if unknown:
        parser.error(f"no solid {unknown[0]!r}: choose from {', '.join(SOLIDS)}")
    for name in options.solids or SOLIDS:
        for degrees, aside in TOUCHES[name]:
            words = degrees, aside, options.material, options.seconds
            (geom, geom_drop), (mesh, mesh_drop) = (felt(name, which, *words) for which in (False, True))
            place = "top" if aside is None else f"{1e3 * aside:.0f} mm"
            if options.json:
                record = {"solid": name, "degrees": degrees, "aside": aside, "geom": [geom, geom_drop]}
                print(json.dumps({**record, "mesh": [mesh, mesh_drop]}), flush=True)
            else:
                print(
                    f"{name:>10} {degrees:3.0f} deg {place:>6}: geom {geom:.4f} W/K {geom_drop:5.2f} K, "
                    f"mesh {mesh:.4f} W/K {mesh_drop:5.2f} K",
                    flush=True,
                )


if __name__ == "__main__":
    main()
