"""What ThermalTouch's tables say of a mesh under a fingertip, beside the same springs point by point.

A steel mesh is pressed at FORCE_N on a fingertip that has the usual skin. The direct computation shares no code with
the tables: each triangle's height at points of the pad, the depth at which the springs under them bear the force, and
the contact law at the pressure of each point. Compared are the area on the sensor's face, the conductance, and the
temperature drop that ThermalTouch's network has after TIME s with such a contact. The direct computation has no gas
beside what touches, which the tables have: curved_patch.py tells what that adds.

    python studies/contact/pressed_meshes.py                  every mesh, half a minute
    python studies/contact/pressed_meshes.py thread --json
"""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache

import mujoco
import numpy as np
import trimesh
from scipy.optimize import brentq

from thermograsp import Fingertip, ThermalTouch
from thermograsp.thermal import SKINS, Pad, Surface, material
from thermograsp.thermal.contact import (
    conductance,
    contact,
    curved_touch,
    face_joint,
    flat_law,
    patch_ends,
    patch_offset,
    skinned,
)
from thermograsp.touch.contacts import AREA, ASIDE, CLOSED, CONDUCTANCE, FORCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.contacts.views import viewed

FORCE_N, TIME, WARM, COOL = 10.0, 2.0, 36.0, 24.0
"""N, s, and °C of the thermostat and of the mesh at first."""
STEEL, SKIN = material("steel"), SKINS["filled_silicone"]
PAD = Pad(width=0.020, face=0.009)
_COARSE, _FINE = 100, 180  # points along the pad's side, and along the face's

Mesh = tuple[np.ndarray, np.ndarray]


def swept(radius: Callable[[np.ndarray, float], np.ndarray], length: float) -> Mesh:
    """A body along y whose radius m is a function of angle and height m."""
    around, up = 180, 240
    angle, heights = np.arange(around) * (2 * np.pi / around), np.linspace(-length / 2, length / 2, up)
    reach = np.array([radius(angle, float(height)) for height in heights])
    level = np.broadcast_to(heights[:, None], reach.shape)
    loops = np.stack([reach * np.cos(angle), level, reach * np.sin(angle)], axis=-1)
    ring = np.arange(around)
    after, faces = np.roll(ring, -1), []
    for k in range(up - 1):
        a, b = around * k, around * (k + 1)
        faces += [np.stack([ring + a, ring + b, after + a], 1), np.stack([after + a, ring + b, after + b], 1)]
    first, last, top = up * around, up * around + 1, around * (up - 1)
    faces += [np.stack([0 * ring + first, ring, after], 1)]
    faces += [np.stack([0 * ring + last, after + top, ring + top], 1)]
    ends = np.array([[0, -length / 2, 0], [0, length / 2, 0]])
    return np.concatenate([*loops, ends]), np.concatenate(faces)


def _smooth(angle: np.ndarray, height: float) -> np.ndarray:
    return 0.01 + 0 * angle


def _thread(angle: np.ndarray, height: float) -> np.ndarray:
    """M20: crests of 1/8 of a pitch of 2.5 mm, flanks of 60 degrees."""
    turn = (height / 0.0025 - angle / (2 * np.pi)) % 1
    return 0.01 - 0.00217 * np.maximum(abs(turn - 0.5) - 1 / 16, 0)


def _gear(angle: np.ndarray, height: float) -> np.ndarray:
    """Twenty teeth on a radius of 20 mm; a pad on top lies on two."""
    turn = (20 * angle / (2 * np.pi)) % 1
    return 0.02 - 0.004 * np.clip((abs(turn - 0.5) - 0.15) / 0.1, 0, 1)


def _made(solid: trimesh.Trimesh) -> Mesh:
    return np.array(solid.vertices), np.array(solid.faces)


@lru_cache
def meshes() -> dict[str, tuple[Mesh, float]]:
    """By name, and the height m of what is on top."""
    return {
        "rod": (swept(_smooth, 0.05), 0.01),
        "thread": (swept(_thread, 0.05), 0.01),
        "gear": (swept(_gear, 0.05), 0.02),
        "ball": (_made(trimesh.creation.icosphere(5, 0.02)), 0.02),
        "block": (_made(trimesh.creation.box((0.04, 0.04, 0.04))), 0.02),
    }


CASES = (
    *(
        ("rod", 0.0, 0.0),
        ("rod", 0.004, 0.0),
        ("thread", 0.0, 0.0),
        ("thread", 0.0, 45.0),
        ("gear", 0.0, 0.0),
    ),
    *(("gear", 0.004, 0.0), ("ball", 0.0, 0.0), ("ball", 0.004, 0.0), ("block", 0.020, 0.0)),
)
"""(mesh, m along x from its middle to the pad's, degrees by which it is turned under the pad)"""


@dataclass(frozen=True, slots=True)
class Contact:
    """conducts: W/K; area: m2 on the face; long: m, the patch's length; shares: (4,) by which it lies at an end of the
    face along both sides, and of the mesh (thermal/contact/patch_place.py)."""

    conducts: float
    area: float
    long: float
    shares: tuple[float, ...]


