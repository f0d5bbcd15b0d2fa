"""Scenes of ThermalTouch beside finite volumes in three dimensions that are driven with the conductances it recorded.

Each scene runs in MuJoCo with a ThermalTouch; the conductances that it takes from each step's contacts are noted.
The finite volumes here take these numbers and nothing else from the package's heat models: elements and objects are
grids of cells (a cylinder in its own coordinates), joined face to face where they touch, stepped by TR-BDF2 (Bank et
al. 1985). Two grids tell what the volumes themselves are good to.

    python studies/scenes/touch_volumes.py             every scene
    python studies/scenes/touch_volumes.py regrasp --json
"""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass

import mujoco
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

import thermograsp
from thermograsp import Fingertip
from thermograsp.thermal import material, sensor
from thermograsp.thermal.contact import Pad, Surface, bare_footprint, even_patch
from thermograsp.touch.contacts import CONDUCTANCE, FORCE

STACK = sensor("seed")
HALF = STACK.width / 2
WARM, COOL = 36.0, 24.0
"""°C of the thermostats and of the objects at first."""
GAMMA = 2 - math.sqrt(2)
DT, SUBSTEPS = 0.01, 5
"""s, a sample, and how many steps of the simulation it has."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Cells of a body. edges: of the three axes, m; of a cylinder r, then the angle times the radius, then z. k W/(m K)
    and c J/(m3 K): of the cells along the first axis. radius: m of a cylinder, inf of a box. held: K of what lies
    behind the last cells of the first axis, None where nothing does."""

    edges: tuple[np.ndarray, np.ndarray, np.ndarray]
    k: np.ndarray
    c: np.ndarray
    radius: float = math.inf
    held: float | None = None

    @property
    def shape(self) -> tuple[int, int, int]:
        return tuple(len(edge) - 1 for edge in self.edges)  # pyright: ignore[reportReturnType]

    def around(self, x: np.ndarray) -> np.ndarray:
        """How long a metre of the second axis is at x."""
        return np.ones_like(x) if math.isinf(self.radius) else x / self.radius


@dataclass(frozen=True, slots=True)
class Body:
    """Of a grid: capacity (n,) J/K, conduction (n, n) W/K, and source (n,) W of what lies behind it."""

    grid: Grid
    capacity: np.ndarray
    conduction: sparse.csr_matrix
    source: np.ndarray


def body(grid: Grid) -> Body:
    """Its matrices: each pair of neighbours conducts over half a cell of each, in series."""
    x, y, z = grid.edges
    middle = (x[1:] + x[:-1]) / 2
    dx, dy, dz = np.diff(x), np.diff(y), np.diff(z)
    shape = grid.shape
    number = np.arange(np.prod(shape)).reshape(shape)
    wide = dy[None, :, None] * dz[None, None, :]
    volume = (grid.around(middle) * dx)[:, None, None] * wide
    rows, columns, values = [], [], []

    def joined(one: np.ndarray, other: np.ndarray, through: np.ndarray) -> None:
        rows.append(one.ravel())
        columns.append(other.ravel())
        values.append(np.broadcast_to(through, one.shape).ravel())

    resist = dx / (2 * grid.k)
    joined(
        number[:-1],
        number[1:],
        (grid.around(x[1:-1]) / (resist[:-1] + resist[1:]))[:, None, None] * wide,
    )
    along_y = (grid.k * dx / grid.around(middle))[:, None, None] * dz[None, None, :]
    joined(number[:, :-1], number[:, 1:], along_y * (2 / (dy[:-1] + dy[1:]))[None, :, None])
    along_z = (grid.k * dx * grid.around(middle))[:, None, None] * dy[None, :, None]
    joined(number[:, :, :-1], number[:, :, 1:], along_z * (2 / (dz[:-1] + dz[1:]))[None, None, :])
    i, j, g = (np.concatenate(each) for each in (rows, columns, values))
    count = number.size
    matrix = sparse.csr_matrix((-np.r_[g, g], (np.r_[i, j], np.r_[j, i])), shape=(count, count))
    diagonal = -np.asarray(matrix.sum(axis=1)).ravel()
    source = np.zeros(count)
    if grid.held is not None:
        back = (wide[0] / resist[-1]).ravel()
        diagonal[number[-1].ravel()] += back
        source[number[-1].ravel()] = back * grid.held
    capacity = (grid.c[:, None, None] * volume).ravel()
    return Body(grid, capacity, (matrix + sparse.diags(diagonal)).tocsr(), source)


