"""Objects of several materials: what they weigh, what of them is touched, and how they feel."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.envs import (
    EVERYTHING,
    GraspBatch,
    GraspTask,
    ObjectSpec,
    Part,
    SimulationConfig,
    SortEnv,
    action_of,
    objects,
)
from thermograsp.envs.bodies.object_solids import object_solid
from thermograsp.envs.bodies.object_spec import scaled
from thermograsp.envs.sensing import touches
from thermograsp.errors import InvalidValueError, MeshError, UnknownNameError

ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)
RUBBER, STEEL = thermal.material("rubber"), thermal.material("stainless_steel")
PLAIN = ObjectSpec(size=(0.03, 0.04, 0.05), material="stainless_steel")
COATED = ObjectSpec(
    size=(0.03, 0.04, 0.05), material="rubber", parts=(Part("stainless_steel", size=(0.029, 0.039, 0.049)),)
)


def held(seconds: float = 4.0, rows: int = 1, **config):
    """Temperature drops (steps, rows) K of the left fingertip, and the last step, of a grasp with 10 N."""
    words = {"signal": "ideal", "placement": (0.0, 0.0), "tolerance": 0.02, "skin": None}
    batch = GraspBatch(rows, task=ENDLESS, **words, **config)
    batch.reset(range(rows), [np.random.default_rng(row) for row in range(rows)])
    steps = [batch.step(np.tile(action_of(0.0, 10.0, 0.0), (rows, 1))) for _ in range(round(seconds / 0.02))]
    drops = np.array([[step.info(row)["temperature_drop"][0] for row in range(rows)] for step in steps])
    return drops, steps[-1]


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, str]:
    """A shaft in a handle: their outline, the shaft, and the two as they lie beside each other in one file."""
    folder = tmp_path_factory.mktemp("parts")
    handle = trimesh.creation.annulus(0.003, 0.015, 0.08, sections=64)
    shaft = trimesh.creation.cylinder(0.003, 0.16, sections=64).apply_translation((0, 0, 0.04))
    profile = [[0, -0.04], [0.015, -0.04], [0.015, 0.04], [0.003, 0.04], [0.003, 0.12], [0, 0.12]]
    meshes = {
        "outline": trimesh.creation.revolve(profile, sections=64),
        "shaft": shaft,
        "both": trimesh.util.concatenate([handle, shaft]),
    }
    paths = {}
    for name, mesh in meshes.items():
        mesh.apply_translation((0.2, 0.1, 0.0))  # as files' coordinates come
        paths[name] = str(folder / f"{name}.stl")
        mesh.export(paths[name])
    return paths


@pytest.mark.slow
def test_a_sleeve_is_felt_between_its_material_and_the_core_s():
    """Once heat has passed the rubber's .5 mm; before that it is felt as rubber."""
    common = {"air": 0.0, "anywhere": True}
    coated, _ = held(objects=COATED, **common)
    rubber, _ = held(objects=replace(COATED, parts=()), **common)
    steel, _ = held(objects=PLAIN, **common)
    touching = rubber[:, 0] > 0.2
    assert np.all(coated[touching] > rubber[touching] - 0.02) and np.all(coated[touching] < steel[touching])
    assert np.all(coated[-25:] > rubber[-25:] + 0.2)
    assert np.abs(coated - rubber)[: np.argmax(touching) + 15].max() < 0.02


@pytest.mark.slow
def test_a_sleeve_of_no_thickness_is_none():
    """In weight, inertia, friction and heat."""
    bare = replace(COATED, parts=(Part("stainless_steel", size=COATED.size),))
    assert bare.weight == pytest.approx(PLAIN.weight, rel=1e-12)
    assert bare.inertia[1] == pytest.approx(PLAIN.inertia[1], rel=1e-12)
    assert bare.touched == STEEL and bare.sliding_friction == PLAIN.sliding_friction
    sleeved, plain = (held(1.5, objects=spec, anywhere=True)[0] for spec in (bare, PLAIN))
    assert sleeved == pytest.approx(plain, abs=1e-9)


