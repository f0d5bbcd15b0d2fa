"""The closed forms against their series summed term by term, and the paper's misprints beside them."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import erfc

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.numerics.laplace import invert
from thermograsp.thermal.rungs.closed_form import drop_o_mode, drop_t_mode

GAMMAS = [-0.999999, -0.9, -0.3, 0.0, 0.5, 0.95, 0.999999]
FOURIER = np.concatenate(([1e-6, 1e-3], np.geomspace(0.02, 2e4, 25)))


def series_t(fourier: float, gamma: float) -> float:
    terms, root = 8 + int(6.5 * math.sqrt(fourier)), math.sqrt(fourier)
    return (
        (1 - gamma)
        / 2
        * math.fsum((-gamma) ** n * (math.erfc(n / root) - math.erfc((n + 1) / root)) for n in range(terms))
    )


def series_o(fourier: float, gamma: float) -> float:
    terms, root = 8 + int(6.5 * math.sqrt(fourier)), math.sqrt(fourier)
    return 1 - (1 + gamma) * math.fsum((-gamma) ** n * math.erfc((n + 0.5) / root) for n in range(terms))


def printed_equation_1(fourier: float, gamma: float) -> float:
    """Eq. (1) of Wu et al. 2012 as scanned, O mode."""
    terms, root = 8 + int(6.5 * math.sqrt(fourier)), math.sqrt(fourier)
    tail = math.fsum((-1) ** n * gamma**n * math.erfc((2 * n + 1) / (2 * root)) for n in range(terms))
    return 1 - ((1 - gamma) * math.erfc(-0.5 / root) + gamma * (1 + gamma) * tail)


def printed_erfc(u: float) -> float:
    """The scan's complementary error function, 2/pi where 2/sqrt(pi) belongs."""
    return 1 - 2 / math.pi * quad(lambda x: math.exp(-(x**2)), 0, u)[0]


@pytest.mark.parametrize("gamma", GAMMAS)
def test_both_modes_agree_with_their_series(gamma: float) -> None:
    np.testing.assert_allclose(
        drop_t_mode(FOURIER, gamma), [series_t(f, gamma) for f in FOURIER], rtol=0, atol=1e-11
    )
    np.testing.assert_allclose(
        drop_o_mode(FOURIER, gamma), [series_o(f, gamma) for f in FOURIER], rtol=0, atol=1e-11
    )


@pytest.mark.parametrize("gamma", GAMMAS)
def test_limits_in_time(gamma: float) -> None:
    """A perfect contact jumps; late the object draws dT b_M / sqrt(pi t) through the layer's resistance."""
    for start in (0.0, 1e-300):
        assert float(drop_t_mode(start, gamma)) == pytest.approx((1 - gamma) / 2, abs=1e-15)
        assert float(drop_o_mode(start, gamma)) == 1
    ratio = (1 - gamma) / (1 + gamma)
    fourier = 1e8 * max(1.0, ratio**2)
    for drop in (drop_t_mode, drop_o_mode):
        assert float(drop(fourier, gamma)) == pytest.approx(ratio / np.sqrt(np.pi * fourier), rel=1e-3)


@pytest.mark.parametrize("gamma", [-0.9, -0.3, 0.5, 0.95])
@pytest.mark.parametrize("t", [0.2, 1.0, 4.0, 20.0])
def test_transforms_derived_from_the_heat_equation(gamma: float, t: float) -> None:
    """Element of impedance tanh(q)/q, object of impedance 1/(ratio q), q = sqrt(s), in units of the element's."""
    ratio = (1 - gamma) / (1 + gamma)

    def in_t_mode(s: np.ndarray) -> np.ndarray:
        q = np.sqrt(s)
        return np.tanh(q) / (np.tanh(q) + 1 / ratio) / s

    def in_o_mode(s: np.ndarray) -> np.ndarray:
        q = np.sqrt(s)
        return (1 - 1 / (np.cosh(q) + ratio * np.sinh(q))) / s

    assert float(drop_t_mode(t, gamma)) == pytest.approx(float(invert(in_t_mode, t)), abs=1e-10)
    assert float(drop_o_mode(t, gamma)) == pytest.approx(float(invert(in_o_mode, t)), abs=1e-10)


@pytest.mark.parametrize("gamma", [-0.9, -0.3, 0.5, 0.95])
def test_equation_1_as_printed_is_no_solution(gamma: float) -> None:
    """At the first moment the drop must be the whole difference; the printed one starts at 1 - 2 (1 - gamma)."""
    assert printed_equation_1(1e-12, gamma) == pytest.approx(1 - 2 * (1 - gamma))
    assert float(drop_o_mode(1e-12, gamma)) == pytest.approx(1)
    wrong = max(abs(printed_equation_1(f, gamma) - float(drop_o_mode(f, gamma))) for f in (0.2, 1.0, 4.0))
    assert wrong > 0.04


def test_the_scans_erfc_is_no_error_function() -> None:
    """An erfc must vanish far out; with 2/pi it stays at 1 - 1/sqrt(pi), so the T mode would never start at rest."""
    assert erfc(8.0) < 1e-20
    assert printed_erfc(8.0) == pytest.approx(1 - 1 / math.sqrt(math.pi))


def test_any_shape_and_bad_input() -> None:
    fourier = np.array([[0.0, 0.5], [3.0, 1e3]])
    assert drop_t_mode(fourier, 0.3).shape == (2, 2)
    with pytest.raises(InvalidValueError, match="gamma"):
        drop_o_mode(1.0, 1.5)
    with pytest.raises(InvalidValueError, match="Fourier"):
        drop_t_mode(-1.0, 0.5)
    with pytest.raises(InvalidValueError, match="gamma"):
        drop_t_mode(1.0, float("nan"))