def lines(start: float, end: float, count: int, first: float) -> np.ndarray:
    """From start to end, count cells that grow evenly from the first one's length m."""
    length = abs(end - start)
    low, high, ratio = 1e-6, 100.0, 1.0
    if count * first >= length:
        return np.linspace(start, end, count + 1)
    for _ in range(200):
        ratio = (low + high) / 2
        total = first * count if abs(ratio - 1) < 1e-9 else first * (ratio**count - 1) / (ratio - 1)
        low, high = (ratio, high) if total < length else (low, ratio)
    steps = np.cumsum(first * ratio ** np.arange(count))
    return start + (end - start) * np.concatenate(([0.0], steps / steps[-1]))


def face(refine: float) -> np.ndarray:
    """Half the sensor's face, from its middle; finest at the edge."""
    return np.sort(HALF - lines(0.0, HALF, round(6 * refine), HALF / (16 * refine)))


def element(half_y: np.ndarray, half_z: np.ndarray, refine: float, brief: bool = False) -> Grid:
    """A quarter of a fingertip's element, from its face to the thermostat; temperatures above COOL. brief: finer at the
    face, for contacts that close for milliseconds."""
    pieces, k, c, at = [np.zeros(1)], [], [], 0.0
    count, first = round((6 if brief else 4) * refine), (1e-5 if brief else 3e-5) / refine
    for number, layer in enumerate(STACK.layers[::-1]):
        edges = (
            lines(0.0, layer.thickness, count, min(first, layer.thickness / count))
            if number == 0
            else np.linspace(0.0, layer.thickness, count + 1)
        )
        pieces.append(at + edges[1:])
        at += layer.thickness
        k += [layer.conductivity] * count
        c += [layer.volumetric_heat_capacity] * count
    return Grid((np.concatenate(pieces), half_y, half_z), np.array(k), np.array(c), held=WARM - COOL)


def block(
    name: str, size: tuple[float, float, float], refine: float, thick: int, first: float = 1e-4
) -> Grid:
    """A quarter of a box, touched in the middle of the faces at the first axis' ends. thick: cells to the middle, of
    which the first is `first` m thick, both at a refinement of 1."""
    half = face(refine)
    y, z = (
        np.concatenate((half, lines(HALF, side / 2, round(5 * refine), HALF / (16 * refine))[1:]))
        for side in size[1:]
    )
    near = lines(0.0, size[0] / 2, round(thick * refine), first / refine)
    x = np.concatenate((near, (size[0] - near[:-1])[::-1]))
    return _solid(name, (x, y, z))


def can(
    name: str, radius: float, half_length: float, sector: float, half_y: np.ndarray, refine: float
) -> Grid:
    """Half a cylinder's length, from a finger's middle to that angle, touched at the outside."""
    half = face(refine)
    y = np.concatenate((half_y, lines(HALF, sector * radius, round(6 * refine), HALF / (16 * refine))[1:]))
    z = np.concatenate((half, lines(HALF, half_length, round(6 * refine), HALF / (16 * refine))[1:]))
    r = radius - lines(0.0, radius, round(12 * refine), 1e-4 / refine)[::-1]
    r[0] = 0.0
    return _solid(name, (r, y, z), radius)


def _solid(name: str, edges: tuple[np.ndarray, np.ndarray, np.ndarray], radius: float = math.inf) -> Grid:
    made_of, count = material(name), len(edges[0]) - 1
    return Grid(
        edges,
        np.full(count, made_of.conductivity),
        np.full(count, made_of.volumetric_heat_capacity),
        radius,
    )


@dataclass(frozen=True, slots=True)
class Joint:
    """A fingertip's face on an end of an object's first axis: numbers of both, and half widths m in contact."""

    fingertip: int
    target: int
    last: bool
    reach: float = HALF