def test_heat_taken_is_the_rise_times_the_heat_capacity_of_all_parts():
    volumes = np.prod(COATED.size), np.prod(COATED.parts[0].size or 0.0)
    capacity = (volumes[0] - volumes[1]) * RUBBER.volumetric_heat_capacity
    capacity += volumes[1] * STEEL.volumetric_heat_capacity
    batch = GraspBatch(1, objects=COATED, task=ENDLESS, placement=(0.0, 0.0), air=0.0)
    batch.reset([0], [np.random.default_rng(0)])
    taken = 0.0
    for _ in range(150):
        truth = batch.step(action_of(0.0, 10.0, 0.0)[None]).reading.truth
        taken += 0.02 * truth["heat_flow"][0].sum()
        rise = truth["object_temperature"][0] - 24.0
        assert capacity * rise == pytest.approx(taken, rel=1e-6, abs=1e-12)
    assert taken > 0.5


def test_mass_and_inertia_are_those_of_all_parts(files):
    """Against the parts' own, put together by the parallel-axes theorem."""
    size, at = (0.01, 0.012, 0.014), np.array([0.004, -0.003, 0.01])
    x, y, z = at.tolist()
    spec = replace(COATED, parts=(*COATED.parts, Part("cork", size=size, position=(x, y, z))))
    cork = thermal.material("cork")
    blocks = [
        (RUBBER.density, np.array(COATED.size), np.zeros(3)),
        (STEEL.density - RUBBER.density, np.array([0.029, 0.039, 0.049]), np.zeros(3)),
        (cork.density - STEEL.density, np.array(size), at),
    ]
    masses = np.array([density * np.prod(extent) for density, extent, _ in blocks])
    centre = sum(m * c for m, (_, _, c) in zip(masses, blocks, strict=True)) / masses.sum()
    inertia = np.zeros((3, 3))
    for mass, (_, extent, middle) in zip(masses, blocks, strict=True):
        square, away = extent**2, middle - centre
        inertia += mass * (
            np.diag(square.sum() - square) / 12 + away @ away * np.eye(3) - np.outer(away, away)
        )
    assert spec.weight == pytest.approx(masses.sum(), rel=1e-9)
    assert spec.inertia[0] == pytest.approx(centre, rel=1e-9)
    assert spec.inertia[1] == pytest.approx(inertia, rel=1e-9, abs=1e-15)
    assert replace(spec, mass=0.3).inertia[1] == pytest.approx(inertia * 0.3 / masses.sum(), abs=1e-15)
    larger = scaled(spec, 1.1, mass=0.9)
    assert larger.weight == pytest.approx(1.1**3 * 0.9 * spec.weight, rel=1e-9)
    assert larger.assembly.volumes == pytest.approx(1.1**3 * spec.assembly.volumes, rel=1e-9)


def test_a_mesh_s_parts_lie_where_their_files_say(files):
    handle = thermal.material("abs")
    bar = np.pi * 0.003**2 * 0.16 * np.sinc(1 / 32)  # of 64 sides
    spec = ObjectSpec(
        shape="mesh", mesh=files["outline"], material="abs", parts=(Part("steel", mesh=files["shaft"]),)
    )
    assert spec.weight == pytest.approx(
        spec.volume * handle.density + bar * (thermal.material("steel").density - handle.density), rel=1e-5
    )
    assert spec.inertia[0][2] > replace(spec, parts=()).inertia[0][2]  # steel reaches up from the handle
    assert spec.touched == handle
    shaft = spec.assembly.touched(np.array([0.0, 0.0, 0.06]), np.array([1.0, 0.0, 0.0]), 0.3)
    assert spec.materials[shaft].name == "steel"
    large = scaled(spec, 1.2)
    assert large.assembly.middles == pytest.approx(1.2 * spec.assembly.middles, abs=1e-8)
    solid = object_solid(spec, handle)
    assert solid.hosts == (None, 0)


