"""The step of joined fields: that of thermal/network/coupling.py."""

import numpy as np
import pytest

from thermograsp.compiled import njit
from thermograsp.thermal.kernels import Tip
from thermograsp.thermal.network import propagator
from thermograsp.thermal.network import step as reference
from thermograsp.thermal.numerics import ThermalNetwork
from thermograsp.touch.heat.places import BodyField, Place
from thermograsp.touch.heat.step import room_of, room_size, step
from thermograsp.touch.heat.systems import SystemPool

DT, OBJECTS = 0.01, 2


@njit(borrows=True)
def stepped(
    at, integers, ports, grams, paces, patterns, states, stride, held, resistance, difference, numbers, flow
):
    room = room_of(numbers, len(resistance), patterns)
    for c in range(len(flow)):
        for p in range(patterns):
            room.resistance[c * patterns + p], room.difference[c * patterns + p] = resistance[c], 0.0
        room.difference[c * patterns] = difference[c]
    lost = step(
        DT, at, integers, ports, grams, paces, patterns, states, 0, stride, held, room, False, room.flow
    )
    for c in range(len(flow)):
        flow[c] = room.flow[c * patterns]
    return lost


def a_tip(rng: np.random.Generator, patterns: int) -> Tip:
    rates = np.sort(rng.choice([0.3, 5.0, 40.0, 900.0], 9))
    side = ThermalNetwork(rates, rng.normal(size=(9, patterns)))
    return Tip(1e-4, np.eye(patterns), np.ones(patterns), np.ones(3), side)


@pytest.mark.parametrize("patterns", [3, 4, 5])
@pytest.mark.parametrize(
    "pairs",
    [((0, 0),), ((0, 0), (1, 0), (2, 0)), ((0, 0), (0, 1), (1, 1)), ((0, 0), (1, 4), (2, 1), (1, 1))],
    ids=["one", "three on an object", "one on two", "on one another"],
)
def test_it_is_that_of_the_whole_system(pairs: tuple, patterns: int) -> None:
    """Any contacts, an open one nearly (1e-9 W/K) among them: states, flows and what the air takes."""
    rng = np.random.default_rng(3)
    tips = [a_tip(rng, patterns) for _ in range(3)]
    faces = [rng.normal(size=(9, patterns)) for _ in range(3)]
    fields, current = {}, {}
    for o in sorted({t for _, t in pairs if t < OBJECTS}):
        on = [f for f, t in pairs if t == o]
        current |= {(f, o): n for n, f in enumerate(on)}
        rates = np.concatenate(([1e-3], np.sort(rng.choice([1e-3, 0.3, 40.0], 11))))
        loss = np.append(3.0, np.zeros(11)) * rates
        places = tuple(Place(0, (0.0, 0.0), f) for f in on)
        fields[o] = BodyField(
            places,
            (True,) * len(places),
            rates,
            rng.normal(size=(12, patterns * len(on))),
            loss / rates,
            loss,
        )
    pool = SystemPool(tips, faces, OBJECTS, patterns, DT)
    number = pool.number(pairs, fields, current)
    stride, count = 12, OBJECTS + 3
    states = rng.normal(size=count * stride)
    conductance, difference = 10.0 ** rng.uniform(-3, 2, len(pairs)), rng.normal(size=len(pairs))
    conductance[0] = 1e-9
    # all states of one system
    rates, ports = np.zeros(count * stride), np.zeros((count * stride, patterns * len(pairs)))
    for o, field in fields.items():
        rates[o * stride : o * stride + 12] = field.rates
    for f in range(3):
        rates[(OBJECTS + f) * stride :][:9] = tips[f].side.rates
    for c, (f, t) in enumerate(pairs):
        seen = slice(c * patterns, (c + 1) * patterns)
        ports[(OBJECTS + f) * stride :][:9, seen] -= tips[f].side.ports
        if t < OBJECTS:
            ports[t * stride :][:12, seen] += fields[t].port(current[f, t], patterns)
        else:
            ports[t * stride :][:9, seen] += faces[t - OBJECTS]
    drive = np.zeros((1, ports.shape[1]))
    drive[0, ::patterns] = difference
    after, flow = reference(
        propagator(rates, ports, DT), states[None], np.repeat(conductance, patterns)[None], drive
    )
    held, now, found = np.full(OBJECTS, 3.0), states.copy(), np.zeros(len(pairs))
    lost = stepped(
        *(
            pool.starts[number],
            pool.integers,
            pool.ports,
            pool.grams,
            pool.paces.ravel(),
            patterns,
            now,
            stride,
        ),
        *(held, 1 / conductance, difference, np.zeros(room_size(len(pairs), patterns, pool.rates)), found),
    )
    touched = [t for t in range(count) if t in fields or any(t in (OBJECTS + f, g) for f, g in pairs)]
    for t in touched:
        of = slice(t * stride, (t + 1) * stride)
        np.testing.assert_allclose(now[of], after[0, of], rtol=0, atol=1e-9 * np.abs(states).max())
    np.testing.assert_allclose(found, flow[0, ::patterns], rtol=1e-9, atol=1e-9)
    # the heat of the mean's state: what flowed in and is not there any more
    gone = 0.0
    for o in fields:
        went_in = (ports[o * stride] * flow[0]).sum()
        gone += 3.0 * (states[o * stride] - now[o * stride] + DT * went_in) / DT
    assert lost == pytest.approx(gone, rel=1e-9, abs=1e-9)