def by_volumes(
    tips: Sequence[Body],
    objects: Sequence[Body],
    joints: Sequence[Joint],
    through: np.ndarray,
    parts: float,
) -> np.ndarray:
    """(samples, tips) K of drop. through: (substeps, joints) W/K of whole contacts, of which a quarter is here. parts:
    steps of each substep."""
    bodies = [*tips, *objects]
    first = np.concatenate(([0], np.cumsum([len(each.capacity) for each in bodies])))
    capacity = np.concatenate([each.capacity for each in bodies])
    conduction = sparse.block_diag([each.conduction for each in bodies], format="csr")
    source = np.concatenate([each.source for each in bodies])
    parts = max(round(parts), 1)
    h = DT / SUBSTEPS / parts
    matrix = (sparse.diags(capacity) + GAMMA / 2 * h * conduction).tocsc()
    solver = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    # pairs of cells, their half cells' resistance K/W, and their shares of the contact's area
    pairs, resistance, shares, owner = [], [], [], []
    for number, joint in enumerate(joints):
        tip, target = tips[joint.fingertip], objects[joint.target]
        cells = tip.grid.shape[1:]
        width = np.diff(tip.grid.edges[1])[:, None] * np.diff(tip.grid.edges[2])[None]
        inside = np.broadcast_to((tip.grid.edges[1][1:] <= joint.reach + 1e-9)[:, None], cells)
        above = np.arange(np.prod(cells)).reshape(cells)
        end = len(target.grid.k) - 1 if joint.last else 0
        below = np.arange(np.prod(target.grid.shape)).reshape(target.grid.shape)[end, : cells[0], : cells[1]]
        below = np.pad(
            below, ((0, cells[0] - len(below)), (0, 0))
        )  # where the target is narrower than the face
        half = [
            np.diff(each.grid.edges[0])[at] / (2 * each.grid.k[at]) for each, at in ((tip, 0), (target, end))
        ]
        area = width[inside]
        start = first[len(tips) + joint.target]
        pairs.append(np.stack([above[inside] + first[joint.fingertip], below[inside] + start]))
        resistance.append(sum(half) / area)
        shares.append(area / area.sum())
        owner.append(np.full(len(area), number))
    pair, owner_of = np.concatenate(pairs, axis=1), np.concatenate(owner)
    resist, share = np.concatenate(resistance), np.concatenate(shares)
    count, total = pair.shape[1], len(capacity)
    ones, numbers = np.ones(count), np.arange(count)
    jump = sparse.csr_matrix(
        (np.r_[ones, -ones], (np.r_[numbers, numbers], np.r_[pair[0], pair[1]])), shape=(count, total)
    )
    reached = solver.solve(jump.T.toarray())
    compliance = jump @ reached
    drops = np.zeros((len(tips), total))
    for number, tip in enumerate(tips):
        drops[number, first[number] : first[number + 1]] = _drop(tip.grid)
    behind = np.array([_behind(tip.grid) * (WARM - COOL) for tip in tips])
    state = np.zeros(total)
    state[: first[len(tips)]] = WARM - COOL
    mix, weight, read = 1 / (GAMMA * (2 - GAMMA)), GAMMA / 2 * h, []

    def solved(load: np.ndarray, each: np.ndarray) -> np.ndarray:
        alone = solver.solve(load)
        active = np.flatnonzero(each)
        if not len(active):
            return alone
        matrix = weight * compliance[np.ix_(active, active)] + np.diag(1 / each[active])
        return alone - weight * reached[:, active] @ np.linalg.solve(matrix, (jump @ alone)[active])

    for number, conductances in enumerate(through, 1):
        conducts = conductances[owner_of] / 4 * share
        each = np.zeros(count)
        on = conducts > 0
        each[on] = 1 / (1 / conducts[on] + resist[on])
        for _ in range(parts):
            flow = jump.T @ (each * (jump @ state)) + conduction @ state
            middle = solved(capacity * state - weight * (flow - 2 * source), each)
            state = solved(capacity * (mix * middle + (1 - mix) * state) + weight * source, each)
        if number % SUBSTEPS == 0:
            read.append(drops @ state + behind)
    return np.array(read)


def _drop(grid: Grid) -> np.ndarray:
    """Row of the drop over the sensed layer, mean over the face."""
    row = np.zeros(grid.shape)
    width = np.diff(grid.edges[1])[:, None] * np.diff(grid.edges[2])[None]
    for plane, sign in zip(_bounds(), (1.0, -1.0), strict=True):
        at = int(np.argmin(np.abs(grid.edges[0] - plane)))
        if at == len(grid.k):
            continue  # the thermostat: _behind
        lower, upper = (grid.k / np.diff(grid.edges[0]))[at - 1 : at + 1]
        for cell, part in ((at - 1, lower), (at, upper)):
            row[cell] += sign * part / (lower + upper) * width / width.sum()
    return row.ravel()


def _behind(grid: Grid) -> float:
    """1 where the sensed layer ends at the thermostat."""
    return float(abs(_bounds()[0] - grid.edges[0][-1]) < 1e-9)


