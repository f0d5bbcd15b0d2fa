"""The judge of networks from heat kernels: against a line, the recorded press, its mirror image; and what it says."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from thermograsp.thermal import material, sensor
from thermograsp.thermal.batch import FIXED_LEVEL
from thermograsp.thermal.kernels import Detail

ROOT = Path(__file__).parents[2]
SEED = sensor("seed")
W = SEED.width
TIMES = np.array([0.2, 2.0, 10.0])


@pytest.fixture(scope="module")
def judge() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "networks"))
    yield importlib.import_module("laplace_judge")
    sys.path.remove(str(ROOT / "studies" / "networks"))
    del sys.modules["laplace_judge"]


@pytest.mark.parametrize("film", [0.0, 20.0])
def test_a_contact_over_whole_faces_is_a_line(judge: ModuleType, film: float) -> None:
    """A box as wide as the element; its sides are adiabatic, as a line has them."""
    made, depth, h = material("wood"), 0.003, 3e3
    touch = judge.Touch((0.0, 0.0), (W, W), (0.0, 0.0), h)
    s = 0.7 + 0.4j
    first = judge.Contour(judge.Scene(made, (W, W, depth), film, (touch,), SEED), judge.COARSE)
    if film > 0:
        for a in range(2):
            first.box[a] = judge.axis(W, 0.0, [judge.edges(W, judge.COARSE)], judge.COARSE)
        size = 2, len(first.box[0].squared), len(first.box[1].squared)
        first.room = np.empty(size), np.empty(size)
    g = np.sqrt(s * made.volumetric_heat_capacity / made.conductivity)
    k, t = made.conductivity, np.tanh(g * depth)
    line = 1 / (k * g * t) if film == 0 else (1 / film + t / (k * g)) / (1 + k * g * t / film)
    element = 0j
    for layer in SEED.layers:
        g = np.sqrt(s * layer.volumetric_heat_capacity / layer.conductivity)
        step = np.tanh(g * layer.thickness) / (layer.conductivity * g)
        element = (element + step) / (1 + element * layer.conductivity * g * np.tanh(g * layer.thickness))
    expected = judge._drop_of_flux(SEED, s) / s / (line + element + 1 / h)
    assert first.drops(s)[0] == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("name", ["glass/10000/T", "aluminium/10000/T"])
def test_it_is_the_recorded_press(judge: ModuleType, name: str) -> None:
    curve = json.loads((ROOT / "tests" / "data" / "press_3d.json").read_text())["cases"][name]
    touch = judge.Touch(((0.04 - W) / 2,) * 2, (W, W), (0.0, 0.0), 1e4)
    scene = judge.Scene(material(name.split("/")[0]), (0.04, 0.04, 0.01), 0.0, (touch,), SEED)
    times = np.array(curve["t"])[::2]
    assert np.abs(12 * judge.judged(scene, times)[0] - np.array(curve["Td"])[::2]).max() < 1e-3


def test_it_does_not_know_left_from_right_nor_low_from_high(judge: ModuleType) -> None:
    touches = (
        judge.Touch((0.001, 0.0), (0.006, 0.009), (0.0, 0.0), 2e3),
        judge.Touch((0.007, 0.004), (0.008, 0.005), (0.001, 0.0), 4e4, "low"),
    )
    scene = judge.Scene(material("ceramic"), (0.02, 0.012, 0.003), 15.0, touches, SEED)
    turned = tuple(
        replace(
            touch,
            low=tuple(scene.size[a] - touch.low[a] - touch.size[a] for a in range(2)),
            on_element=tuple(W - touch.on_element[a] - touch.size[a] for a in range(2)),
            face="low" if touch.face == "high" else "high",
        )
        for touch in touches
    )
    one = judge.judged(scene, TIMES, judge.COARSE)
    other = judge.judged(replace(scene, touches=turned), TIMES, judge.COARSE)
    np.testing.assert_allclose(one, other, rtol=1e-6)


def test_its_own_resolution_hardly_matters(judge: ModuleType) -> None:
    touch = judge.Touch((0.0, 0.0), (0.0055, W), (W - 0.0055, 0.0), 1e4)
    scene = judge.Scene(material("glass"), (0.04, 0.04, 0.002), 10.0, (touch,), SEED)
    between = judge.Accuracy(6, 0.45, 4.5e-5, 2.0, 9)
    assert np.abs(judge.judged(scene, TIMES) - judge.judged(scene, TIMES, between)).max() < 2e-4


def test_the_environments_networks_know_where_a_part_of_the_face_lies(judge: ModuleType) -> None:
    """At the edge of a cube, and on a sheet whose other fingertip ends elsewhere: .05 K of 12 K."""
    glass = judge.known()["61 % covered, glass, h 1e+04"]
    touches = (
        judge.Touch((0.03, 0.002), (0.0085, 0.0062), (0.0005, 0.0), 2.3e3),
        judge.Touch((0.033, 0.0), (0.0086, W), (0.0, 0.0), 2.7e4, "low"),
    )
    sheet = judge.Scene(material("water_gel"), (0.098, 0.014, 1.2e-4), 0.0, touches, SEED)
    for scene in (glass, sheet):
        difference = judge.networks(scene, FIXED_LEVEL) - judge.judged(scene, accuracy=judge.COARSE)
        assert 12 * np.abs(difference).max() < 0.05


@pytest.mark.parametrize("detail", [Detail(8, 3), Detail(10, 4), Detail(12, 6)])
def test_networks_of_one_touch_keep_a_small_block_in_air(judge: ModuleType, detail: Detail) -> None:
    touches = (
        judge.Touch((0.0, 0.0014), (0.00756, 0.0071), (0.0, 0.0), 2.6e3),
        judge.Touch((0.0, 0.0), (0.00756, 0.0086), (0.0, 0.0), 1.9e3, "low"),
    )
    scene = judge.Scene(material("aluminium"), (0.00756, 0.0086, 0.003), 11.0, touches, SEED)
    difference = judge.networks(scene, detail) - judge.judged(scene, accuracy=judge.COARSE)
    assert 12 * np.abs(difference).max() < 0.01
