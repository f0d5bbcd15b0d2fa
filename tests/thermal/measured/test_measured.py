"""The shipped recordings predicted, the numbers that docs/validation.md states, and files that are broken."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal.measured import (
    Free,
    Predictions,
    Recordings,
    Touched,
    compare,
    confusion,
    drawn_apart,
    drops_of,
    fit_stack,
    known_labels,
    load_recordings,
    predict,
    shipped_recordings,
    sort_touches,
    touched_as,
    value_of,
    with_value,
)
from thermograsp.thermal.measured.predicting import force_of_contact, warmest_allowed
from thermograsp.thermal.stack import Sample, heated_stack

STACK = heated_stack("heated_thermistor")


@pytest.fixture(scope="module")
def shipped() -> Recordings:
    return shipped_recordings()


@pytest.fixture(scope="module")
def predicted(shipped: Recordings) -> Predictions:
    return predict(shipped, STACK, known_labels(shipped.labels, {}))


def test_mean_drops_of_the_fitted_runs(shipped: Recordings, predicted: Predictions) -> None:
    early = shipped.run <= 12
    rows = {
        r.label: r for r in compare(shipped.only(early), predicted.curves[early], np.random.default_rng(0))
    }
    assert rows["metal"].mean_rms < 0.03
    assert rows["wood"].mean_rms < 0.03
    assert all(row.ratio < 1.3 for row in rows.values())


def test_later_runs_and_cold_wood_which_nothing_was_fitted_to(
    shipped: Recordings, predicted: Predictions
) -> None:
    early = shipped.run <= 12
    later = shipped.only(~early)
    rows = {r.label: r for r in compare(later, predicted.curves[~early], np.random.default_rng(0))}
    for label in ("metal", "wood"):
        difference = drawn_apart(shipped.only(early), later, label, np.random.default_rng(0))
        assert rows[label].mean_rms < difference
    for half in (early, ~early):
        cold = half & (shipped.label == "cold_wood")
        error = shipped.only(cold).drops - drops_of(shipped, predicted.curves)[cold]
        assert np.sqrt(np.mean(error.mean(axis=0) ** 2)) < 0.1
    assert all(row.ratio < 1.4 for row in rows.values())
    cold = shipped.only(shipped.label == "cold_wood")
    assert -20 < predicted.free["cold_wood"] < warmest_allowed(cold)


def test_wood_over_metal_falls_as_measured(shipped: Recordings, predicted: Predictions) -> None:
    """Two half-spaces predict one ratio."""
    drops, t = drops_of(shipped, predicted.curves), shipped.t[shipped.start :]
    for time in (1.0, 7.0):
        at = int(np.argmin(np.abs(t - time)))
        ratios = [
            d[shipped.label == "wood", at].mean() / d[shipped.label == "metal", at].mean()
            for d in (drops, shipped.drops)
        ]
        assert ratios[0] == pytest.approx(ratios[1], abs=0.03)


def test_metal_and_cold_wood_are_confused_until_the_passive_sensor_is_asked(shipped: Recordings) -> None:
    touched = known_labels(shipped.labels, {})
    for passive in (False, True):
        chance = sort_touches(shipped, STACK, touched, shipped.run <= 12, passive=passive)
        table = confusion(shipped, list(touched), chance)
        assert chance.sum(axis=1) == pytest.approx(1)
        wood = table.labels.index("wood")
        assert table.table[wood, wood] == 60
        assert (table.right == 1.0) == passive
        assert table.right > 0.85


def made(touched: dict[str, Touched], temperature: float = 20.0, noise: float = 0.0) -> Recordings:
    """Touches that the preset would record, three runs of each label."""
    rng = np.random.default_rng(1)
    labels = np.array([label for label in touched for _ in range(6)])
    t = np.linspace(-1, 5, 151)
    force = np.where(t < -0.5, 0.0, np.clip(2 + 2 * t, 0, 4.4)) * rng.uniform(0.9, 1.1, (len(labels), 1))
    start = 29.5 + 0.1 * t[None] + np.zeros((len(labels), 1))
    bare = Recordings(t, start, np.full_like(start, temperature), force, np.arange(len(labels)) % 3, labels)
    heated = predict(bare, STACK, touched).curves
    return replace(bare, heated=heated + noise * rng.standard_normal((len(labels), 1)) * (t > 0))


@pytest.mark.slow
def test_a_fit_finds_the_sensor_that_made_the_touches() -> None:
    touched = {"wood": touched_as("wood=wood")[1], "metal": touched_as("metal=steel")[1]}
    record = made(touched, noise=0.01)
    free = [Free("cover.capacity", 1e2, 1e5), Free("film.resistance", 1e-4, 1e-1)]
    start = with_value(with_value(STACK, "cover.capacity", 4000.0), "film.resistance", 3e-3)
    fit = fit_stack(record, start, touched, free, np.random.default_rng(0))
    for name, found in fit.values.items():
        assert found.value == pytest.approx(value_of(STACK, name), rel=0.05)
        assert found.low <= found.value <= found.high
        assert not found.at_limit


def test_a_free_temperature_is_found() -> None:
    what = touched_as("cold=wood@5")[1]
    record = made({"cold": what}, temperature=12.0)
    found = predict(record, STACK, {"cold": replace(what, temperature="free")})
    assert found.free["cold"] == pytest.approx(5.0, abs=0.3)
    assert np.abs(drops_of(record, found.curves) - record.drops).max() < 0.05


def test_force_counts_from_its_last_rise(shipped: Recordings) -> None:
    force = force_of_contact(shipped)
    assert (force >= 0).all()
    t = np.linspace(-1, 2, 61)
    bumpy = np.where(t < -0.8, 1.2, np.where(t < -0.4, 0.0, 2.0))[None]
    one = replace(shipped.only(np.array([0])), t=t, force=bumpy)
    assert (force_of_contact(one)[0] == np.where(t < -0.4, 0.0, 2.0)).all()


def test_what_a_label_stands_for() -> None:
    assert touched_as("x=wood@3.5")[1].temperature == 3.5
    assert known_labels(["glass"], {})["glass"].sample == Sample(1.0, 2500 * 840)
    with pytest.raises(UnknownNameError, match="material"):
        known_labels(["metal_plate"], {})
    with pytest.raises(UnknownNameError, match="label 'mettle'"):
        known_labels(["metal"], {"mettle": touched_as("mettle=steel")[1]})
    with pytest.raises(InvalidValueError, match="passive, free or a number"):
        touched_as("x=wood@warm")


def arrays() -> dict[str, np.ndarray]:
    t = np.linspace(-1, 5, 151)
    curve = np.full((4, len(t)), 25.0)
    return {
        "time_s": t,
        "heated_degC": curve,
        "passive_degC": curve,
        "force_N": curve,
        "run": np.arange(4),
        "material": np.array(["wood"] * 4),
    }


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("force_N", None, "lacks force_N"),
        ("heated_degC", np.full((4, 151), np.nan), "heated_degC has 604 values that are not finite"),
        ("heated_degC", np.zeros((0, 151)), "holds no touch"),
        (
            "passive_degC",
            np.zeros((4, 150)),
            r"passive_degC must be \(touches, times\) = \(4, 151\), got \(4, 150\)",
        ),
        ("time_s", np.zeros(151), "must rise in equal steps"),
        ("time_s", np.linspace(0, 5, 151), "must begin at -0.8 s"),
        ("run", np.arange(3), r"run must be \(4,\)"),
        ("run", np.array([0.5] * 4), "whole numbers"),
        ("material", np.arange(4), "must be strings"),
        ("heated_degC", np.full((4, 151), 302.0), "must be in °C"),
        ("heated_degC", np.array([["a"] * 151] * 4), "must be numbers"),
        ("material", np.array([{}] * 4), "no .npz file of plain arrays"),
        ("material", np.array([b"wood"] * 4), "must be strings"),
        ("time_s", np.linspace(-1, 5, 151)[::-1], "must rise in equal steps"),
        ("time_s", np.linspace(-1000, 5000, 151), "a sample every 40 s: it must be in s"),
        ("time_s", np.array([0.0]), r"time_s must be \(20 or more,\), got \(1,\)"),
        ("force_N", np.full((4, 151), 459.0), "force_N holds 459: it must be in N"),
        ("force_N", np.full((4, 151), -4.0), "above 0, in N"),
        (
            "force_N",
            np.diag([4.0, 4.0, 0.0, 4.0]) @ np.ones((4, 151)),
            "in 1 of 4 touches, the first number 2",
        ),
        ("passive_degC", None, "lacks passive_degC"),
        ("heated_degC", np.zeros((4, 151), complex), "must be numbers"),
        ("passive_degC", np.full((4, 151), 90.0), "below passive_degC before the touch: are the two"),
    ],
)
def test_a_broken_file_is_refused_with_why(tmp_path: Path, name: str, value: object, message: str) -> None:
    file = tmp_path / "touches.npz"
    content = {**arrays(), name: value}
    np.savez(file, **{key: entry for key, entry in content.items() if entry is not None})
    with pytest.raises(InvalidValueError, match=message) as raised:
        load_recordings(file)
    assert "touches.npz" in str(raised.value)


def test_what_is_no_file_of_arrays_is_refused(tmp_path: Path) -> None:
    good = tmp_path / "good.npz"
    np.savez(good, **arrays())  # pyright: ignore[reportArgumentType]
    content = good.read_bytes()
    (tmp_path / "folder.npz").mkdir()
    (tmp_path / "text.npz").write_text("hello")
    (tmp_path / "nothing.npz").write_bytes(b"")
    (tmp_path / "cut.npz").write_bytes(content[: len(content) // 2])
    middle = len(content) // 3
    (tmp_path / "damaged.npz").write_bytes(content[:middle] + bytes(200) + content[middle + 200 :])
    np.save(tmp_path / "one.npy", np.arange(5.0))
    for name in ("text.npz", "missing.npz", "folder.npz", "nothing.npz", "cut.npz", "damaged.npz", "one.npy"):
        with pytest.raises(InvalidValueError, match=name):
            load_recordings(tmp_path / name)


def test_another_rate_predicts_the_same(shipped: Recordings) -> None:
    """Every second sample: the drops at the samples that are left stay."""
    few, every = np.array([0, 40, 90]), slice(None, None, 2)
    some = shipped.only(few)
    heated, passive, force = (curve[:, every] for curve in (some.heated, some.passive, some.force))
    half = replace(some, t=some.t[every], heated=heated, passive=passive, force=force)
    names = {label: touched_as("x=wood@20")[1] for label in half.labels}
    both = [predict(each, STACK, names) for each in (some, half)]
    assert np.abs(both[0].curves[:, every] - both[1].curves).max() < 0.02