def _bounds() -> tuple[float, float]:
    """m from the face, the sensed layer's far and near side."""
    near = sum(layer.thickness for layer in STACK.layers[STACK.sensed + 1 :])
    return near + STACK.layers[STACK.sensed].thickness, near


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """A scene as the touch heard it. through (substeps, contacts) W/K and force N; drop (samples, F) K."""

    through: np.ndarray
    force: np.ndarray
    drop: np.ndarray


def heard(
    xml: str,
    objects: dict[str, str],
    fingertips: Sequence[str],
    contacts: Sequence[tuple[int, int]],
    drive: Callable[[float, mujoco.MjData], None],
    seconds: float,
    tolerance: float = 0.05,
) -> Run:
    """Runs a scene whose fingertips' pads are geoms of their names."""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    touch = thermograsp.ThermalTouch(
        model,
        fingertips={name: Fingertip(name, (0.004, 0, 0), (1, 0, 0), (0.02, 0.02)) for name in fingertips},
        objects=objects,
        dt=DT,
        air=0.0,
        ambient=COOL,
        chain="ideal",
        tolerance=tolerance,
    )
    reader, through, force, drop = touch._reader, [], [], []
    read = reader.read

    def noted(data: mujoco.MjData, weight: int = 1) -> None:
        before = reader.touches[0].copy()
        read(data, weight)
        added = reader.touches[0] - before
        through.append([added[f, t, CONDUCTANCE] for f, t in contacts])
        force.append([added[f, t, FORCE] for f, t in contacts])

    reader.read = noted
    touch._listen = lambda: None  # no step is taken by one compiled call, past the reader
    for _ in range(round(seconds / DT)):
        for _ in range(SUBSTEPS):
            drive(data.time, data)
            mujoco.mj_step(model, data)
            touch.update(data)
        drop.append(touch.reading.temperature_drop)
    return Run(np.array(through), np.array(force), np.array(drop))


def _world(bodies: str, fingers: Sequence[tuple[str, str, str]]) -> str:
    """Fingers (name, place, angle) that slide along their own x, by a motor, and y."""
    each = "".join(
        f'<body pos="{place}" euler="0 0 {turn}"><joint name="{name}" type="slide" axis="1 0 0" damping="20" '
        f'armature=".05"/><joint name="{name}_y" type="slide" axis="0 1 0" damping="20" armature=".05"/>'
        f'<geom name="{name}" type="box" size=".004 .01 .01" mass=".05"/></body>'
        for name, place, turn in fingers
    )
    drives = "".join(
        f'<motor name="{name}" joint="{name}"/><position name="{name}_y" joint="{name}_y" kp="5000" kv="100"/>'
        for name, _, _ in fingers
    )
    return (
        '<mujoco><compiler angle="degree"/><option timestep=".002" gravity="0 0 0" integrator="implicitfast"/>'
        f"<worldbody>{bodies}{each}</worldbody><actuator>{drives}</actuator></mujoco>"
    )


RADIUS, LENGTH = 0.03, 0.10
"""m, of the can."""
_CAN = f'<body name="can"><geom type="cylinder" size="{RADIUS} {LENGTH / 2}"/></body>'


def _push(**forces: Callable[[float], float]) -> Callable[[float, mujoco.MjData], None]:
    def drive(now: float, data: mujoco.MjData) -> None:
        for name, force in forces.items():
            data.actuator(name).ctrl[0] = force(now)

    return drive


