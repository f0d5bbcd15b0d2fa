"""`thermograsp bench grasp`: what is shipped holds, what must fail fails, and what is written is complete. No timing
decides."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import contextlib
import io
import json
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp import cli
from thermograsp.bench.grasp import course as course
from thermograsp.bench.grasp import errors as judged
from thermograsp.bench.grasp import measure as bench
from thermograsp.bench.grasp.course import (
    Grasp,
    grasp,
    placements,
    shapes,
)
from thermograsp.bench.grasp.errors import (
    Errors,
    HeatOfGrasps,
    errors,
    fates,
    worst,
)
from thermograsp.bench.grasp.figure import front
from thermograsp.envs import ObjectSpec, SolverSettings
from thermograsp.envs.mechanics.solver_settings import SHIPPED
from thermograsp.errors import InvalidValueError

MUJOCO = next(v.settings for v in bench.variants(quick=True) if v.family == "MuJoCo's defaults")


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    """`thermograsp bench grasp --quick --json` and its folder."""
    folder = tmp_path_factory.mktemp("bench")
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        assert cli.main(["bench", "grasp", "--quick", "--json", "--out", str(folder)]) == 0
    return folder, json.loads(out.getvalue())


@pytest.fixture(scope="module")
def placed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[ObjectSpec]]:
    """Every shape at two places that the quick run does not use."""
    rng = np.random.default_rng(7)
    found = shapes(tmp_path_factory.mktemp("shapes"))
    return {name: placements(spec, 2, rng) for name, spec in found.items()}


def point(document: dict, family: str, label: str = "") -> dict:
    return next(p for p in document["grasp"]["points"] if p["family"] == family and label in p["label"])


def still(normal: float = course.FORCE, shift: float = 0.0, failed: bool = False) -> Grasp:
    """A made-up grasp of one object that never moves by itself, with a constant force."""
    steps, substeps = len(course.lift_rates()), 2
    offset = np.zeros((steps, 1, 3))
    offset[-1, :, 0] = shift
    return Grasp(
        normal=np.full((steps, 1, substeps, 2), normal),
        centroid=np.zeros((steps, 1, substeps, 2, 2)),
        place=np.zeros((steps, 1, 2, 3)),
        offset=offset,
        height=0.02 + np.cumsum(course.lift_rates())[:, None] * course.PERIOD,
        failed=np.array([failed]),
        seconds=np.zeros(steps),
    )


@pytest.mark.parametrize("shape", bench.SHAPES)
def test_what_is_shipped_holds_every_shape(placed: dict[str, list[ObjectSpec]], shape: str) -> None:
    run = grasp(SHIPPED, placed[shape])
    assert fates(run) == [judged.HELD] * 2
    itself = errors(run, run, heat := HeatOfGrasps(placed[shape][0], 2), heat.drops(run))
    assert itself.slip < 0.05
    assert itself.force < 0.02 * course.FORCE
    assert itself.force_reference == itself.jitter == itself.drop == itself.drop_late == 0


def test_mujocos_defaults_slip_and_lose_the_sphere(placed: dict[str, list[ObjectSpec]]) -> None:
    assert set(fates(grasp(MUJOCO, placed["sphere"]))) == {judged.DROPPED}
    run = grasp(MUJOCO, placed["box"])
    moved = np.linalg.norm(run.offset[-1] - run.offset[course.end_of("settle") - 1], axis=-1)
    assert (moved > 0.002).all()


@pytest.mark.parametrize(("share", "fate"), [(0.9, judged.HELD), (1.15, judged.DROPPED)])
def test_friction_holds_what_coulomb_says(
    placed: dict[str, list[ObjectSpec]], share: float, fate: str
) -> None:
    """Both pads' friction against the weight, and what shaking adds to it at 1 m/s2."""
    box = placed["box"][0]
    assert box.friction is not None
    limit = 2 * box.friction * course.FORCE / (9.81 + 1.0)
    assert fates(grasp(SHIPPED, [replace(box, density=None, mass=share * limit)])) == [fate]


