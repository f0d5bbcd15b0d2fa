import numpy as np
import pytest
from scipy.special import erfc, erfcx

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.numerics.laplace import invert

T = np.geomspace(1e-3, 1e3, 13)
PAIRS = {  # Abramowitz & Stegun, table 29.3
    "step": (lambda s: 1 / s, np.ones_like),
    "decay": (lambda s: 1 / (s + 1), lambda t: np.exp(-t)),
    "root": (lambda s: s**-1.5, lambda t: 2 * np.sqrt(t / np.pi)),
    "erfc": (lambda s: np.exp(-np.sqrt(s)) / s, lambda t: erfc(0.5 / np.sqrt(t))),
    "erfcx": (lambda s: 1 / (np.sqrt(s) * (np.sqrt(s) + 1)), lambda t: erfcx(np.sqrt(t))),
}


@pytest.mark.parametrize("name", PAIRS)
def test_known_pairs_to_round_off(name: str) -> None:
    transform, original = PAIRS[name]
    exact = original(T)
    np.testing.assert_allclose(invert(transform, T), exact, rtol=1e-12, atol=2e-14)


@pytest.mark.parametrize("name", PAIRS)
def test_error_falls_by_more_than_a_digit_a_node(name: str) -> None:
    transform, original = PAIRS[name]
    exact = original(T)
    errors = [
        np.max(np.abs(invert(transform, T, nodes) - exact) / np.max(np.abs(exact))) for nodes in (4, 7, 10)
    ]
    slope = np.polyfit([4, 7, 10], np.log10(errors), 1)[0]
    assert -1.5 < slope < -1.05


def test_trailing_axes_and_shapes_of_t() -> None:
    rates = np.array([0.5, 1.0, 2.0])
    t = T.reshape(-1, 1)
    values = invert(lambda s: 1 / (s[..., None] + rates), t)
    assert values.shape == (13, 1, 3)
    np.testing.assert_allclose(values, np.exp(-t[..., None] * rates), atol=1e-13)
    assert invert(lambda s: 1 / s, 2.0).shape == ()


@pytest.mark.parametrize("t", [0.0, -1.0, np.nan, np.inf])
def test_refuses_times_without_an_inverse(t: float) -> None:
    with pytest.raises(InvalidValueError, match="got"):
        invert(lambda s: 1 / s, t)


def test_refuses_a_single_node() -> None:
    with pytest.raises(InvalidValueError, match="nodes"):
        invert(lambda s: 1 / s, 1.0, nodes=1)
