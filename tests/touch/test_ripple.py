"""Contacts that come and go within a sample, beside slabs of cells and samples as short as what comes and goes."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from scipy.linalg import expm

from thermograsp.thermal import IDEAL, Layer, Material, material, sensor
from thermograsp.touch import Fingertip, ThermalTouch, install, prepare
from thermograsp.touch.contacts import (
    AREA,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    LENGTH,
    NORMAL,
    PLACE,
    PULSES,
)
from thermograsp.touch.heat import JoinedHeat, array_ripple
from thermograsp.touch.heat.narrow.ripple import ripple
from thermograsp.touch.scene import BodyShape, PadPlace

from .engine_scene import NEEDS_COMPILER, NEEDS_RECORDS, NEEDS_SPECS, ROUND_OFF, per_kelvin, sent, voltages

SUBSTEPS, DT = 12, 0.012
SIZE, STACK = np.full(3, 0.05), sensor("seed")
FACE = STACK.layers[-1]
PATTERNS = {
    "one pulse": ("000111111000", 1.0),
    "a short pulse": ("000001100000", 1.0),
    "one pause": ("111100011111", 1.0),
    "an end": ("111111110000", 0.5),
    "two pulses": ("011100011100", 2.0),
    "three pulses, one from the start": ("110011001100", 2.5),
    "six pulses, one to the end": ("010101010101", 5.5),
}


def test_it_is_the_sum_of_the_flows_harmonics() -> None:
    n = np.arange(1, 400001)
    for share in (0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98):
        harmonics = (np.sin(np.pi * n * share) / (np.pi * n * share)) ** 2 / np.sqrt(n)
        assert ripple(share, 1.0) == pytest.approx(harmonics.sum(), rel=0.01)
        assert ripple(share, 4.0) == pytest.approx(ripple(share, 1.0) / 2)


def test_contacts_that_stay_closed_or_open_resist_no_more() -> None:
    found = array_ripple(np.array([0.0, 1.0, 0.5]), np.array([0.0, 0.0, 2.0]))
    assert found == pytest.approx([0.0, 0.0, ripple(0.5, 2.0)])


def slab_flow(body: Material | Layer, period: float, share: float, conductance: float) -> float:
    """W/m2 K between two slabs of 4 mm, of a sensor's face and of a body, which conduct so much, W/(m2 K), for a share
    of each period s, in the steady state. Cells are finer at the faces."""
    grid = 4e-3 * np.linspace(0, 1, 61) ** 2
    cells, n = np.diff(grid), 60
    capacity = np.concatenate([each.volumetric_heat_capacity * cells for each in (FACE, body)])
    matrices = []
    for joined in (conductance, 0.0):
        flow = np.zeros((2 * n, 2 * n))
        for first, each in ((0, FACE), (n, body)):
            for i in range(n - 1):
                between = each.conductivity / ((cells[i] + cells[i + 1]) / 2)
                at = first + i
                flow[at, [at, at + 1]] += (-between, between)
                flow[at + 1, [at, at + 1]] += (between, -between)
            flow[first + n - 1, first + n - 1] -= each.conductivity / (cells[-1] / 2)
        if joined:
            halves = cells[0] / 2 * (1 / FACE.conductivity + 1 / body.conductivity)
            through = 1 / (1 / joined + halves)
            flow[0, [0, n]] += (-through, through)
            flow[n, [0, n]] += (through, -through)
        matrices.append(flow / capacity[:, None])
    source = np.zeros(2 * n)
    source[n - 1] = FACE.conductivity / (cells[-1] / 2) / capacity[n - 1]  # the sensor's side is held at 1 K
    # of an affine step, the states, the integral of those at the first slab's end, and 1
    steps = []
    for flow, seconds in zip(matrices, (share * period, (1 - share) * period), strict=True):
        whole = np.zeros((2 * n + 2, 2 * n + 2))
        whole[: 2 * n, : 2 * n], whole[: 2 * n, -1] = flow, source
        whole[2 * n, n - 1] = 1.0
        steps.append(expm(seconds * whole))
    cycle = steps[1] @ steps[0]
    steady = np.linalg.solve(np.eye(2 * n) - cycle[: 2 * n, : 2 * n], cycle[: 2 * n, -1])
    mean = (cycle @ np.concatenate((steady, [0.0, 1.0])))[2 * n] / period
    return FACE.conductivity / (cells[-1] / 2) * (1 - mean)


@pytest.mark.parametrize("made_of", ["aluminium", "steel", "glass"])
@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("period", [0.002, 0.01])
def test_its_resistance_is_that_of_slabs(made_of: str, share: float, period: float) -> None:
    body, conductance = material(made_of), 5e3
    steady = 4e-3 / FACE.conductivity + 4e-3 / body.conductivity + 1 / (share * conductance)
    found = 1 / slab_flow(body, period, share, conductance) - steady
    faces = 1 / FACE.effusivity + 1 / body.effusivity
    assert np.sqrt(period / np.pi) * faces * ripple(share, 1.0) == pytest.approx(found, rel=0.07)


def joined(made_of: str, dt: float) -> JoinedHeat:
    """One bare sensor on a block."""
    pad = PadPlace("tip", 0, (), np.zeros(3), np.eye(3), np.full(2, 0.02), STACK, 36.0)
    shape = BodyShape("box", 0, (), material(made_of), 24.0, SIZE, np.zeros(3), np.eye(3), SIZE, 0.01)
    return JoinedHeat((pad,), (), (shape,), worlds=1, dt=dt, tolerance=0.005, film=0.0, ambient=24.0)


def drops(made_of: str, pattern: str, pulses: float, *, known: bool, short: bool = False) -> np.ndarray:
    """K after each of 150 samples, or of the same time in samples as short as a substep. known: whether the heat knows
    that the contact comes and goes."""
    closed = np.array([int(each) for each in pattern])
    heat, area = joined(made_of, DT / SUBSTEPS if short else DT), STACK.face_area
    touches, found = np.zeros((1, 1, 2, COLUMNS)), []
    row = touches[0, 0, 0]
    for _ in range(150):
        for now in closed if short else [closed.mean()]:
            row[:] = 0.0
            if now > 0:
                row[[CONDUCTANCE, AREA, LENGTH]] = now * 8e3 * area, now * area, now * area * STACK.width
                row[[CLOSED, PULSES]] = now, pulses
                if not known:
                    row[[AREA, LENGTH, CLOSED]] = area, area * STACK.width, 1.0
            row[NORMAL], row[PLACE] = 1.0, -SIZE[0] / 2
            heat.advance(touches, 1)
        found.append(heat.drop[0, 0])
    return np.array(found)


@pytest.mark.parametrize("made_of", ["aluminium", "steel", "glass"])
@pytest.mark.parametrize("pattern", ["one pulse", "a short pulse", "one pause"])
def test_it_feels_as_in_shorter_samples(pattern: str, made_of: str) -> None:
    """Of what comes and goes slowly enough for networks to follow it in short samples."""
    each = PATTERNS[pattern]
    exact = drops(made_of, *each, known=True, short=True)
    errors = [np.abs(drops(made_of, *each, known=known) - exact).max() for known in (True, False)]
    assert errors[0] < 0.4 * errors[1] and errors[0] < 0.035


FINGER = """
<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody>
  <body name="block"><geom type="box" size=".02 .02 .02"/></body>
  <body name="tip" pos="0 0 .0249"><joint type="slide" axis="0 0 1"/>
    <geom name="tip" type="box" size=".01 .01 .005" mass=".02"/></body>