def test_contacts_softer_than_a_time_step_eject_unless_discrete(placed: dict[str, list[ObjectSpec]]) -> None:
    bare = replace(SHIPPED, timestep=0.005, refsafe=False)
    assert set(fates(grasp(bare, placed["cylinder"]))) == {judged.HELD}
    assert set(fates(grasp(replace(bare, integrator="implicitfast"), placed["cylinder"]))) <= {
        judged.EJECTED,
        judged.BROKEN,
    }


def test_creep_is_in_proportion_to_the_inverse_of_impratio(placed: dict[str, list[ObjectSpec]]) -> None:
    slips = []
    for impratio in (1.0, 10.0, 100.0):
        run = grasp(replace(SHIPPED, impratio=impratio), placed["box"])
        slips.append(np.abs(run.offset[-1] - run.offset[course.end_of("settle") - 1])[:, 2])
    np.testing.assert_allclose(slips[0] / slips[1], 10.0, rtol=0.05)
    np.testing.assert_allclose(slips[1] / slips[2], 10.0, rtol=0.05)


def test_warnings_of_runs_that_break_down_are_not_printed(
    placed: dict[str, list[ObjectSpec]],
    capfd: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)

    def log() -> tuple[bool, bool]:
        found = mujoco.MjLogConfig.get()
        return found.logto_console, found.logto_file

    before = log()
    run = grasp(SolverSettings(iterations=1), placed["box"][:1])
    assert fates(run) == [judged.BROKEN]
    assert log() == before
    assert not any(capfd.readouterr()) and not list(tmp_path.iterdir())


def test_a_time_step_must_divide_the_control_step(placed: dict[str, list[ObjectSpec]]) -> None:
    with pytest.raises(InvalidValueError, match="divide"):
        grasp(SolverSettings(timestep=0.003), placed["box"])


def test_fates_of_made_up_grasps() -> None:
    assert fates(still()) == [judged.HELD]
    assert fates(still(normal=1.3 * course.FORCE)) == [judged.JAMS]
    assert fates(still(normal=0.0)) == [judged.DROPPED]
    assert fates(replace(still(), height=np.full_like(still().height, 0.02))) == [judged.DROPPED]
    assert fates(still(shift=0.1)) == [judged.EJECTED]  # 0.1 m within a control step
    assert fates(still(failed=True)) == [judged.BROKEN]


def test_errors_of_made_up_grasps() -> None:
    heat = HeatOfGrasps(ObjectSpec(density=2700.0, friction=0.6), 1)
    exact = still()
    drops = heat.drops(exact)
    found = errors(still(shift=2e-4), exact, heat, drops)
    assert found.slip == pytest.approx(0.2)
    assert found.force == found.force_reference == found.jitter == found.drop == 0
    found = errors(still(normal=course.FORCE + 0.5), exact, heat, drops)
    assert found.force == pytest.approx(0.5) and found.force_reference == pytest.approx(0.5)
    assert 0 < found.drop_late <= found.drop < 1
    shaken = still()
    shaken.centroid[:, :, ::2, :, 1] = 3e-6
    assert errors(shaken, exact, heat, drops).jitter == pytest.approx(1.5)
    lost = errors(still(normal=0.0), exact, heat, drops)
    assert worst([found, lost]).fate == judged.DROPPED and np.isnan(worst([found, lost]).slip)
    assert worst([found, replace(found, slip=9.0)]) == replace(found, slip=9.0)


