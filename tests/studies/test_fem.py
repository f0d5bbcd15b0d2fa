"""The finite-element reference, on coarse meshes: rates, energy, and the semi-analytic table."""

from __future__ import annotations

import importlib.util
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import eigsh

pytest.importorskip("skfem")

from thermograsp.thermal.rungs import grid_3d  # noqa: E402

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def fem():
    path = ROOT / "studies" / "elements" / "fem.py"
    spec = importlib.util.spec_from_file_location("thermograsp_benchmarks_fem", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


def _block(fem, cells: int):
    lines = np.linspace(0, 1, cells + 1)
    return fem.Block(lines, lines, lines, [0.0, 1.0], [2.0], [3.0])


def _orders(errors: list[float]) -> np.ndarray:
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_decay_rate_of_a_cosine_mode_converges_in_fourth_order(fem):
    """Triquadratic elements: eigenvalues are off by the fourth power of the mesh width (Strang & Fix, section 6.3)."""
    exact = 2.0 / 3.0 * np.pi**2
    errors = []
    for cells in (2, 4, 8):
        block = _block(fem, cells)
        stiffness, mass = block.stiffness.tocsc(), block.mass.tocsc()
        values, _ = eigsh(stiffness, k=3, M=mass, sigma=exact * 0.99)
        errors.append(float(np.abs(values - exact).min()))
    assert abs(_orders(errors)[-1] - 4) < 0.1, errors


def test_a_source_problem_converges_in_third_order(fem):
    """(mass + stiffness) u = f with u = cos cos cos: error in L2, measured with a finer rule than the assembly's."""
    errors = []
    for cells in (2, 4, 8):
        block = _block(fem, cells)
        fine = fem.Basis(block.mesh, fem.ElementHex2(), intorder=8)
        x = np.asarray(fine.global_coordinates())
        exact = np.cos(np.pi * x[0]) * np.cos(np.pi * x[1]) * np.cos(2 * np.pi * x[2])
        field = fem.DiscreteField((3 + 2 * 6 * np.pi**2) * exact)
        load = fem.LinearForm(lambda v, w: w.f * v).assemble(fine, f=field)
        u = fem.factor((block.mass + block.stiffness).tocsc()).solve(load)
        difference = np.asarray(fine.interpolate(u)) - exact
        errors.append(float(np.sqrt(np.sum(difference**2 * fine.dx))))
    assert abs(_orders(errors)[-1] - 3) < 0.1, errors


def test_time_stepping_is_of_second_order(fem):
    """The slowest cosine mode of the discrete operator decays with its own discrete rate."""
    block = _block(fem, 2)
    stiffness, mass = block.stiffness.tocsc(), block.mass.tocsc()
    rates, modes = eigsh(stiffness, k=6, M=mass, sigma=7.0)
    rate, mode = rates[-1], modes[:, -1]
    nothing = np.zeros(len(mode))
    system = fem.System(
        mass,
        stiffness,
        nothing,
        sparse.identity(len(mode), format="csr"),
        nothing,
        nothing,
        nothing,
        0.0,
        nothing,
        mode,
    )
    errors = []
    for steps in (8, 16, 32):
        step = 1 / rate / steps
        solver = fem.factor((mass + fem.GAMMA / 2 * step * stiffness).tocsc())
        v = mode
        for _ in range(steps):
            _, v = fem.tr_bdf2(solver, system, v, step)
        errors.append(float(np.abs(v - mode * np.exp(-1)).max()))
    assert np.all(np.abs(_orders(errors) - 2) < 0.1), errors


@pytest.mark.parametrize("case", ["glass/10000/T", "plastic/10000/O"])
def test_energy_and_the_reference_table(fem, case):
    table = json.loads((ROOT / "tests" / "data" / "press_3d.json").read_text(encoding="utf-8"))["cases"][case]
    t, reference = (np.array(table[key][1:6]) for key in ("t", "Td"))
    result = fem.extrapolate(fem.reference_problem(case), t, levels=(0.5, 0.7))
    assert np.abs(result.value - reference).max() < result.error + fem.TOLERANCE
    assert np.abs(result.levels[-1].temperature_drop - reference).max() < result.error + fem.TOLERANCE
    for curves in result.levels:
        # T: what the object gains has crossed the contact; O: the element's share too
        gained = curves.stored_heat[:, 1] if case.endswith("T") else curves.stored_heat.sum(axis=1)
        assert np.abs(gained - curves.passed_heat).max() < 1e-10 * np.abs(curves.passed_heat).max()


@pytest.mark.parametrize(("mode", "refine"), [("T", 0.7), ("O", 0.5)])
def test_small_contact_in_air_agrees_with_the_finite_volumes(fem, mode, refine):
    """Two discretisations without a line in common, on a rectangular plate."""
    problem = replace(
        fem.reference_problem("glass/10000/" + mode), area=36e-6, air=20.0, object_size=(0.03, 0.02, 0.005)
    )
    t = np.array([0.2, 1.0, 4.0])
    elements = fem.run(problem, t, refine=refine)
    volumes = grid_3d.solve(problem, t, resolution=1)
    assert np.abs(elements.temperature_drop - volumes.temperature_drop).max() < 0.025
    assert elements.heat_flow == pytest.approx(volumes.heat_flow, rel=0.02)
    assert elements.stored_heat == pytest.approx(volumes.stored_heat, rel=0.02, abs=0.01)


def test_what_it_cannot_do_is_refused(fem):
    problem = replace(fem.reference_problem("glass/10000/T"), shape="round")
    with pytest.raises(ValueError, match="square"):
        fem.run(problem, np.array([1.0]))
