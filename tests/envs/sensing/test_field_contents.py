"""Contents of vessels in fields of environments: beside the networks of one patch, where contacts are alike."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from thermograsp.envs import (
    GraspBatch,
    GraspBody,
    ObjectSpec,
    Reservoir,
    SimulationConfig,
    action_of,
    ice,
    water,
)
from thermograsp.envs.sensing import FieldHeat, GraspHeat
from thermograsp.thermal import material

SETTINGS: dict[str, Any] = {
    "tolerance": 0.06,
    "dt": 0.01,
    "samples": 2,
    "sensor_temperature": 36.0,
    "air": 5.0,
}
SIDE = 0.04  # m
ROOM = 24.0  # °C
PLACE = np.array([[[-SIDE / 2, 0, 0], [SIDE / 2, 0, 0]]])


def vessel(folder: Path, wall: float, inside: Reservoir | None) -> ObjectSpec:
    """A closed box with walls that thick, m, on which a face touches all over."""
    outer, inner = trimesh.creation.box((SIDE,) * 3), trimesh.creation.box((SIDE - 2 * wall,) * 3)
    inner.invert()
    file = folder / f"{wall * 1e6:.0f}.stl"
    trimesh.util.concatenate([outer, inner]).export(file)
    return ObjectSpec(name="vessel", shape="mesh", mesh=str(file), reservoir=inside)


def body_of(name: str, spec: ObjectSpec, celsius: float = ROOM, **words: Any) -> GraspBody:
    config = SimulationConfig(
        **{
            "material": name,
            "objects": spec,
            "skin": None,
            "fingertips": 1,
            "ambient_temperature": ROOM,
            **words,
        },
        object_temperature=celsius,
    )
    plain = dict.fromkeys(("size_factor", "mass_factor", "friction_factor", "roughness_factor"), 1.0)
    return config.body(config.stack, material(name), spec, {**plain, "object_temperature_shift": 0.0})


def steps(heat: Any, count: int, force: float = 10.0) -> list[Any]:
    """(drop K, info) of each."""
    found, rows = [], len(heat.sensor_temperatures)
    for _ in range(count):
        step = heat.advance(np.full((rows, 10, 2), force), np.tile(PLACE, (rows, 1, 1)))
        found.append((step.drop[:, -1, 0], step.info.copy()))
    return found


@pytest.mark.parametrize(
    ("name", "wall", "inside"),
    [
        ("ceramic", 0.002, water(0.03, 4.0, 70.0)),
        pytest.param("plastic", 0.001, water(0.03, 40.0, 70.0), marks=pytest.mark.slow),
        pytest.param("aluminium", 0.001, ice(0.01, 4.0), marks=pytest.mark.slow),
    ],
)
def test_fields_and_networks_agree(name: str, wall: float, inside: Reservoir, tmp_path: Path) -> None:
    """Before a touch, in it and behind it; the networks let contents stand still for twice as long."""
    both: list[Any] = []
    for kind in (FieldHeat, GraspHeat):
        heat = kind(1, **SETTINGS)
        heat.reset([0], [body_of(name, vessel(tmp_path, wall, inside))])
        rest = heat.rest().info
        assert rest["reservoir_temperature"][0] == inside.temperature
        both.append([*steps(heat, 40, 0.0), *steps(heat, 120), *steps(heat, 40, 0.0)])
    fields, networks = (
        {
            "drop": np.array([drop[0] for drop, _ in each]),
            **{
                key: np.array([info[key][0] for _, info in each])
                for key in (
                    "object_temperature",
                    "reservoir_temperature",
                    "reservoir_flow",
                    "imbalance",
                    "exchanged",
                )
            },
        }
        for each in both
    )
    assert np.abs(networks["drop"]).max() > 1.0
    for key, off in (("drop", 0.01), ("object_temperature", 0.04), ("reservoir_temperature", 0.01)):
        np.testing.assert_allclose(fields[key], networks[key], atol=off)
    np.testing.assert_allclose(fields["reservoir_flow"], networks["reservoir_flow"], rtol=5e-3)
    assert np.abs(fields["imbalance"]).max() < 1e-10 * fields["exchanged"][-1]


def test_a_state_goes_on_bit_for_bit_beside_other_rows(tmp_path: Path) -> None:
    """And books are the row's own, of full vessels and of empty ones."""
    every = [
        body_of("ceramic", vessel(tmp_path, 0.002, inside), 40.0)
        for inside in (water(0.03, 4.0), None, ice(0.01, 4.0))
    ]
    heat = FieldHeat(3, **SETTINGS)
    heat.reset([0, 1, 2], every)
    steps(heat, 20)
    state = heat.state([0, 2])
    expected = steps(heat, 10)
    other = FieldHeat(2, **SETTINGS)
    other.reset([0, 1], every[1::-1])
    other.set_state([1, 0], state)
    for (drop, info), (again, told) in zip(expected, steps(other, 10), strict=True):
        np.testing.assert_array_equal(drop[[2, 0]], again)
        for key in ("reservoir_temperature", "reservoir_flow", "object_temperature", "flow"):
            np.testing.assert_array_equal(info[[2, 0]][key], told[key])
        assert (np.abs(told["imbalance"]) < 1e-10 * told["exchanged"]).all()
    (_, info) = expected[-1]
    assert np.isnan(info["reservoir_temperature"][1]) and info["reservoir_flow"][1] == 0.0
    heat.reset([0], [every[1]])
    (_, info) = steps(heat, 1)[0]
    assert np.isnan(info["reservoir_temperature"][0]) and info["reservoir_flow"][0] == 0.0


def test_environments_take_fields_unless_networks_are_asked_for(tmp_path: Path) -> None:
    spec = vessel(tmp_path, 0.002, water(0.05, 4.0, 70.0))
    for anywhere, rung in (("auto", "fields"), (False, "body")):
        batch = GraspBatch(1, objects=spec, material="ceramic", ambient_temperature=ROOM, anywhere=anywhere)
        batch.reset([0], [np.random.default_rng(0)])
        for _ in range(60):
            batch.step(action_of(0.0, 15.0, 0.0)[None])
        assert batch.reading is not None
        truth = batch.reading.truth
        assert truth["rung"][0].startswith(rung)
        assert 24.0 < truth["object_temperature"][0] < 69.0 < truth["reservoir_temperature"][0] < 70.0
        assert abs(truth["heat_imbalance"][0]) < 1e-10 * truth["heat_exchanged"][0]
    box = ObjectSpec(reservoir=water(0.05, 4.0))
    assert not SimulationConfig(objects=box).by_fields
    assert (
        SimulationConfig(objects=spec).by_fields
        and not SimulationConfig(objects=spec, anywhere=False).by_fields
    )
