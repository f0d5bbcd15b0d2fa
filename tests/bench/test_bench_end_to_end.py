"""`thermograsp bench episode`: errors shrink with each knob and keep what the docs say. No timing decides."""

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from thermograsp.bench.episode import measure as end_to_end
from thermograsp.bench.episode.measure import REFERENCE, SHIPPED, Setting


@pytest.fixture(scope="module")
def errors() -> dict[Setting, float]:
    """V rms of settings on four grasps, one of them the finest of the full benchmark."""
    chosen = [
        SHIPPED,
        Setting(0.0005, 20, 0.01),
        Setting(0.002, 10, 0.5),
        Setting(0.005, 4, 0.05),
        Setting(0.002, 20, 0.05),
    ]
    points = end_to_end.measure(chosen, 4, 1, 1, lambda setting: None)
    assert not any(p.lost for p in points)
    return {p.setting: p.error for p in points}


def test_the_finest_setting_is_the_best(errors: dict[Setting, float]) -> None:
    finest = Setting(0.0005, 20, 0.01)
    assert finest in end_to_end.settings(quick=False)
    assert errors[finest] == min(errors.values())
    assert errors[finest] < 10e-6


def test_the_shipped_setting_errs_by_less_than_the_documentation_says(errors: dict[Setting, float]) -> None:
    assert errors[SHIPPED] < 20e-6


def test_every_knob_costs_accuracy(errors: dict[Setting, float]) -> None:
    for coarser in (Setting(0.002, 10, 0.5), Setting(0.005, 4, 0.05), Setting(0.002, 20, 0.05)):
        assert errors[coarser] > 1.3 * errors[SHIPPED]


def test_settings_share_their_readings() -> None:
    for setting in [*end_to_end.settings(quick=False), REFERENCE]:
        steps = end_to_end.TICK / setting.period
        assert steps == pytest.approx(round(steps)) and round(steps) >= 1
    assert SHIPPED in end_to_end.settings(quick=True) and SHIPPED in end_to_end.settings(quick=False)


def test_the_script_is_the_same_for_every_setting_and_touches_twice() -> None:
    actions = end_to_end._script(np.random.default_rng(0), 2)
    assert np.array_equal(actions, end_to_end._script(np.random.default_rng(0), 2))
    voltage, _, lost = end_to_end._run(SHIPPED, actions, 0)
    assert not lost and voltage.shape == (len(actions), 2, 2)
    rise, second = np.diff(voltage.mean(axis=2), axis=0), round(1.0 / end_to_end.TICK)
    for touched in (
        rise[:second],
        rise[-second:],
    ):  # a touch draws heat at once, less from what is cold already
        assert touched.max() > 5e-5


def test_document_is_complete(written: tuple[Path, dict]) -> None:
    folder, document = written[0], written[1]["episode"]
    points = document["points"]
    assert len(points) == len(end_to_end.settings(quick=True))
    shipped = [p for p in points if all(p[key] == value for key, value in asdict(SHIPPED).items())]
    assert len(shipped) == 1 and shipped[0]["speed"] == 1
    for p in points:
        assert p["seconds_per_second"] > 0 and p["speed"] > 0 and p["error_V"] > 0
        assert p["control_step_s"] == pytest.approx(p["timestep"] * p["substeps"])
    front = sorted((p for p in points if p["pareto"]), key=lambda p: p["speed"])
    assert front[0]["error_V"] == min(p["error_V"] for p in points)
    assert front[-1]["speed"] == max(p["speed"] for p in points)
    for suffix in (".png", ".svg"):
        assert (folder / f"end_to_end{suffix}").stat().st_size > 10_000
