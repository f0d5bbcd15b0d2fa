"""The comparison of identifiers, from the quick run of all benchmarks."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.bench.identify import measure as run
from thermograsp.bench.identify import measured
from thermograsp.bench.identify.rivals import support_vectors
from thermograsp.bench.identify.touches import SETUP, WINDOWS, Identified, Touches


def test_the_identifier_is_beside_the_limit(written: tuple[Path, dict]) -> None:
    folder, document = written
    found = document["identify"]
    for name in ("identify.png", "identify.svg"):
        assert str(folder / name) in document["figures"]
    right = found["right"]
    # 80 touches: one that is named otherwise is 1.25 %
    np.testing.assert_allclose(right["identify"], right["limit"], atol=0.04)
    assert min(found["agreement_with_limit"]) > 0.9
    assert right["limit"][-1] > right["limit"][0] and right["limit"][-1] > 0.9
    for name in set(right) & {"svm", "net"}:
        assert np.mean(right[name]) <= np.mean(right["limit"]) + 0.02
    steady, unknown = (found["eleven"]["right"][name]["limit"] for name in ("steady", "unknown"))
    assert np.mean(steady) > np.mean(unknown) - 0.03
    assert found["published"] == {"0.5": 0.84, "1.5": 0.98}
    for one in found["coverage"]:
        assert 0.75 < one["held"] <= 1.0  # 60 objects
        assert 1 < one["ratio"][0] < one["ratio"][2]
    for table in found["confusion"].values():
        np.testing.assert_allclose(np.sum(table, axis=1), 1.0)


def test_confusion_counts_rows_by_truth() -> None:
    chances = np.array([[0.9, 0.1], [0.2, 0.8], [0.6, 0.4], [0.3, 0.7]])
    found = Identified(chances, np.zeros((4, 2)), np.zeros(4), np.array([""] * 4))
    one = run.Accuracies((1.0,), ("a", "b"), np.array([0, 0, 1, 1]), {1.0: found}, {1.0: chances}, {})
    np.testing.assert_allclose(one.confusion(1.0), [[0.5, 0.5], [0.5, 0.5]])


def test_support_vectors_learn_what_is_plain() -> None:
    pytest.importorskip("sklearn")
    rng = np.random.default_rng(0)
    label = np.arange(120) % 3
    voltage = (1 + label[:, None]) * np.linspace(0, 1e-3, 400) + 1e-5 * rng.standard_normal((120, 400))
    touches = Touches(SETUP, voltage, label, np.ones(120), np.ones(120), np.ones(120))
    assert np.mean(support_vectors(touches, touches, 1.0) == label) == 1.0
    assert set(run.ELEVEN) <= set(thermal.materials()) and len(set(run.ELEVEN)) == 11


def test_progress_moves_to_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Stage by stage; what is measured is left out here."""
    few = np.zeros((1, 4))
    nothing = Touches(SETUP, few, np.zeros(1, int), np.ones(1), np.ones(1), np.ones(1))
    found = Identified(np.ones((1, 4)), np.ones((1, 2)), np.zeros(1), np.array([""]))
    for name, value in {
        "pressed": few[0],
        "draw": nothing,
        "draw_objects": nothing,
        "identify_all": found,
        "exact_posterior": np.ones((1, 4)),
        "support_vectors": np.zeros(1, int),
        "recurrent_net": {window: np.zeros(1, int) for window in WINDOWS},
    }.items():
        monkeypatch.setattr(run, name, lambda *given, value=value, **keywords: value)
    moved, totals = [], []

    @contextmanager
    def progress(total: float | None) -> Iterator[Callable[[str, float], None]]:
        totals.append(total)
        yield lambda doing, advance: moved.append(advance)

    measured(True, 0, progress)
    assert totals == [sum(moved)] and max(moved) == 1
