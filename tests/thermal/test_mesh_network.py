import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.thermal.bodies import Geometry
from thermograsp.thermal.mesh_solid import Solid, SurfacePatch, solid
from thermograsp.thermal.system import sample_geometry

PLATE = (0.04, 0.04, 0.01)
TOP = SurfacePatch((0.0, 0.0, 0.005), (0.0, 0.0, 1.0))
MOMENTS = np.geomspace(1 / 100, 20, 8)  # 1/s


def of(mesh, material: str = "glass") -> Solid:
    return solid(mesh.vertices, mesh.faces, thermal.material(material))


def network(body, *patches, **keywords):
    return thermal.body_network(body, patches, cache=False, **keywords)


@pytest.mark.parametrize("material", ["plastic", "glass", "stainless_steel", "aluminium"])
def test_a_box_s_impedance_is_the_plate_s(material):
    net = network(of(trimesh.creation.box(PLATE), material), TOP)
    geometry = Geometry(thermal.sensor("seed"), thermal.material(material), "T", 81e-6, "square", PLATE, 1)
    expected = sample_geometry(geometry).network("even", 1).impedance(MOMENTS)
    assert net.impedance(MOMENTS) == pytest.approx(expected, rel=0.1)


def test_heat_that_flows_in_is_the_object_s_rise():
    mesh = trimesh.creation.annulus(0.017, 0.02, 0.04)
    net = network(of(mesh), SurfacePatch((0.02, 0, 0), (1, 0, 0), 25e-6))
    capacity = mesh.volume * thermal.material("glass").volumetric_heat_capacity
    assert net.rates[0] == 0
    assert np.all(net.rates[1:] > 0)
    assert net.ports.T @ net.outputs["heat"] == pytest.approx(1.0, rel=1e-9)  # J stored per J let in
    assert net.outputs["heat"] == pytest.approx(capacity * net.outputs["mean"], rel=1e-6)
