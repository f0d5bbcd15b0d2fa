import numpy as np
import pytest
from scipy.integrate import solve_ivp

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.readout.kernel import chain_numbers, measure_rows
from thermograsp.thermal.readout.signal import (
    ADS1115,
    IDEAL,
    SIGNAL_CHAINS,
    SignalChain,
    SignalState,
    measure,
    saturated,
    settled,
)

SEEBECK, DT = 1e-3, 0.01


def run(chain: SignalChain, drop: np.ndarray, start: float = 0.0, seed: int = 0) -> np.ndarray:
    noise = np.random.default_rng(seed).standard_normal(drop.shape)
    return measure(chain, settled(np.full(len(drop), start), SEEBECK), drop, SEEBECK, DT, noise)[1]


def test_ideal_chain_reports_the_seebeck_voltage() -> None:
    drop = np.linspace(-3, 9, 24).reshape(2, 12)
    np.testing.assert_allclose(run(IDEAL, drop), 1e-3 * drop, rtol=1e-15)
    assert not saturated(IDEAL, run(IDEAL, drop)).any()


def test_ads1115_steps_are_those_of_the_datasheet() -> None:
    """TI: 7.8125 uV a step at +-0.256 V, codes -32768 .. 32767."""
    assert ADS1115.resolution == pytest.approx(7.8125e-6)
    assert ADS1115.limits == (-0.256, pytest.approx(0.256 - 7.8125e-6))
    codes = run(ADS1115, np.linspace(0, 5, 1000)[None, :]) / ADS1115.resolution
    np.testing.assert_allclose(codes, np.rint(codes), atol=1e-9)


def test_quantisation_error_is_uniform_over_one_step() -> None:
    chain = SignalChain(span=0.256, bits=16)
    drop = np.linspace(0, 1, 20_001)[None, :]
    error = (run(chain, drop) - 1e-3 * drop) / chain.resolution
    assert np.abs(error).max() <= 0.5 + 1e-9
    assert error.std() == pytest.approx(1 / np.sqrt(12), rel=0.01)


def test_saturation_is_reported_at_the_limits() -> None:
    chain = SignalChain(gain=100.0, span=0.256, bits=16)
    volts = np.array([[-3e-3, -2.56e-3, 0.0, 2.5e-3, 2.56e-3, 4e-3]])
    reported = run(chain, volts / SEEBECK)
    assert reported.min() == chain.limits[0] == -2.56e-3
    assert reported.max() == chain.limits[1]
    assert saturated(chain, reported).tolist() == [[True, True, False, False, True, True]]


def test_low_pass_is_exact_for_a_ramp_and_settles() -> None:
    """Against the differential equation, from rest into a ramp of one sample and a plateau."""
    chain = SignalChain(bandwidth=30.0)
    drop = np.ones((1, 20))
    reported = run(chain, drop)[0] / SEEBECK
    lag = 1 / (2 * np.pi * 30)
    times = np.arange(1, 21) * DT
    exact = solve_ivp(
        lambda t, y: (min(t / DT, 1.0) - y) / lag,
        (0, 0.2),
        [0.0],
        t_eval=times,
        rtol=1e-10,
        atol=1e-12,
        max_step=DT / 4,
    ).y[0]
    np.testing.assert_allclose(reported, exact, atol=1e-7)
    assert reported[-1] == pytest.approx(1, abs=1e-10)


def test_settled_state_and_sample_spacing_do_not_matter_for_a_constant() -> None:
    np.testing.assert_allclose(
        run(SignalChain(bandwidth=5.0), np.full((3, 7), 2.0), start=2.0), 2e-3, rtol=1e-12
    )


def test_noise_gain_error_and_offset() -> None:
    reported = run(
        SignalChain(noise=7.8e-6, offset=2e-5, gain_error=0.01), np.full((50, 400), 3.0), start=3.0
    )
    assert reported.std() == pytest.approx(7.8e-6 * 1.01, rel=0.02)
    assert reported.mean() == pytest.approx((3e-3 + 2e-5) * 1.01, abs=4 * 7.8e-6 / np.sqrt(20_000))


def test_gain_is_divided_out_and_refines_the_steps() -> None:
    chain = SignalChain(gain=50.0, span=0.256, bits=16)
    assert chain.resolution == pytest.approx(7.8125e-6 / 50)
    np.testing.assert_allclose(run(chain, np.full((1, 3), 2.0), 2.0), 2e-3, atol=chain.resolution)


def test_rows_and_chunks_do_not_matter() -> None:
    rng = np.random.default_rng(3)
    drop, noise, seebeck = (
        rng.uniform(0, 5, (33, 6)),
        rng.standard_normal((33, 6)),
        rng.uniform(5e-4, 1e-3, 33),
    )
    state, whole = measure(ADS1115, settled(drop[:, 0], seebeck), drop, seebeck, DT, noise)
    for row in range(33):
        one = slice(row, row + 1)
        part = settled(drop[one, 0], seebeck[one])
        part, first = measure(ADS1115, part, drop[one, :2], seebeck[one], DT, noise[one, :2])
        part, rest = measure(ADS1115, part, drop[one, 2:], seebeck[one], DT, noise[one, 2:])
        assert np.concatenate([first, rest], axis=1).tolist() == whole[one].tolist()
        assert part.filtered[0] == state.filtered[row]


@pytest.mark.parametrize(
    "wrong",
    [
        {"gain": 0.0},
        {"bandwidth": 0.0},
        {"noise": -1.0},
        {"bits": 1, "span": 1.0},
        {"bits": 16},
        {"offset": np.nan},
    ],
)
def test_refuses_impossible_chains(wrong: dict[str, float]) -> None:
    with pytest.raises(InvalidValueError, match="signal chain"):
        SignalChain(**wrong)  # pyright: ignore[reportArgumentType]


def test_presets_by_name() -> None:
    assert SIGNAL_CHAINS["ads1115"] is ADS1115 and SIGNAL_CHAINS["ideal"] is IDEAL


@pytest.mark.parametrize(
    "chain", [IDEAL, ADS1115, SignalChain(gain=100.0, bandwidth=5.0, span=2.048, bits=12)]
)
def test_compiled_electronics_are_the_same(chain):
    rng = np.random.default_rng(0)
    drop, noise = rng.normal(0, 8, (7, 40, 2)), rng.standard_normal((7, 40, 2))
    filtered, last = rng.normal(0, 1e-3, (7, 2)), rng.normal(0, 1e-3, (7, 2))
    expected = np.empty_like(drop)
    for tip in range(2):
        begun = SignalState(filtered[:, tip], last[:, tip])
        expected[:, :, tip] = measure(chain, begun, drop[:, :, tip], 1e-3, 0.01, noise[:, :, tip])[1]
    voltage = np.empty_like(drop)
    for samples in (slice(0, 13), slice(13, 40)):
        part = np.ascontiguousarray(drop[:, samples])
        some = np.empty_like(part)
        chains, late = np.repeat(chain_numbers(chain, 1e-3, 0.01), 7), np.zeros((7, 0, 2))
        measure_rows(chains, filtered, last, late, part, noise[:, samples].copy(), some)
        voltage[:, samples] = some
    assert np.abs(voltage - expected).max() <= 1e-15 + 1e-12 * np.abs(expected).max()