def three(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """Three fingers round a can, 8 N each."""
    places = [
        (math.cos(a), math.sin(a), math.degrees(a) + 180) for a in (0, 2 * math.pi / 3, 4 * math.pi / 3)
    ]
    fingers = [(f"f{n}", f"{0.036 * x} {0.036 * y} 0", f"{turn}") for n, (x, y, turn) in enumerate(places)]
    run = heard(
        _world(_CAN, fingers),
        {"can": made_of},
        [name for name, _, _ in fingers],
        [(f, 0) for f in range(3)],
        _push(**{name: lambda now: 8.0 for name, _, _ in fingers}),
        3.0,
        tolerance,
    )
    return run, _on_can(run, made_of, math.pi / 3, refine)


def one_on_can(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """One finger on a can."""
    run = heard(
        _world(_CAN, [("f0", "-0.036 0 0", "0")]),
        {"can": made_of},
        ["f0"],
        [(0, 0)],
        _push(f0=lambda now: 8.0),
        3.0,
        tolerance,
    )
    return run, _on_can(run, made_of, math.pi, refine)


def _on_can(run: Run, made_of: str, sector: float, refine: float) -> np.ndarray:
    """(samples, 1). Heat passes the strip of even_patch, which is here always as wide as in the end."""
    length, through = 2 * HALF, run.through.mean(axis=1, keepdims=True)
    law = bare_footprint(Pad(width=0.020, face=length), Surface.of(material(made_of)), RADIUS, LENGTH)
    area = even_patch(law, material(made_of), run.force[-1].mean())
    reach = area / (2 * length)
    half = np.concatenate(
        (np.sort(reach - lines(0.0, reach, round(6 * refine), reach / (30 * refine))),
         lines(reach, HALF, round(8 * refine), reach / (30 * refine))[1:])
    )  # fmt: skip
    tip = body(element(half, face(refine), refine))
    cup = body(can(made_of, RADIUS, LENGTH / 2, sector, half, refine))
    return by_volumes([tip], [cup], [Joint(0, 0, True, reach)], through, refine)


def on_blocks(
    refine: float,
    objects: dict[str, tuple[str, str, tuple[float, float, float]]],
    fingers: Sequence[tuple[str, str, str]],
    joints: Sequence[Joint],
    drive: Callable[[float, mujoco.MjData], None],
    tolerance: float,
    seconds: float = 3.0,
    brief: bool = False,
) -> tuple[Run, np.ndarray]:
    """objects: name -> material, place and size m of a block, first axis along x. brief: contacts close for
    milliseconds, in which heat gets no farther than some hundredths of a millimetre."""
    blocks = "".join(
        f'<body name="{name}" pos="{place}"><geom type="box" size="{" ".join(str(side / 2) for side in size)}"/></body>'
        for name, (_, place, size) in objects.items()
    )
    made_of = {name: one for name, (one, _, _) in objects.items()}
    contacts = [(joint.fingertip, joint.target) for joint in joints]
    names = [name for name, _, _ in fingers]
    run = heard(_world(blocks, fingers), made_of, names, contacts, drive, seconds, tolerance)
    tip = body(element(face(refine), face(refine), refine, brief))
    cells = (12, 1.5e-5) if brief else (7, 1e-4)
    bodies = [body(block(one, size, refine, *cells)) for one, _, size in objects.values()]
    return run, by_volumes([tip] * len(fingers), bodies, joints, run.through, refine)


BLOCK, PLATE = (0.03, 0.05, 0.05), (0.003, 0.06, 0.06)
"""m."""


def regrasp(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """A finger goes from a block of that material to a wooden one, and back."""
    objects = {"first": (made_of, "0.021 0 0", BLOCK), "second": ("wood", "0.021 0.06 0", BLOCK)}

    def drive(now: float, data: mujoco.MjData) -> None:
        away = 0.8 <= now % 1.2
        data.actuator("f0").ctrl[0] = -4.0 if away else 8.0
        data.actuator("f0_y").ctrl[0] = 0.06 * (0.95 <= now < 2.15)

    joints = [Joint(0, 0, False), Joint(0, 1, False)]
    return on_blocks(refine, objects, [("f0", "0 0 0", "0")], joints, drive, tolerance, 3.6)


def shared(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """Two fingers on the sides of a plate, the second a second later."""
    fingers = [("f0", "-0.006 0 0", "0"), ("f1", "0.006 0 0", "180")]
    drive = _push(f0=lambda now: 8.0, f1=lambda now: 8.0 if now > 1.0 else -0.5)
    joints = [Joint(0, 0, False), Joint(1, 0, True)]
    return on_blocks(refine, {"plate": (made_of, "0 0 0", PLATE)}, fingers, joints, drive, tolerance)


def _come_and_go(
    period: float, closed: float, refine: float, made_of: str, tolerance: float
) -> tuple[Run, np.ndarray]:
    """A finger that is driven to for `closed` s of every period s, and away."""
    drive = _push(f0=lambda now: 20.0 if now % period < closed else -12.0)
    objects = {"block": (made_of, "0.0195 0 0", BLOCK)}
    fingers = [("f0", "0 0 0", "0")]
    return on_blocks(refine, objects, fingers, [Joint(0, 0, False)], drive, tolerance, brief=True)


def chatter(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """A finger that comes and goes faster than the samples pass."""
    return _come_and_go(0.014, 0.008, refine, made_of, tolerance)


def tap(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """A finger that comes and goes in longer than a sample."""
    return _come_and_go(0.026, 0.014, refine, made_of, tolerance)


SHEET = (0.04, 0.004, 0.04)
"""m, of a plate, with its thickness along y."""


def edge(refine: float, made_of: str, tolerance: float, mesh: bool = False) -> tuple[Run, np.ndarray]:
    """A finger on the edge of a plate, which is thinner than the sensor's face is wide."""
    corners = np.array(np.meshgrid(*([-side / 2, side / 2] for side in SHEET))).reshape(3, -1).T
    geom = (
        'type="mesh" mesh="plate"'
        if mesh
        else f'size="{" ".join(str(side / 2) for side in SHEET)}" type="box"'
    )
    plate = f'<body name="plate" pos="{0.005 + SHEET[0] / 2} 0 0"><geom {geom}/></body>'
    asset = f'<asset><mesh name="plate" vertex="{" ".join(map(str, corners.ravel()))}"/></asset><worldbody>'
    world = _world(plate, [("f0", "0 0 0", "0")]).replace("<worldbody>", asset)
    run = heard(world, {"plate": made_of}, ["f0"], [(0, 0)], _push(f0=lambda now: 8.0), 3.0, tolerance)
    half, first = SHEET[1] / 2, SHEET[1] / (40 * refine)
    there = np.sort(half - lines(0.0, half, round(6 * refine), first))
    beside = lines(half, HALF, round(8 * refine), first)[1:]
    up = np.concatenate(
        (face(refine), lines(HALF, SHEET[2] / 2, round(5 * refine), HALF / (16 * refine))[1:])
    )
    tip = body(element(np.concatenate((there, beside)), face(refine), refine))
    sheet = body(_solid(made_of, (lines(0.0, SHEET[0], round(14 * refine), 1e-4 / refine), there, up)))
    return run, by_volumes([tip], [sheet], [Joint(0, 0, False, half)], run.through, refine)


def rim(refine: float, made_of: str, tolerance: float) -> tuple[Run, np.ndarray]:
    """The same where the plate is a mesh."""
    return edge(refine, made_of, tolerance, mesh=True)


SCENES = {
    "three": three,
    "curved": one_on_can,
    "regrasp": regrasp,
    "shared": shared,
    "chatter": chatter,
    "tap": tap,
    "edge": edge,
    "rim": rim,
}
MATERIALS = ("aluminium", "glass", "wood")


@dataclass(frozen=True, slots=True)
class Judged:
    """error: K, the touch's largest difference from the volumes with their grid's error taken off. grid_error: K, the
    largest that was taken off the finer grid. largest: K, the drop's. changes: samples in which a contact came or
    went."""

    error: float
    grid_error: float
    largest: float
    changes: int


def judged(scene: str, made_of: str, tolerance: float = 0.05, refine: float = 1.4) -> Judged:
    """A scene beside volumes of `refine` and of 1, whose error falls with the square of the cells."""
    (_, coarse), (run, fine) = (SCENES[scene](n, made_of, tolerance) for n in (1.0, refine))
    expected = fine + (fine - coarse) / (refine**2 - 1)
    closed = run.through.reshape(len(fine), SUBSTEPS, -1).max(axis=1) > 0
    return Judged(
        float(np.abs(run.drop[:, : fine.shape[1]] - expected).max()),
        float(np.abs(fine - expected).max()),
        float(np.abs(expected).max()),
        int(np.any(closed[1:] != closed[:-1], axis=1).sum()),
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="ThermalTouch against finite volumes in three dimensions.")
    parser.add_argument("scene", nargs="?", default="", help="part of a scene's name")
    parser.add_argument("--material", default="", help="part of a material's name")
    parser.add_argument("--tolerance", type=float, default=0.05, help="K, of the touch (default 0.05)")
    parser.add_argument("--refine", type=float, default=1.4, help="of the finer grid (default 1.4)")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    options = parser.parse_args(arguments)
    for scene in (name for name in SCENES if options.scene in name):
        for made_of in (name for name in MATERIALS if options.material in name):
            begun = time.perf_counter()
            each = asdict(judged(scene, made_of, options.tolerance, options.refine))
            record = {"scene": scene, "material": made_of, **{key: round(x, 4) for key, x in each.items()}}
            record["seconds"] = round(time.perf_counter() - begun, 1)
            print(json.dumps(record) if options.json else record, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