def screwdrivers(files) -> list[ObjectSpec]:
    """A handle with a bore and the shaft in it: as one outline, and as two solids whose surfaces meet."""
    parts = (Part("steel", mesh=files["shaft"]),)
    return [
        ObjectSpec(shape="mesh", mesh=files[name], material="abs", parts=parts)
        for name in ("outline", "both")
    ]


def test_several_solids_in_one_file_weigh_what_their_outline_does(files):
    one, both = screwdrivers(files)
    assert both.weight == pytest.approx(one.weight, rel=1e-4)


@pytest.mark.slow
def test_several_solids_in_one_file_are_felt_as_their_outline(files):
    drops = [held(1.0, objects=spec)[0] for spec in screwdrivers(files)]
    assert drops[0].max() > 0.1  # a rigid face on a round handle of rubber
    assert np.abs(drops[0] - drops[1]).max() < 0.02


def test_what_is_touched_decides_surface_and_friction():
    """A core that comes out at the sides is what the pads meet; turned, they meet the rubber."""
    through = replace(COATED, parts=(Part("stainless_steel", size=(0.03, 0.039, 0.049)),))
    assert through.touched == STEEL and replace(through, yaw=np.pi / 2).touched == RUBBER
    config = SimulationConfig(objects=through)
    (body,) = config.possible_bodies(thermal.sensor("seed"))
    assert body.touched == STEEL and body.material == RUBBER
    plain = replace(body, spec=replace(body.spec, parts=()), material=STEEL)
    assert body.joint == plain.joint and body.spec.sliding_friction == STEEL.friction
    soft = replace(through, material="butter", parts=(Part("steel", size=(0.02, 0.02, 0.02)),))
    (soft,) = SimulationConfig(objects=soft).possible_bodies(thermal.sensor("seed"))
    assert np.isfinite(soft.crushing_force) and body.crushing_force == np.inf


def test_a_material_asked_for_is_that_around_the_parts():
    config = SimulationConfig(objects=COATED, material="cork")
    (body,) = config.possible_bodies(thermal.sensor("seed"))
    assert body.material.name == body.touched.name == "cork"
    assert body.spec.weight == pytest.approx(replace(COATED, material="cork").weight)
    assert body.solid is not None and body.solid.parts[0].material.name == "cork"


@pytest.mark.slow
def test_vector_and_single_environments_agree_bit_for_bit_and_scenes_take_parts():
    roller = objects()["rubber_roller"].spec()
    config = {"objects": [COATED, replace(COATED, parts=())], "material": None}
    together, _ = held(0.8, 3, **config)
    for row in range(3):
        words = {"signal": "ideal", "placement": (0.0, 0.0), "tolerance": 0.02, "skin": None}
        batch = GraspBatch(1, task=ENDLESS, **words, **config)
        batch.reset([0], [np.random.default_rng(row)])
        alone = [
            batch.step(action_of(0.0, 10.0, 0.0)[None]).info(0)["temperature_drop"][0]
            for _ in range(len(together))
        ]
        assert np.array_equal(alone, together[:, row])
    drops, last = held(1.0, scene=[COATED, replace(roller, position=(0.0, 0.08))], air=5.0)
    truth = last.reading.truth
    assert drops[-1, 0] > 0.5
    assert np.all(np.abs(truth["heat_imbalance"]) <= 1e-9 * truth["heat_exchanged"])


@pytest.mark.slow
def test_networks_of_parts_are_kept_by_content(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path))
    touches._body.cache_clear()
    first, _ = held(0.6, objects=COATED)
    monkeypatch.setattr("thermograsp.thermal.meshes.network.mesh_grid", None)
    touches._body.cache_clear()
    again, _ = held(0.6, objects=COATED)
    assert np.array_equal(first, again)


