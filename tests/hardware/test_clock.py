"""The device's clock on the host's: offset and drift under delays of every kind."""

import numpy as np
import pytest

from thermograsp.hardware.protocol.clock import ClockFit


def fitted(
    drift: float, delays: np.ndarray, rate: float = 100.0, offset: float = 12.5
) -> tuple[ClockFit, np.ndarray]:
    device = np.arange(len(delays)) / rate
    true = offset + device * (1 + drift)
    fit = ClockFit()
    for at, arrival in zip(device, true + delays, strict=True):
        fit.add(at, arrival)
    errors = np.array([fit.host_time(at) for at in device]) - true
    return fit, errors


@pytest.mark.parametrize("drift", [0.0, 30e-6, -2021e-6])
def test_without_delays_it_is_exact(drift: float) -> None:
    fit, errors = fitted(drift, np.zeros(3000))
    assert fit.drift == pytest.approx(drift, abs=1e-9)
    assert abs(errors).max() < 1e-8


@pytest.mark.parametrize("drift", [30e-6, 2021e-6])
def test_delays_are_only_ever_above_it(drift: float) -> None:
    """Exponential delays of 1 ms, a 16 ms timer on some, and a second of stall: the promptest bytes count."""
    rng = np.random.default_rng(3)
    delays = rng.exponential(1e-3, 6000) + rng.uniform(0, 16e-3, 6000) * (rng.random(6000) < 0.3)
    delays[2000:2100] += np.linspace(1.0, 0.0, 100)
    fit, errors = fitted(drift, delays)
    assert fit.drift == pytest.approx(drift, abs=10e-6)
    assert abs(errors[-3000:]).max() < 0.3e-3


def test_a_start_of_late_messages_is_forgotten() -> None:
    delays = np.full(20_000, 1e-4)
    delays[:50] = 0.5
    fit, errors = fitted(5e-5, delays)
    assert abs(errors[-6000:] - 1e-4).max() < 2e-5
    assert fit.offset == pytest.approx(12.5, abs=1e-2)
