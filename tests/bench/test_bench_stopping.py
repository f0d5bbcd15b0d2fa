"""How soon an agent knows a material: fixed times, where the agent stops, posteriors of the same samples."""

from pathlib import Path

import numpy as np
import pytest

from thermograsp.agents.learning import HELD_OUT
from thermograsp.bench.stopping.measure import answers, declared, fitted, fixed, last_decisions
from thermograsp.bench.stopping.record import EXAMPLES
from thermograsp.bench.stopping.touches import RATE, Touched, setup_known
from thermograsp.bench.stopping.touches import touched as played

TIMES = np.array([0.0, 0.1, 0.2, 0.3])
TOUCH = np.array([0.05, 0.05])


def touched(
    shares: list[list[float]], declares: list[list[bool]], voltage: np.ndarray | None = None
) -> Touched:
    """Two episodes of the first of two materials. shares: (2, 4) of the first."""
    first = np.array(shares)
    samples = np.zeros((2, 30, 2)) if voltage is None else voltage
    return Touched(
        ("a", "b"),
        np.zeros(2, int),
        TOUCH,
        TIMES,
        np.stack([first, 1 - first], axis=2),
        np.array(declares),
        samples,
    )


NEVER = [[False] * 4] * 2


def test_who_waits_where_it_is_unsure_is_right_more_often_than_any_fixed_time_of_the_same_mean() -> None:
    """One episode is plain at once; the other is at first taken for the wrong one, and the agent waits."""
    touches = touched(
        [[0.5, 0.99, 0.99, 0.99], [0.5, 0.4, 0.99, 0.99]],
        [[False, True, True, True], [False, False, True, True]],
    )
    seconds, right = fixed(touches)
    np.testing.assert_allclose(seconds, [0.05, 0.15, 0.25])
    np.testing.assert_allclose(right, [0.5, 1.0, 1.0])
    mean, share = declared(touches)
    assert (mean, share) == (pytest.approx(0.1), 1.0)
    assert np.interp(mean, seconds, right) == pytest.approx(0.75)


def test_the_last_decision_ends_the_wait_and_the_first_declaration_counts() -> None:
    touches = touched([[0.5, 0.9, 0.1, 0.1], [0.5, 0.9, 0.1, 0.9]], [[False, True, False, True], [False] * 4])
    assert declared(touches) == (pytest.approx((0.05 + 0.25) / 2), 1.0)


def test_windows_count_from_each_touch() -> None:
    np.testing.assert_array_equal(
        last_decisions(touched([[0.5] * 4] * 2, NEVER), (0.05, 0.1, 0.16, 9.0)), [[1, 1, 2, 3]] * 2
    )


def test_the_fitted_posterior_knows_curves_by_their_spread() -> None:
    """Both materials have the same mean curve; the second's size varies ten times as much."""
    rng = np.random.default_rng(0)
    curve = np.sqrt(np.arange(1, 31) / RATE)[:, None]

    def drawn(count: int) -> Touched:
        truth = np.arange(count) % 2
        size = 1 + np.where(truth, 1.0, 0.1) * rng.standard_normal(count)
        volts = size[:, None, None] * curve + 1e-3 * rng.standard_normal((count, 30, 2))
        nothing = np.zeros((count, 4))
        return Touched(
            ("a", "b"), truth, np.zeros(count), TIMES, nothing[:, :, None], nothing.astype(bool), volts
        )

    new, old = drawn(400), drawn(400)
    right = fitted(new, old, (0.3,), 1e-3)[:, 0] == new.truth
    # Bayes: |x| / sd beyond which the wider of two normals of sd 1 and 10 is likelier
    edge = np.sqrt(2 * np.log(10) / (1 - 0.01))
    size = (new.voltage * curve).mean(axis=(1, 2)) / (curve**2).mean() - 1
    best = (abs(size) / 0.1 > edge) == new.truth
    assert right.mean() == pytest.approx(best.mean(), abs=0.03)


def test_a_material_without_an_example_is_never_named() -> None:
    touches = touched([[0.5] * 4] * 2, NEVER)
    with np.errstate(all="raise"):
        np.testing.assert_array_equal(fitted(touches, touches, (0.2,), 1e-5), [[0], [0]])


def test_the_shipped_agent_knows_its_materials_in_the_quick_run(written: tuple[Path, dict]) -> None:
    folder, document = written
    found = document["stopping"]
    for name in ("stopping.png", "stopping.svg"):
        assert str(folder / name) in document["figures"]
    assert found["right"]["agent"][2] >= 0.9  # after .3 s
    by_agent = found["declared"]
    assert (
        0 < by_agent["contact_s"] < 1 and by_agent["right"] >= by_agent["fixed_right"] - 0.1
    )  # two of twenty


def test_the_shipped_agent_knows_as_much_as_the_fitted_posterior_at_every_time() -> None:
    """Within 3 points, from a tenth of a second on; and it stops no later than it has to."""
    windows = 0.1, 0.2, 0.3, 0.5
    new, old = (played(200, first, 1.1, lambda doing, by: None) for first in (HELD_OUT, EXAMPLES))
    agent = np.take_along_axis(answers(new), last_decisions(new, windows), axis=1)
    posterior = fitted(new, old, windows, setup_known().noise)
    right = [(each == new.truth[:, None]).mean(axis=0) for each in (agent, posterior)]
    assert (right[0] > right[1] - 0.03).all() and right[0][0] > 0.93
    mean, share = declared(new)
    assert mean < 0.25 and share > 0.98