</worldbody></mujoco>"""


def drive(data: mujoco.MjData, closed: str) -> None:
    data.qpos[0], data.qvel[0] = 0.0 if closed == "1" else 0.003, 0.0


@NEEDS_RECORDS
@pytest.mark.parametrize("pattern", PATTERNS)
def test_pulses_are_counted_alike(pattern: str) -> None:
    """From MjData, from records whole and step by step, and by arrays."""
    tip = Fingertip("tip", (0, 0, -0.005), (0, 0, -1), (0.02, 0.02))
    scene = {"fingertips": {"tip": tip}, "objects": {"block": "steel"}}
    model = prepare(mujoco.MjSpec.from_string(FINGER), **scene)
    followed = ThermalTouch(model, **scene, dt=DT, chain=IDEAL)
    whole, told = (ThermalTouch(model, **scene, dt=DT, chain=IDEAL, worlds=1) for _ in range(2))
    fixed = ThermalTouch(model, **scene, dt=DT, chain=IDEAL).fixed_touch(np.zeros(0))
    state, data = fixed.start(), mujoco.MjData(model)
    steps, pulses = PATTERNS[pattern]
    record = np.zeros((1, SUBSTEPS, model.nsensordata))
    for _ in range(3):
        for n, closed in enumerate(steps):
            drive(data, closed)
            mujoco.mj_step(model, data)
            record[0, n] = data.sensordata
            followed.update(data)
            told.update(record[:, n : n + 1])
            if n == SUBSTEPS - 2:  # before the sums start anew
                both = [touch._reader.touches[0, 0, 0, CLOSED : PULSES + 1] for touch in (followed, told)]
                assert both[0].tolist() == both[1].tolist()
        whole.update(record)
        state, reading = fixed.advance(state, fixed.contacts(record))
        drops = [touch._heat.drop[0, 0] for touch in (followed, told, whole)]
        assert drops == pytest.approx(3 * [reading.temperature_drop[0, 0]], rel=1e-6)
    step = fixed.reads.of_step(fixed.contacts(record), np.zeros((1, 1), int), fixed.of_object)
    assert (step.closed.item() * SUBSTEPS, step.pulses.item()) == (steps.count("1"), pulses)


@NEEDS_COMPILER
@NEEDS_SPECS
def test_the_plugin_counts_them_too() -> None:
    tip = Fingertip("tip", (0, 0, -0.005), (0, 0, -1), (0.02, 0.02))
    scene = {"fingertips": {"tip": tip}, "objects": {"block": "steel"}, "dt": DT}
    model = install(mujoco.MjSpec.from_string(FINGER), **scene)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **scene, chain=IDEAL)
    for steps, _ in PATTERNS.values():
        for closed in steps:
            drive(data, closed)
            mujoco.mj_step(model, data)
            touch.update(data)
        difference = voltages(model, data) - sent(touch)
        assert np.abs(difference / per_kelvin(touch)).max() < ROUND_OFF
