"""The benchmarks: methods fail where theory says, ours nowhere; what is written is complete. No timing decides."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from thermograsp import cli
from thermograsp.bench.accuracy import (
    elements,
    fipy_press,
    steppers,
)
from thermograsp.bench.accuracy import (
    measure as accuracy,
)
from thermograsp.bench.accuracy.measure import press_problem
from thermograsp.bench.accuracy.semi_discrete import disc_press
from thermograsp.bench.stability import bars
from thermograsp.bench.stability import measure as atlas
from thermograsp.cli.bench import BENCHMARKS
from thermograsp.thermal import RUNGS

STEPS = 200


@pytest.fixture(scope="module")
def maps() -> dict[str, atlas.Map]:
    return {each.key: each for each in atlas.atlas(20, STEPS, 0, lambda doing: None)}


def pairs(each: atlas.Map) -> tuple[np.ndarray, np.ndarray]:
    """Fourier number and stiffness of every pixel (Y, X)."""
    fourier, beta = np.meshgrid(each.x, each.y)
    return fourier, beta


def gaps(scheme: bars.Scheme, fourier: float, beta: float, steps: int) -> np.ndarray:
    """Gap between the faces after each step in contact."""
    closed = np.ones((steps, 1), bool)
    history = scheme(np.array([fourier]), np.array([beta]), closed)
    return np.array([u[0, bars.FIRST] - u[0, bars.SECOND] for u in history])


def test_rate_of_the_contact_is_the_operators_largest_eigenvalue() -> None:
    beta = np.geomspace(1e-3, 1e4, 30)
    largest = np.linalg.eigvals(bars.conduction(beta)).real.max(axis=1)
    # the formula is for endless bars, whose shortest wave 16 cells miss by a percent
    np.testing.assert_allclose(atlas.contact_rate(beta), largest, rtol=0.012)


def test_explicit_steps_blow_up_above_their_limit_and_only_there(maps: dict[str, atlas.Map]) -> None:
    fourier, beta = pairs(maps["ftcs"])
    beyond = fourier * atlas.contact_rate(beta) / 2
    blown = maps["ftcs"].kinds == atlas.BLOWN
    assert blown[beyond > 1.1].all() and not blown[beyond < 0.99].any()
    assert blown[fourier > 0.55].all()  # whatever the contact does


def test_crank_nicolson_never_blows_up_but_rings_on_a_stiff_contact(maps: dict[str, atlas.Map]) -> None:
    each = maps["crank_nicolson"]
    fourier, beta = pairs(each)
    beyond = fourier * atlas.contact_rate(beta) / 2
    assert not (each.kinds == atlas.BLOWN).any()
    assert (each.kinds[beyond < 0.95] == atlas.FINE).all()
    stiff = (beta > 1) & (beyond > 2)
    assert (each.kinds[stiff] != atlas.FINE).all()
    signs = np.sign(gaps(bars.crank_nicolson, 10.0, 1e3, 6))
    assert (signs == [-1, 1, -1, 1, -1, 1]).all()


def test_sdirk2_leaves_the_range_by_at_most_what_its_stability_function_allows(
    maps: dict[str, atlas.Map],
) -> None:
    each = maps["sdirk2"]
    fourier, beta = pairs(each)
    limit = (1 + np.sqrt(2)) / atlas.contact_rate(beta)
    assert (each.kinds[fourier < 0.95 * limit] == atlas.FINE).all()
    assert each.share(atlas.WRONG) > 0.05 and not each.share(atlas.BLOWN)
    assert 0.1 < each.outside.max() < 0.207
    assert gaps(bars.sdirk2, 0.1, 10.0, 1)[0] < 0


def test_a_flux_held_linear_turns_around_at_its_limit(maps: dict[str, atlas.Map]) -> None:
    for fourier in (0.02, 1.0, 50.0):
        limit = float(bars.hold_limit(np.array([fourier]))[0])
        assert gaps(bars.first_order_hold, fourier, 0.99 * limit, 1)[0] > 0
        assert gaps(bars.first_order_hold, fourier, 1.01 * limit, 1)[0] < 0
    # a half-space's face rises by 2/3 sqrt(F/pi) under a flux that falls from 1 to 0
    expected = 1 / (bars.PULL * (2 / 3) * np.sqrt(20.0 / np.pi))
    assert bars.hold_limit(np.array([20.0]))[0] == pytest.approx(expected, rel=0.05)
    assert maps["first_order_hold"].share(atlas.BLOWN) > 0.2


@pytest.mark.parametrize(
    ("key", "pull"), [("lagged_flux", bars.PULL), ("dirichlet_neumann", 1 / bars.LIGHT - 1)]
)
def test_staggered_bodies_diverge_beyond_their_limit_and_only_there(
    maps: dict[str, atlas.Map], key: str, pull: float
) -> None:
    fourier, beta = pairs(maps[key])
    limit = bars.surface_admittance(2 / fourier.ravel()).reshape(fourier.shape) / pull
    blown = maps[key].kinds == atlas.BLOWN
    assert blown[beta > 1.15 * limit].all() and not blown[beta < 0.99 * limit].any()


def test_backward_euler_is_safe_and_of_first_order(maps: dict[str, atlas.Map]) -> None:
    assert maps["backward_euler"].share(atlas.FINE) == 1
    exact = gaps(bars.package_step, 1.0, 0.5, 1)[-1]
    errors = [abs(gaps(bars.backward_euler, 1.0 / n, 0.5, n)[-1] - exact) for n in (16, 32, 64)]
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(1, abs=0.1)


def test_ours_is_stable_in_range_and_keeps_heat_everywhere(maps: dict[str, atlas.Map]) -> None:
    for key, outside, heat in (("ours", 1e-5, 1e-12), ("ours_float32", 1e-5, 1e-5)):
        assert maps[key].share(atlas.FINE) == 1
        assert maps[key].outside.max() < outside < atlas.TOLERANCE
        assert maps[key].heat.max() < heat


@pytest.mark.parametrize("fourier", [1e-2, 1.0, 1e3])
@pytest.mark.parametrize("beta", [1e-3, 1.0, 1e4])
def test_ours_is_exact_at_any_step(fourier: float, beta: float) -> None:
    matrix = bars.conduction(np.array([beta]))[0]
    exact = expm(-3 * fourier * matrix) @ bars.first_temperatures(1)[0]
    *_, last = bars.package_step(np.array([fourier]), np.array([beta]), np.ones((3, 1), bool))
    assert np.abs(last[0] - exact).max() < 2e-5


def test_series_of_ten_terms_is_wrong_late_where_the_object_conducts_well(maps: dict[str, atlas.Map]) -> None:
    each = maps["series"]
    time, contrast = np.meshgrid(each.x, each.y)
    assert (each.kinds[time < 10] == atlas.FINE).all()
    assert (each.kinds[(time > 100) & (contrast < 0.1)] == atlas.WRONG).all()


def test_plain_grid_converges_to_the_layered_rung_in_second_order() -> None:
    problem = press_problem("glass", "T")
    solve = RUNGS["layered"].solve
    assert solve is not None
    exact = solve(problem, np.array([2.0])).temperature_drop[0]
    errors = []
    for cell in (1e-4, 5e-5, 2.5e-5):
        system = disc_press(problem, cell, lateral=False)
        drop = steppers.ivp(system, 2.0, 1, "Radau", rtol=1e-8, atol=1e-8)()
        errors.append(abs(drop[-1] - exact))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert errors[-1] < 1e-4


@pytest.mark.parametrize("mode", ["T", "O"])
def test_plain_grid_and_every_stepper_agree(mode: str) -> None:
    system = disc_press(press_problem("glass", mode), 1e-3)
    assert np.abs(system.stiffness - system.stiffness.T).max() < 1e-12
    exact = steppers.ivp(system, 0.5, 2, "Radau", rtol=1e-8, atol=1e-8)()[-1]
    for march, tolerance in (
        (steppers.theta(system, 0.5, 2, 1.0, substeps=400), 0.01),
        (steppers.theta(system, 0.5, 2, 0.5, substeps=50), 0.01),
        (steppers.sdirk2(system, 0.5, 2, substeps=50), 0.01),
        (steppers.ivp(system, 0.5, 2, "BDF"), 0.01),
        (steppers.ivp(system, 0.5, 2, "LSODA"), 0.01),
        (steppers.ftcs(system, 0.5, 2, of_limit=0.1), 0.015),  # of first order
    ):
        assert march()[-1] == pytest.approx(exact, abs=tolerance)


def test_explicit_steps_on_the_plain_grid_blow_up_beyond_twice_the_bound() -> None:
    system = disc_press(press_problem("aluminium", "T"), 1e-3)
    assert np.abs(steppers.ftcs(system, 1.0, 1)()).max() < 12
    with np.errstate(all="ignore"):
        assert not np.abs(steppers.ftcs(system, 1.0, 1, of_limit=2.2)()).max() < 12


@pytest.mark.parametrize("mode", ["T", "O"])
def test_fipy_and_backward_euler_on_the_plain_grid_are_one_method(mode: str) -> None:
    pytest.importorskip("fipy")
    problem = press_problem("glass", mode)
    fipy_drop = fipy_press.fipy_press(problem, 0.02, 10, 1e-3)()
    ours = steppers.theta(disc_press(problem, 1e-3), 0.02, 10, 1.0)()
    np.testing.assert_allclose(fipy_drop, ours, atol=1e-9)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_elements_agree_with_the_semi_analytic_rung(mode: str) -> None:
    pytest.importorskip("skfem")
    problem = press_problem("glass", mode)
    solve = RUNGS["semi_analytic"].solve
    assert solve is not None
    exact = solve(problem, np.array([0.5, 1.0])).temperature_drop
    drop = steppers.sdirk2(elements.element_press(problem, 4), 0.02, 50)()
    assert np.abs(drop[[25, 50]] - exact).max() < 0.05


def test_peers_plates_have_the_exact_temperatures_that_were_published_with_it(
    written: tuple[Path, dict],
) -> None:
    found = {touch["plate"]: touch for touch in written[1]["peer"]["plates"]}
    published = {
        "wood": 32.72,
        "plastic": 32.10,
        "glass": 29.42,
        "stainless_steel": 25.55,
        "aluminium": 24.57,
    }
    for plate, exact in published.items():
        assert found[plate]["exact"] == pytest.approx(exact, abs=0.006)
        assert np.abs(np.array(found[plate]["column"]) - exact).max() < 0.03
    for plate, mean in (("aluminium", 28.86), ("glass", 31.89), ("wood", 33.95)):
        assert found[plate]["first_millimetre"] == pytest.approx(mean, abs=0.006)
    for touch in found.values():
        assert touch["heat"][1] == pytest.approx(touch["heat"][0], rel=0.01)


def test_quick_run_writes_figures_and_a_complete_document(written: tuple[Path, dict]) -> None:
    folder, document = written
    for name in ("accuracy", "accuracy_o", "stability", "peer"):
        for suffix in (".png", ".svg"):
            file = folder / (name + suffix)
            assert file.stat().st_size > 10_000 and str(file) in document["figures"]
        assert "seed 3" in (folder / f"{name}.svg").read_text(encoding="utf-8")
    assert document["provenance"]["seed"] == 3
    assert {"thermograsp", "python", "numpy", "scipy", "numba"} <= set(document["provenance"]["versions"])
    assert len(document["stability"]["maps"]) == 10
    assert {m["scheme"] for m in document["stability"]["maps"]} >= {"ours", "ftcs", "series"}
    assert "Genesis World 1.4.5" in document["peer"]["published_by"]
    assert len(document["peer"]["plates"]) == 5


@pytest.mark.parametrize("name", BENCHMARKS)
def test_a_saved_record_is_drawn_again_to_the_same_bytes(
    written: tuple[Path, dict], name: str, tmp_path: Path
) -> None:
    folder = written[0]
    assert cli.main(["bench", "--from", str(folder / f"{name}.json"), "--out", str(tmp_path)]) == 0
    drawn = list(tmp_path.iterdir())
    assert drawn and all(file.read_bytes() == (folder / file.name).read_bytes() for file in drawn)


def test_a_record_of_another_version_says_what_it_lacks(
    written: tuple[Path, dict], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = {**written[1], "peer": {}}
    (tmp_path / "peer.json").write_text(json.dumps(record))
    assert cli.main(["bench", "peer", "--from", str(tmp_path / "peer.json"), "--out", str(tmp_path)]) == 2
    assert "another version wrote it; measure again" in capsys.readouterr().err


def test_accuracy_points_are_complete_and_auto_keeps_its_tolerance(written: tuple[Path, dict]) -> None:
    points = written[1]["accuracy"]["points"]
    expected = accuracy.methods(True)
    assert len(points) == 2 * len(expected)
    for point in points:
        assert point["seconds_per_second"] > 0 and point["ratio"] > 0
        assert np.isfinite(point["error_K"])
        if point["method"] == "auto":
            assert point["error_K"] <= float(point["setting"].split()[0])
    for mode in "TO":
        of_mode = [p for p in points if p["mode"] == mode]
        front = sorted((p for p in of_mode if p["pareto"]), key=lambda p: p["seconds_per_second"])
        assert all(b["error_K"] <= a["error_K"] for a, b in zip(front, front[1:], strict=False))
        best = min(p["error_K"] for p in of_mode)
        assert front[-1]["error_K"] == best


def test_bad_input_is_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert cli.main(["bench", "peer", "--out", str(tmp_path / "file")]) == 2
    assert "not a folder" in capsys.readouterr().err
    assert cli.main(["bench", "speedy"]) == 2
    assert cli.main(["bench", "peer", "--seed", "-1", "--out", str(tmp_path)]) == 2