@lru_cache
def touch_on(name: str) -> ThermalTouch:
    """Of a fingertip above the mesh that looks down."""
    (vertices, faces), top = meshes()[name]
    vertex, face = (" ".join(f"{x:.9g}" for x in part.ravel()) for part in (vertices, faces))
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep=".01"/><asset><mesh name="thing" vertex="{vertex}" face="{face}"/></asset><worldbody>
        <body name="thing"><geom name="thing" type="mesh" mesh="thing" mass="1"/></body>
        <body name="tip" pos="0 0 {top + 0.1}"><geom name="tip" type="box" size=".01 .01 .004"/></body>
      </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), temperature=WARM, skin="filled_silicone")
    return ThermalTouch(
        model,
        fingertips={"tip": tip},
        objects={"thing": STEEL},
        dt=0.01,
        air=0.0,
        ambient=COOL,
        chain="ideal",
    )


def _law() -> np.void:
    sheet = skinned(PAD, SKIN)
    return flat_law(sheet, face_joint(SKIN, Surface.of(STEEL)), (sheet.width, sheet.width))


def flat() -> Contact:
    """As a face without an end."""
    area, share = contact(_law(), FORCE_N, np.zeros(3))
    return Contact(float(conductance(_law(), share / area) * area), float(area), math.sqrt(area), (0.0,) * 4)


def _place(name: str, aside: float, turn: float) -> np.ndarray:
    """(3,) m of the pad's middle in the mesh's body."""
    angle = math.radians(turn)
    return np.array([aside * math.cos(angle), aside * math.sin(angle), meshes()[name][1]])


def tabled(name: str, aside: float, turn: float) -> Contact:
    """By ThermalTouch's table."""
    touch = touch_on(name)
    reader, model, rotation = touch._reader, touch._model, np.zeros(9)
    geom = model.geom("thing").id
    mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
    turned = rotation.reshape(3, 3).T
    place = turned @ (_place(name, aside, turn) - model.geom_pos[geom])
    view, u, v = viewed(reader._views[0], reader._parts[0, 3], turned @ [0.0, 0.0, -1.0], place, PAD.face / 2)
    number = int(reader._curved[0, 0, 0, view, 0])
    table = next(mesh for mesh, known in reader._pressed.items() if known == number).table()
    shares = np.zeros(4)
    conducts, area, long = (float(each) for each in curved_touch(table, FORCE_N, u, v, shares))
    return Contact(conducts, area, long, tuple(shares.tolist()))


