"""Parts in parts: which lies in which, and that a body of several holds what its parts do."""

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.errors import MeshError
from thermograsp.thermal.meshes.grid import MeshGridding
from thermograsp.thermal.meshes.network import body_network
from thermograsp.thermal.surfaces.nesting import hosts, net_volumes, shares_within
from thermograsp.thermal.surfaces.solid import Solid, SolidPart, SurfacePatch

rod, ring, ball = trimesh.creation.cylinder, trimesh.creation.annulus, trimesh.creation.icosphere
COARSE = MeshGridding(depth=0.1e-3, side=0.3e-3, growth=1.0, slanted=0.6e-3, oblique=0.8e-3, relief=4)
"""Heat is conserved on any grid."""


def box(*size, at=(0.0, 0.0, 0.0)):
    return trimesh.creation.box(size).apply_translation(at)


def nesting(*meshes):
    return hosts(shares_within([mesh.triangles for mesh in meshes]))


def some_turn(seed: int) -> np.ndarray:
    return trimesh.transformations.random_rotation_matrix(np.random.default_rng(seed).random(3))


@pytest.mark.parametrize("turn", [np.eye(4), some_turn(1), some_turn(2)], ids=["along", "turned", "turned 2"])
def test_what_lies_in_what_is_found(turn):
    def of(*meshes):
        return nesting(*(mesh.copy().apply_transform(turn) for mesh in meshes))

    outer, core, tip = box(0.04, 0.04, 0.04), box(0.03, 0.03, 0.03), box(0.01, 0.01, 0.01)
    assert of(outer, core, tip) == (None, 0, 1)
    assert of(outer, box(0.01, 0.01, 0.01, at=(0.01, 0, 0)), box(0.01, 0.01, 0.01)) == (
        None,
        0,
        0,
    )  # faces meet
    assert of(outer, outer) == (None, 0)
    assert of(outer, box(0.04, 0.04, 0.0001, at=(0, 0, 0.02005))) == (None, None)  # a sheet on it
    assert of(outer, box(0.04, 0.04, 0.0001, at=(0, 0, 0.01995))) == (None, 0)  # and one in it
    assert of(rod(0.01, 0.05, sections=64), ring(0.01, 0.0102, 0.05, sections=96)) == (None, None)
    assert of(rod(0.0102, 0.05, sections=144), rod(0.01, 0.05, sections=32)) == (None, 0)
    assert of(ring(0.01, 0.02, 0.05), rod(0.009, 0.04)) == (None, None)  # in its hole
    for crossing in ((outer, box(0.05, 0.01, 0.01)), (core, outer), (outer, core, box(0.035, 0.01, 0.01))):
        assert of(*crossing) is None


def test_own_volumes_sum_to_the_whole():
    within = (None, 0, 1, 0, None)
    net = net_volumes([np.array(v) for v in (10.0, 6.0, 2.0, 1.0, 4.0)], within)
    assert [float(v) for v in net] == [3.0, 4.0, 2.0, 1.0, 4.0]


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(
    ("meshes", "beside"),
    [
        ((rod(0.0125, 0.06), rod(0.012, 0.05)), False),
        ((rod(0.012, 0.06), ring(0.012, 0.0125, 0.06)), True),
        ((ball(4, 0.0125), ball(4, 0.012), ball(3, 0.009)), False),
    ],
    ids=["nested", "beside", "three"],
)
def test_heat_that_flows_in_is_the_rise_of_all_parts_by_their_heat_capacities(meshes, beside, turned):
    turn = some_turn(3) if turned else np.eye(4)
    names = ("rubber", "stainless_steel", "cork")[: len(meshes)]
    solid = Solid(
        tuple(
            SolidPart(mesh.vertices @ turn[:3, :3].T, mesh.faces, thermal.material(name))
            for mesh, name in zip(meshes, names, strict=True)
        )
    )
    each = [thermal.material(name).volumetric_heat_capacity for name in names]
    volumes = np.array([mesh.volume for mesh in meshes])
    if not beside:
        volumes[:-1] -= volumes[1:]
    x, y, z = (turn[:3, 0] * 0.0125).tolist()
    patch = SurfacePatch((x, y, z), (x, y, z), 36e-6)
    net = body_network(solid, [patch], gridding=COARSE, cache=False)
    assert net.outputs["heat"][0] ** 2 == pytest.approx(volumes @ each, rel=1e-9)
    assert net.ports.T @ net.outputs["heat"] == pytest.approx(1.0, rel=1e-9)  # J stored per J let in


def test_an_object_wholly_of_its_core_is_the_core_s():
    """A sleeve of no thickness changes nothing, nor does it where only its end is open."""
    mesh, patch = box(0.04, 0.04, 0.01), SurfacePatch((0, 0, 0.005), (0, 0, 1))
    rubber, steel = (
        SolidPart(mesh.vertices, mesh.faces, thermal.material(name)) for name in ("rubber", "stainless_steel")
    )
    moments = np.geomspace(0.01, 100, 9)
    plain, covered = (
        body_network(Solid(parts), [patch], cache=False).impedance(moments)
        for parts in ((steel,), (rubber, steel))
    )
    assert covered == pytest.approx(plain, rel=1e-9)


def test_parts_that_cross_are_taken_as_before():
    """Later parts win; separate pieces stay refused."""
    glass, steel = thermal.material("glass"), thermal.material("steel")
    block, bar = box(0.04, 0.04, 0.01), box(0.05, 0.01, 0.004)
    parts = SolidPart(block.vertices, block.faces, glass), SolidPart(bar.vertices, bar.faces, steel)
    net = body_network(Solid(parts), [SurfacePatch((0, 0, 0.005), (0, 0, 1))], cache=False)
    expected = bar.volume * steel.volumetric_heat_capacity
    expected += (block.volume - 0.04 * 0.01 * 0.004) * glass.volumetric_heat_capacity
    assert net.outputs["heat"][0] ** 2 == pytest.approx(expected, rel=1e-5)
    far = box(0.01, 0.01, 0.01, at=(0.1, 0, 0))
    with pytest.raises(MeshError, match="separate pieces"):
        body_network(
            Solid((parts[0], SolidPart(far.vertices, far.faces, steel))),
            [SurfacePatch((0, 0, 0.005), (0, 0, 1))],
            cache=False,
        )
