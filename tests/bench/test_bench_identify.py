"""The comparison of identifiers, from the quick run of all benchmarks."""

from pathlib import Path

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.bench import identification_run as run
from thermograsp.bench.identification import SETUP, Identified
from thermograsp.bench.rivals import support_vectors


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
    from thermograsp.bench.identification import Touches

    rng = np.random.default_rng(0)
    label = np.arange(120) % 3
    voltage = (1 + label[:, None]) * np.linspace(0, 1e-3, 400) + 1e-5 * rng.standard_normal((120, 400))
    touches = Touches(SETUP, voltage, label, np.ones(120), np.ones(120), np.ones(120))
    assert np.mean(support_vectors(touches, touches, 1.0) == label) == 1.0
    assert set(run.ELEVEN) <= set(thermal.materials()) and len(set(run.ELEVEN)) == 11
