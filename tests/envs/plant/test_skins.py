"""Fingertips of the environments wear a skin where something is named that a bare, rigid face does not lie flat on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from thermograsp.envs import STAKES, GraspBatch, GraspTask, ObjectSpec, SimulationConfig
from thermograsp.envs.bodies import library_object
from thermograsp.envs.plant.pair import pair_config
from thermograsp.errors import InvalidValueError, UnknownKeywordError, UnknownNameError
from thermograsp.thermal import LAPPED_ALUMINA, SKINS, Skin, Surface, material, sensor
from thermograsp.thermal.contact import (
    Pad,
    conduction,
    contact_conductance,
    face_joint,
    footprint,
    rigid_sphere,
    round_footprint,
)

SILICONE = SKINS["filled_silicone"]
ENDLESS = GraspTask(seconds=100.0)
BALL = ObjectSpec(shape="sphere")


@pytest.mark.parametrize(
    ("words", "worn"),
    [
        ({}, None),
        ({"material": "glass", "objects": ObjectSpec(size=(0.03, 0.04, 0.04))}, None),
        ({"objects": STAKES["objects"], "material": STAKES["material"]}, None),
        ({"objects": "butter"}, SILICONE),
        ({"objects": ["dice", "toy_block"]}, SILICONE),
        ({"objects": library_object("butter").spec()}, SILICONE),
        ({"objects": BALL}, SILICONE),
        ({"scene": [ObjectSpec(), BALL]}, SILICONE),
        ({"objects": BALL, "mode": "O"}, None),
        ({"objects": BALL, "sensor": "heated_thermistor"}, None),
        ({"objects": BALL, "skin": None}, None),
        ({"material": "glass", "skin": "filled_silicone"}, SILICONE),
    ],
    ids=str,
)
def test_who_wears_one(words: dict[str, Any], worn: Skin | None) -> None:
    config = SimulationConfig(**words)
    assert config.worn == worn
    bare = SimulationConfig(**{**words, "skin": None}).stack
    assert config.stack == (bare if worn is None else worn.over(bare))


def test_a_pair_wears_what_its_shape_asks_for() -> None:
    assert pair_config(objects=BALL).simulation.worn == SILICONE
    assert pair_config().simulation.worn is None


def held(rows: int = 1, steps: int = 40, **words: Any) -> tuple[GraspBatch, list[np.ndarray]]:
    """Closed for some steps; what the sensors send in each."""
    words = {"task": ENDLESS, "placement": (0.0, 0.0), "tolerance": 0.2, **words}
    batch = GraspBatch(rows, **words)
    batch.reset(list(range(rows)), [np.random.default_rng(row) for row in range(rows)])
    action, volts = np.tile([-1.0, -0.5, 0.0], (rows, 1)), []
    for _ in range(steps):
        volts.append(batch.step(action).reading.voltage)
    return batch, volts


def test_a_ball_meets_its_springs_its_surface_and_its_layer() -> None:
    batch, _ = held(objects=BALL, material="steel", signal="ideal")
    plant: Any = batch.plant
    assert batch.reading is not None
    truth, body = batch.reading.truth, plant.bodies[0]
    assert body.skin == SILICONE and body.stack == SILICONE.over(sensor("seed"))
    force = batch.reading.force[0, 0, 0]
    expected = np.pi * np.sqrt(4 * force * 0.02 / (np.pi * SILICONE.stiffness))
    assert truth["contact_area"][0, 0] == pytest.approx(expected, rel=0.01)
    face, load = footprint(body.law, force, np.zeros(3))
    steel = Surface.of(material("steel"))
    law = round_footprint(Pad(), SILICONE, steel, 0.02)
    through = conduction(law, force, np.zeros(3))[1]
    assert truth["conductance"][0, 0] * expected == pytest.approx(through, rel=0.02)
    h = float(contact_conductance(face_joint(SILICONE, steel), load / face))
    straight = face / (1 / h + SILICONE.resistance)  # what touches, with the skin beneath it alone
    assert straight < through < 2 * straight
    imbalance, exchanged = truth["heat_imbalance"][0], truth["heat_exchanged"][0]
    assert exchanged > 0.1 and abs(imbalance) < 1e-9 * exchanged


def test_a_ball_on_a_bare_face_touches_as_hertz_says_and_its_gas_conducts() -> None:
    """A disc of 0.1 mm radius; the network's patch is as wide as the gas conducts."""
    batch, _ = held(objects=BALL, material="steel", signal="ideal", skin=None, taxels=(20, 20))
    plant: Any = batch.plant
    assert batch.reading is not None and batch.reading.pressure is not None
    truth, body, force = batch.reading.truth, plant.bodies[0], batch.reading.force[0, 0, 0]
    expected = rigid_sphere(LAPPED_ALUMINA, Surface.of(material("steel")), force, 0.02, 0.009)
    assert truth["contact_area"][0, 0] == pytest.approx(np.pi * expected.half_width**2, rel=0.01)
    through = truth["contact_area"][0, 0] * truth["conductance"][0, 0]
    assert through == pytest.approx(expected.conductance, rel=0.03)
    assert 100 * truth["contact_area"][0, 0] < body.geometry.area < 0.2 * body.stack.face_area
    imbalance, exchanged = truth["heat_imbalance"][0], truth["heat_exchanged"][0]
    assert exchanged > 0.01 and abs(imbalance) < 1e-9 * exchanged
    assert batch.reading.pressure[0, 0].mean() * 0.02**2 == pytest.approx(force, rel=0.02)
    assert (batch.reading.pressure[0, 0] > 0).sum() <= 4


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_ball_is_felt_less_than_a_rod_and_that_less_than_a_box(skin: str | None) -> None:
    drops = []
    for spec in (BALL, ObjectSpec(shape="cylinder"), ObjectSpec()):
        batch, _ = held(objects=spec, material="steel", signal="ideal", skin=skin)
        assert batch.reading is not None
        drops.append(batch.reading.voltage[0, 0].mean())
    assert 0 < 1.9 * drops[0] < drops[1] and drops[1] < 0.95 * drops[2]


