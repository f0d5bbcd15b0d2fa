"""Simulated touches of known objects under the noise of an ADS1115, on which methods of identification are scored.

The unknowns are drawn from the identifier's own priors: contact conductance log-uniform, temperatures normal, offset
normal; noise and rounding are the converter's. Curves of named materials come from stepping the networks of
thermal.press in 2 ms and from the signal chain's own filter; the identifier has its curves from
impedances, and interpolates between them. N: touches, n: samples.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from thermograsp import thermal
from thermograsp.thermal.curves import UnitCurves
from thermograsp.thermal.identification import prior as identify_prior

RATE = 100.0  # Hz
WINDOWS = (0.5, 1.0, 2.0, 4.0)  # s of contact
SETUP = thermal.TouchSetup(model_error=0.0, tolerance=0.0, sensor_temperature=(36.0, 0.0))
"""Ten seed materials' task: conductance 1e3 .. 2e4, object 24 +- 3 °C, thermostat 36 °C, the model exact."""

_NODES = 64  # of log conductance, between which curves are interpolated by splines
_FINE = 5  # steps of thermal.press in a sample's period
_TOLERANCE = 0.002  # K of 12 K


@dataclass(frozen=True, slots=True)
class Touches:
    """Simulated touches of known materials. voltage: (N, n) V at samples 10 ms, 20 ms, ... after the touch. label:
    (N,), which material. effusivity: (N,) W s^0.5/(m2 K). conductance: (N,) W/(m2 K). difference: (N,) K. setup: what
    was known beforehand."""

    setup: thermal.TouchSetup
    voltage: np.ndarray
    label: np.ndarray
    effusivity: np.ndarray
    conductance: np.ndarray
    difference: np.ndarray

    def __len__(self) -> int:
        return len(self.label)


def times(seconds: float = WINDOWS[-1]) -> np.ndarray:
    """(n,) s of the samples."""
    return np.arange(1, round(seconds * RATE) + 1) / RATE


def pressed(setup: thermal.TouchSetup, material: str) -> np.ndarray:
    """(H, n) drop per K of difference behind the low-pass at conductance_nodes(), stepped by thermal.press."""
    conductances = conductance_nodes(setup).tolist()
    period, seconds = 1 / RATE / _FINE, float(times()[-1])
    # One network for all, chosen where the flux is least even over the patch.
    rung = thermal.press(material, conductance=max(conductances), tolerance=_TOLERANCE, seconds=seconds).rung
    drops = [
        thermal.press(material, conductance=h, seconds=seconds, dt=period, rung=rung).temperature_drop
        for h in conductances
    ]
    amplifier = thermal.SignalChain(bandwidth=setup.chain.bandwidth)
    start = thermal.settled(np.zeros(len(drops)), 1.0)
    drop = np.array(drops)[:, 1:] / 12.0
    _, seen = thermal.measure(amplifier, start, drop, 1.0, period, np.zeros_like(drop))
    return seen[:, _FINE - 1 :: _FINE]


def conductance_nodes(setup: thermal.TouchSetup) -> np.ndarray:
    """(H,) W/(m2 K), evenly spaced in their logarithm."""
    return np.geomspace(*setup.conductance, _NODES)


def draw(
    rng: np.random.Generator,
    setup: thermal.TouchSetup,
    count: int,
    materials: Sequence[str],
    curves: np.ndarray,
) -> Touches:
    """Touches of the materials in turn. curves: (M, H, n) of pressed()."""
    label = np.arange(count) % len(materials)
    conductance = _conductances(rng, setup, count)
    nodes = np.log(conductance_nodes(setup))
    between = [CubicSpline(nodes, one) for one in curves]
    unit = np.array(
        [between[k](np.log(h)) for k, h in zip(label.tolist(), conductance.tolist(), strict=True)]
    )
    effusivity = np.array([thermal.material(materials[k]).effusivity for k in label.tolist()])
    return _measured(rng, setup, unit, label, effusivity, conductance)


def draw_objects(rng: np.random.Generator, setup: thermal.TouchSetup, count: int) -> Touches:
    """Touches of objects from the identifier's prior of any object."""
    unit_of = UnitCurves(setup.geometry(thermal.material("glass")), times(), setup.chain.bandwidth)
    objects = [identify_prior.draw_object(rng) for _ in range(count)]
    conductance = _conductances(rng, setup, count)
    unit = np.array(
        [
            unit_of.on(thermal.Material("object", *one, 1.0))(np.array([h]))[0]
            for one, h in zip(objects, conductance.tolist(), strict=True)
        ]
    )
    effusivity = np.sqrt(np.prod(objects, axis=1))
    return _measured(rng, setup, unit, np.zeros(count, int), effusivity, conductance)


def _conductances(rng: np.random.Generator, setup: thermal.TouchSetup, count: int) -> np.ndarray:
    low, high = setup.conductance
    return np.exp(rng.uniform(np.log(low), np.log(high), count))


def _measured(
    rng: np.random.Generator,
    setup: thermal.TouchSetup,
    unit: np.ndarray,
    label: np.ndarray,
    effusivity: np.ndarray,
    conductance: np.ndarray,
) -> Touches:
    difference = rng.normal(*setup.difference, len(unit))
    offset = rng.normal(0.0, setup.chain.offset, (len(unit), 1))
    assert isinstance(setup.stack, thermal.SensorStack)
    volts = setup.stack.seebeck * difference[:, None] * unit + offset
    chain = replace(setup.chain, offset=0.0, gain_error=0.0, bandwidth=np.inf)
    start = thermal.settled(volts[:, 0], 1.0)
    _, voltage = thermal.measure(chain, start, volts, 1.0, 1 / RATE, rng.standard_normal(volts.shape))
    return Touches(setup, voltage, label, effusivity, conductance, difference)


@dataclass(frozen=True, slots=True)
class Identified:
    """What identification says of N touches after one contact time: probability (N, M), interval (N, 2) of effusivity,
    seconds (N,) of CPU for each posterior, verdict (N,)."""

    probability: np.ndarray
    interval: np.ndarray
    seconds: np.ndarray
    verdict: np.ndarray


def identify_all(touches: Touches, seconds: float, materials: Sequence[str]) -> Identified:
    """Every touch with thermal.identify, from its first `seconds`."""
    t = times(seconds)
    found, spent = [], []
    identifier = thermal.Identifier(touches.setup, materials, touch=0.0)
    for voltage in touches.voltage[:, : len(t)]:
        identifier.reset()
        begun = time.process_time()
        found.append(identifier.update(t, voltage))
        spent.append(time.process_time() - begun)
    return Identified(
        np.array([one.probability for one in found]),
        np.array([one.effusivity.interval() for one in found]),
        np.array(spent),
        np.array([str(one.verdict) for one in found]),
    )