def heights(mesh: Mesh, frame: np.ndarray, places: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """(n, m) m of the surface along the pad's normal, inf where there is none, by each triangle's plane. frame (3, 3):
    the pad's middle, and its two sides; it looks along -z. places: (n,) and (m,) m along the sides, evenly spaced."""
    vertices, faces = mesh
    seen = np.stack([(vertices - frame[0]) @ frame[1], (vertices - frame[0]) @ frame[2]], axis=1)
    depth, found = frame[0, 2] - vertices[:, 2], np.full((len(places[0]), len(places[1])), np.inf)
    corner = np.array([places[0][0], places[1][0]])
    pitch = np.array([places[0][1] - places[0][0], places[1][1] - places[1][0]])
    at = (seen - corner) / pitch
    low, high = np.ceil(at[faces].min(axis=1)).astype(int), np.floor(at[faces].max(axis=1)).astype(int)
    low, high = np.maximum(low, 0), np.minimum(high, np.array(found.shape) - 1)
    edges = at[faces[:, 1:]] - at[faces[:, :1]]
    double = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    for f in np.flatnonzero((low <= high).all(axis=1) & (abs(double) > 1e-9)):
        (i0, j0), (i1, j1) = low[f], high[f]
        x = np.arange(i0, i1 + 1)[:, None] - at[faces[f, 0], 0]
        y = np.arange(j0, j1 + 1)[None] - at[faces[f, 0], 1]
        b = (x * edges[f, 1, 1] - y * edges[f, 1, 0]) / double[f]
        c = (y * edges[f, 0, 0] - x * edges[f, 0, 1]) / double[f]
        one, two, three = depth[faces[f]]
        level = np.where(
            (b >= -1e-9) & (c >= -1e-9) & (b + c <= 1 + 1e-9),
            one + b * (two - one) + c * (three - one),
            np.inf,
        )
        part = found[i0 : i1 + 1, j0 : j1 + 1]
        np.minimum(part, level, out=part)
    return found


def pressures(name: str, aside: float, turn: float) -> np.ndarray:
    """(n, n) Pa at points of the face: the mesh on springs, without a tilt, at FORCE_N."""
    angle = math.radians(turn)
    frame = np.array(
        [
            _place(name, aside, turn),
            [math.cos(angle), math.sin(angle), 0],
            [-math.sin(angle), math.cos(angle), 0],
        ]
    )
    sheet = skinned(PAD, SKIN)
    around, on_face = sheet.foundation_modulus / sheet.thickness, SKIN.stiffness
    grids = []
    for side, count in ((PAD.width, _COARSE), (PAD.face, _FINE)):
        middles = (np.arange(count) + 0.5) * side / count - side / 2
        grids.append(heights(meshes()[name][0], frame, (middles, middles)))
    wide, fine = grids
    middles = (np.arange(_COARSE) + 0.5) * PAD.width / _COARSE - PAD.width / 2
    beside = np.maximum(abs(middles)[:, None], abs(middles)[None]) > PAD.face / 2
    areas = (PAD.width / _COARSE) ** 2, (PAD.face / _FINE) ** 2
    # the first grid's points beside the face stand for all of the pad beside it
    rim = (PAD.width**2 - PAD.face**2) / (beside.sum() * areas[0])

    def held(depth: float) -> float:
        """N more than the force."""
        push = around * areas[0] * rim * np.maximum(depth - wide, 0.0)[beside].sum()
        return float(push + on_face * areas[1] * np.maximum(depth - fine, 0.0).sum() - FORCE_N)

    least = float(min(wide.min(), fine.min()))
    return on_face * np.maximum(brentq(held, least, least + 0.01, xtol=1e-15) - fine, 0.0)  # pyright: ignore


def direct(pressure: np.ndarray, aside: float, side: float) -> Contact:
    """Of those pressures. The patch is as long to broad as the contact's moments. aside: m; side: m, the mesh's."""
    law, each = _law(), (PAD.face / _FINE) ** 2
    on = pressure > 0
    through = sum(conductance(law, p) * each for p in pressure[on].tolist())
    area = float(on.sum()) * each
    middle = (np.argwhere(on).mean(axis=0) + 0.5) * PAD.face / _FINE - PAD.face / 2
    at = np.argwhere(on) - np.argwhere(on).mean(axis=0)
    moments = at.T @ at
    spread = np.linalg.eigvalsh(moments)
    longer = math.sqrt(area * math.sqrt(spread[1] / spread[0]))
    sides = (area / longer, longer) if moments[1, 1] >= moments[0, 0] else (longer, area / longer)
    offsets = [patch_offset(off, each, PAD.face) for off, each in zip(middle, sides, strict=True)]
    end = patch_ends(aside + middle[0], aside, sides[0], side, PAD.face)
    return Contact(float(through), area, sides[1], (*offsets, end, 0.0))


def by_network(name: str, aside: float, turn: float, met: Contact) -> float:
    """K of drop after TIME, of ThermalTouch that is told of that contact."""
    touch = touch_on(name)
    reader, data = touch._reader, mujoco.MjData(touch._model)
    row = np.zeros(reader.touches.shape[-1])
    row[[CONDUCTANCE, AREA, LENGTH]] = met.conducts, met.area, met.area * met.long
    row[[CLOSED, FORCE]], row[ASIDE : ASIDE + 4] = (1.0, FORCE_N), met.area * np.array(met.shares)

    def read(data: mujoco.MjData, weight: int = 1) -> None:
        reader.counted += weight
        reader.touches[0, 0, 0] += weight * row
        reader.touches[0, 0, 0, PLACE : PLACE + 3] = _place(name, aside, turn)
        reader.touches[0, 0, 0, NORMAL : NORMAL + 3] = 0.0, 0.0, -1.0

    reader.read, touch._listen = read, lambda: None
    mujoco.mj_forward(touch._model, data)
    touch.reset(data)
    for _ in range(round(TIME / touch._step)):
        data.time += touch._step
        touch.update(data)
    return float(touch.reading.temperature_drop[0])


@dataclass(frozen=True, slots=True)
class Row:
    """area m2, conducts W/K and drop K: as a flat face, by ThermalTouch's table, and directly."""

    mesh: str
    aside: float
    turn: float
    area: tuple[float, float, float]
    conducts: tuple[float, float, float]
    drop: tuple[float, float, float]


def row(name: str, aside: float, turn: float) -> Row:
    """Of a case."""
    side = float(np.ptp(meshes()[name][0][0][:, 0]))
    every = flat(), tabled(name, aside, turn), direct(pressures(name, aside, turn), aside, side)
    return Row(
        *(name, aside, turn),
        tuple(met.area for met in every),  # pyright: ignore[reportArgumentType]
        tuple(met.conducts for met in every),  # pyright: ignore[reportArgumentType]
        tuple(by_network(name, aside, turn, met) for met in every),  # pyright: ignore[reportArgumentType]
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Meshes under ThermalTouch beside springs point by point.")
    parser.add_argument("mesh", nargs="?", default="", help="part of a mesh's name")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    options = parser.parse_args(arguments)
    for case in CASES:
        if options.mesh not in case[0]:
            continue
        found = row(*case)
        if options.json:
            print(json.dumps(asdict(found)), flush=True)
            continue
        name = f"{found.mesh}, {1e3 * found.aside:g} mm aside, turned by {found.turn:g} degrees"
        cells = (
            f"{1e6 * area:.1f} mm2, {conducts:.3f} W/K, {drop:.2f} K"
            for area, conducts, drop in zip(found.area, found.conducts, found.drop, strict=True)
        )
        print(f"{name}\n    flat / table / direct: {'  |  '.join(cells)}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