def test_rows_feel_the_same_bits_alone_and_among_others() -> None:
    words: dict[str, Any] = {"objects": "butter", "material": ["glass", "copper"]}
    _, many = held(3, 25, **words)
    for row in (0, 2):
        batch = GraspBatch(1, task=ENDLESS, placement=(0.0, 0.0), tolerance=0.2, **words)
        batch.reset([0], [np.random.default_rng(row)])
        for expected in many:
            volts = batch.step(np.array([[-1.0, -0.5, 0.0]])).reading.voltage
            assert np.array_equal(volts[0], expected[row])


@pytest.mark.slow
def test_maps_press_with_its_springs() -> None:
    """The taxels' force is the load cell's; under a bare face a spot bears it, under a skin some mm2."""
    areas = []
    for skin in (None, "auto"):
        batch, _ = held(
            1, 30, objects=BALL, material="steel", skin=skin, taxels=(20, 20), face_temperature=(3, 3)
        )
        reading = batch.reading
        assert reading is not None and reading.pressure is not None and reading.face_temperature is not None
        pressure = reading.pressure[0, 0]
        assert pressure.mean() * 0.02**2 == pytest.approx(reading.force[0, 0, 0], rel=0.02)
        assert np.isfinite(reading.face_temperature).all()
        areas.append((pressure > 0).sum())
    assert areas[0] <= 4 < 8 <= areas[1] <= 16


def test_refuses_what_cannot_be_worn() -> None:
    refused: list[tuple[dict[str, Any], type[Exception]]] = [
        ({"skin": "filled_silicon"}, UnknownNameError),
        ({"skin": 2e-4}, InvalidValueError),
        ({"skin": ""}, UnknownNameError),
        ({"skin": "filled_silicone", "mode": "O"}, InvalidValueError),
        ({"skins": None}, UnknownKeywordError),
    ]
    for wrong, error in refused:
        with pytest.raises(error):
            GraspBatch(1, task=ENDLESS, **wrong)


@pytest.mark.parametrize("name", ["aluminium", "glass"])
@pytest.mark.parametrize("shape", ["sphere", pytest.param("cylinder", marks=pytest.mark.slow)])
def test_a_bare_face_is_rigid_on_a_mesh_too(name: str, shape: str, tmp_path: Path) -> None:
    """A ball's or a can's mesh is felt as the shape is; as soft a face as the pad would feel three times as much."""
    solid = (
        trimesh.creation.icosphere(4, 0.02)
        if shape == "sphere"
        else trimesh.creation.cylinder(0.02, 0.04, sections=48)
    )
    solid.export(tmp_path / "shape.stl")
    meshed = ObjectSpec(shape="mesh", mesh=str(tmp_path / "shape.stl"), size=(0.04, 0.04, 0.04))
    drops = []
    for spec in (ObjectSpec(shape=shape), meshed):  # pyright: ignore
        batch, _ = held(objects=spec, material=name, signal="ideal", skin=None)
        assert batch.reading is not None
        drops.append(batch.reading.voltage[0, 0].mean())
    assert drops[1] == pytest.approx(drops[0], rel=0.15)