@pytest.mark.parametrize(
    ("changed", "error", "message"),
    [
        ({"parts": [Part("steel", size=(0.029, 0.039, 0.06))]}, InvalidValueError, "lies outside the object"),
        (
            {
                "parts": [
                    Part("steel", size=(0.01, 0.01, 0.02)),
                    Part("cork", size=(0.01, 0.01, 0.02), position=(0.0, 0.0, 0.01)),
                ]
            },
            InvalidValueError,
            "part 2 of cork overlaps part 1 of steel",
        ),
        ({"material": None}, InvalidValueError, "give the material that is around them"),
        ({"density": 800.0}, InvalidValueError, "no density"),
        ({"elements": (0.009, 0.003)}, InvalidValueError, "no elements"),
        ({"parts": [Part("steel", mesh="nothing.stl")]}, MeshError, "no such file"),
        ({"shape": "sphere", "size": (0.04,) * 3}, InvalidValueError, "of a sphere"),
    ],
)
def test_objects_that_cannot_be_are_refused(changed, error, message):
    with pytest.raises(error, match=message):
        replace(COATED, **changed)


def test_parts_that_cannot_be_are_refused(files):
    with pytest.raises(UnknownNameError, match="shape of a part 'cone'"):
        Part("rubber", size=(0.01, 0.01, 0.01), shape="cone")  # pyright: ignore[reportArgumentType]
    for wrong in (Part("rubber", size=(0.01, 0.01, 0.01)), ["rubber"], 3):
        with pytest.raises(InvalidValueError, match="give a list of envs.Part"):
            ObjectSpec(material="glass", parts=wrong)  # pyright: ignore[reportArgumentType]
    with pytest.raises(UnknownNameError, match="did you mean 'rubber'"):
        Part("ruber", size=(0.01, 0.01, 0.01))
    with pytest.raises(InvalidValueError, match="one of the two"):
        Part("rubber")
    with pytest.raises(InvalidValueError, match="leave out the shape"):
        Part("rubber", mesh="a.stl", shape="box")
    with pytest.raises(InvalidValueError, match="above 0"):
        Part("rubber", size=(0.01, 0.0, 0.01))
    with pytest.raises(InvalidValueError, match="give it a shape"):
        ObjectSpec(
            shape="mesh",
            mesh=files["outline"],
            material="abs",
            parts=(Part("steel", size=(0.01, 0.01, 0.01)),),
        )
    with pytest.raises(InvalidValueError, match="mode 'O' cannot tell"):
        GraspBatch(1, objects=COATED, mode="O")
    core = Part("stainless_steel", size=(0.029, 0.039, 0.049))
    assert hash(replace(COATED, parts=[core])) == hash(COATED)


@pytest.mark.slow
def test_pairs_to_sort_have_parts_too():
    """Around which the two are of the materials that are to be told apart."""
    env = SortEnv(objects=COATED, material=["rubber", "cork"], tolerance=0.5)
    _, info = env.reset(seed=0)
    assert set(info["material"]) == {"rubber", "cork"}
    bodies = env.batch.plant.scenes[0]  # pyright: ignore[reportAttributeAccessIssue]
    assert {body.touched.name for body in bodies} == {"rubber", "cork"}
    assert {body.spec.weight for body in bodies} == {0.1}
    env.close()


@pytest.mark.slow
def test_a_state_goes_on_bit_for_bit_in_an_environment_of_others_sizes():
    batch = GraspBatch(2, objects="screwdriver", randomize=EVERYTHING, tolerance=0.5)
    batch.reset([0, 1], [np.random.default_rng(row) for row in range(2)])
    for _ in range(45):
        batch.step(np.tile(action_of(0.0, 5.0, 0.0), (2, 1)))
    kept = pickle.loads(pickle.dumps(batch.state()))
    first, second = [], []
    for voltages in (first, second):
        for _ in range(3):
            voltages.append(
                batch.step(np.tile(action_of(0.0, 5.0, 0.0), (2, 1))).observation["voltage"].copy()
            )
        batch.set_state(kept)
    assert np.array_equal(first, second) and np.abs(first).max() > 0
