"""Which places an object remembers, and what is lost of its field with one that is forgotten."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.thermal import material, sensor
from thermograsp.touch.contacts import AREA, CLOSED, COLUMNS, CONDUCTANCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat
from thermograsp.touch.heat.places import MOST_PLACES, BodyField
from thermograsp.touch.heat.places.forgetting import forgotten
from thermograsp.touch.scene import BodyShape, PadPlace

SIZE = np.array([0.02, 0.06, 0.06])
STACK = sensor("seed")


def joined(made: str = "glass") -> JoinedHeat:
    """One bare sensor on a box."""
    pad = PadPlace("tip", 0, (), np.zeros(3), np.eye(3), np.full(2, 0.02), STACK, 36.0)
    shape = BodyShape("box", 0, (), material(made), 24.0, SIZE, np.zeros(3), np.eye(3), SIZE, 0.01)
    return JoinedHeat((pad,), (), (shape,), worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=24.0)


def touch(y: float, z: float = 0.0, conductance: float = 3e3) -> np.ndarray:
    """Of the whole face, at mm."""
    touches, area = np.zeros((1, 1, 2, COLUMNS)), STACK.face_area
    one = touches[0, 0, 0]
    if conductance:
        one[[CONDUCTANCE, AREA, LENGTH]] = conductance * area, area, area * STACK.width
        one[CLOSED] = 1.0
    one[NORMAL], one[PLACE : PLACE + 3] = 1.0, (-SIZE[0] / 2, y / 1e3, z / 1e3)
    return touches


def felt(heat: JoinedHeat) -> np.ndarray:
    """K, while the sensor is held, slides over 24 mm, is let go and comes back."""
    way = [touch(-12)] * 80 + [touch(y) for y in np.linspace(-12, 12, 240)]
    way += [touch(0, conductance=0.0)] * 20 + [touch(-12)] * 50
    found = []
    for each in way:
        heat.advance(each, 1)
        found.append(heat.drop[0, 0])
    return np.array(found)


def test_a_field_stays_where_a_sensor_slides_away_and_returns(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if all places were remembered; by four it is not."""
    found = {}
    for most in (4, 6, MOST_PLACES, 100):
        monkeypatch.setattr("thermograsp.touch.heat.joined.MOST_PLACES", most)
        heat = joined()
        found[most] = felt(heat)
        assert len(heat._fields[0][0].places) == min(most + 1, 12)
        balance = heat.balance(0)
        assert balance.objects == pytest.approx(balance.given.sum(axis=0), rel=1e-9)
    errors = {most: np.abs(each - found[100]).max() for most, each in found.items()}
    assert errors[4] < 0.4 and errors[6] < 0.15 and errors[MOST_PLACES] < 0.01


def warmed(places: int) -> tuple[JoinedHeat, BodyField, np.ndarray]:
    """After touches of so many places for ever shorter times."""
    heat = joined()
    for n in range(places):
        for _ in range(4 * (places - n)):
            heat.advance(touch(-12.0 + 6 * (n % 5), -6.0 + 6 * (n // 5)), 1)
    field = heat._fields[0][0]
    return heat, field, heat._x[0, 0, : len(field.rates)]


def test_the_place_is_forgotten_whose_loss_is_least() -> None:
    """Beside what is left of the states by least squares without each place."""
    heat, field, states = warmed(7)
    patterns, lost = heat._level.patterns, []
    for n in range(6):
        rest, left = np.delete(np.arange(7), n), 0.0
        for rate in np.unique(field.rates[1:]):
            at = 1 + np.flatnonzero(field.rates[1:] == rate)
            ports = np.concatenate([field.port(int(m), patterns)[at] for m in rest], axis=1)
            answer = np.linalg.lstsq(ports, states[at], rcond=1e-4)[0]
            left += np.exp(-rate) * np.sum((states[at] - ports @ answer) ** 2)
        lost.append(left)
    assert forgotten(field, patterns, states, range(6), 1) == [int(np.argmin(lost))]
    assert forgotten(field, patterns, states, [1, 3], 0) == []
    both = forgotten(field, patterns, states, [1, 3], 2)
    assert sorted(both) == [1, 3]


def test_of_places_that_are_as_good_the_oldest_goes() -> None:
    """And all where nothing has flowed."""
    _, field, states = warmed(5)
    found = forgotten(field, 3, np.zeros(len(states)), [1, 2, 3], 2)
    assert found == [1, 2, 3]


def test_places_of_which_nothing_is_felt_are_forgotten() -> None:
    """On aluminium soon, where a place that is forgotten changes the drop by less than it is allowed to."""
    heat, kept = joined("aluminium"), joined("aluminium")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("thermograsp.touch.heat.places.forgetting._UNFELT", 0.0)
        for n in range(8):
            for _ in range(200):
                kept.advance(touch(-12.0 + 6 * (n % 5)), 1)
        assert len(kept._fields[0][0].places) == 5
    for n in range(8):
        for _ in range(200):
            heat.advance(touch(-12.0 + 6 * (n % 5)), 1)
    assert len(heat._fields[0][0].places) < 4
    np.testing.assert_allclose(heat.drop, kept.drop, rtol=0, atol=2e-3)


def test_a_place_left_a_while_ago_has_the_even_flow_alone() -> None:
    heat, field, _ = warmed(6)
    patterns = heat._level.patterns
    assert field.whole == (False, False, False, False, True, True)
    for n, whole in enumerate(field.whole):
        assert field.port(n, patterns)[:, 0].any() and field.port(n, patterns)[:, 1:].any() == whole
    heat.advance(touch(-12.0, -6.0), 1)  # back at the first
    assert heat._fields[0][0].whole == (True, False, False, False, False, True)