def test_front_and_beaten_by_exhaustive_search() -> None:
    rng = np.random.default_rng(0)
    points = [
        bench.Point(
            replace(bench.variants(True)[0], label=str(i)),
            {},
            Errors(judged.HELD if i % 7 else judged.DROPPED, *(rng.lognormal(size=6) if i % 7 else ())),
            1.0,
            float(rng.lognormal()),
        )
        for i in range(60)
    ]
    slips = [
        {"ratio": p.ratio, "slip": p.worst.slip if p.worst.fate == judged.HELD else np.nan, "of": p}
        for p in points
    ]
    best = [record["of"] for record in front(slips, lambda record: record["slip"])]
    held = [p for p in points if p.worst.fate == judged.HELD]
    expected = [
        p
        for p in held
        if not any(q.ratio <= p.ratio and q.worst.slip <= p.worst.slip and q is not p for q in held)
    ]
    assert best == sorted(expected, key=lambda p: p.ratio)
    for p in points:
        assert not bench.beats(p, p)
        if p.worst.fate == judged.HELD:
            better = replace(p, ratio=0.5 * p.ratio)
            assert bench.beats(better, p) and not bench.beats(p, better)
            assert not any(bench.beats(q, p) for q in points if q.worst.fate == judged.DROPPED)


def test_course_is_what_its_phases_say() -> None:
    rates = course.lift_rates()
    assert len(rates) == sum(course.PHASES.values()) == round(course.duration() / course.PERIOD)
    assert np.abs(rates).max() <= 0.05
    assert not rates[: course.end_of("close")].any() and not rates[course.end_of("shake") :].any()
    height = np.cumsum(rates) * course.PERIOD
    assert height.min() >= 0 and height[course.end_of("lift") - 1] > 0.02  # off the table while shaken
    assert height[course.end_of("lift") :].min() > 0.015


def test_quick_run_writes_figures_and_a_complete_document(written: tuple[Path, dict]) -> None:
    folder, document = written
    for name in ("grasp", "grasp_shapes"):
        for suffix in (".png", ".svg"):
            file = folder / (name + suffix)
            assert file.stat().st_size > 10_000 and str(file) in document["figures"]
        text = (folder / f"{name}.svg").read_text(encoding="utf-8")
        assert "seed 0" in text and "mujoco" in text
    found = document["grasp"]
    assert [(p["family"], p["label"]) for p in found["points"]] == [
        (v.family, v.label) for v in bench.variants(quick=True)
    ]
    assert SolverSettings(**{**found["reference"], "timestep": SHIPPED.timestep}) == replace(
        SHIPPED, solref=list(SHIPPED.solref), solimp=list(SHIPPED.solimp)
    )
    names = {f"{name}_{unit}" for name, unit in found["metrics"].items()} | {"fate"}
    for p in found["points"]:
        assert p["seconds_per_second"] > 0 and p["ratio"] > 0
        assert set(p["shapes"]) == set(bench.SHAPES)
        for outcome in (p["worst"], *p["shapes"].values()):
            assert set(outcome) == names and outcome["fate"] in found["fates"]
            held = outcome["fate"] == judged.HELD
            assert all((outcome[name] is not None) == held for name in names - {"fate"})


def test_quick_run_finds_what_is_known(written: tuple[Path, dict]) -> None:
    document = written[1]
    shipped = point(document, "shipped")
    assert shipped["ratio"] == 1
    for outcome in shipped["shapes"].values():
        assert outcome["fate"] == judged.HELD and outcome["slip_mm"] < 0.5 and outcome["drop_late_K"] < 0.2
    assert point(document, "MuJoCo's defaults")["worst"]["fate"] != judged.HELD
    assert point(document, "implicitfast", "refsafe off")["worst"]["fate"] != judged.HELD
    assert point(document, "Newton", "1 iteration")["worst"]["fate"] == judged.BROKEN
    assert point(document, "noslip")["worst"]["slip_mm"] < 0.2 * shipped["worst"]["slip_mm"]
    assert point(document, "elliptic cone")["worst"]["slip_mm"] > 20 * shipped["worst"]["slip_mm"]
    coarse, fine = (point(document, "time step", label)["worst"] for label in ("4 ms", "1 ms"))
    for error in ("jitter_um", "drop_K", "force_reference_N"):
        assert fine[error] < coarse[error]


def test_full_variants_have_names_of_their_own() -> None:
    names = [v.name for v in bench.variants(quick=False)]
    assert len(set(names)) == len(names) > 35
    assert {v.name for v in bench.variants(quick=True)} <= set(names)
