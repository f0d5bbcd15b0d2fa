"""Labels that keep apart, and colours in order."""

import numpy as np
import pytest

from thermograsp.figures.look import ordered_colors, spread_out


@pytest.mark.parametrize("seed", range(20))
def test_labels_keep_their_distance_their_order_and_the_axes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    wanted = rng.uniform(0, 10, 10)
    places = spread_out(wanted, 0.8, 0.0, 10.0)
    order = np.argsort(wanted)
    assert (np.diff(places[order]) >= 0.8 - 1e-12).all()
    assert places.min() >= -1e-12 and places.max() <= 10 + 1e-12


def test_labels_that_have_room_stay() -> None:
    np.testing.assert_allclose(spread_out([5.0, 1.0, 3.0], 0.5, 0.0, 10.0), [5.0, 1.0, 3.0])


def test_two_labels_at_one_place_part_evenly() -> None:
    np.testing.assert_allclose(spread_out([2.0, 2.0], 1.0, 0.0, 10.0), [1.5, 2.5])


def test_colours_differ_and_darken_evenly() -> None:
    """A perceptually uniform map: the lightness falls from each material to the next."""
    colors = ordered_colors(10)
    assert len(set(colors)) == 10
    luminance = [np.dot([int(c[i : i + 2], 16) for i in (1, 3, 5)], [0.299, 0.587, 0.114]) for c in colors]
    assert (np.diff(luminance) < 0).all()
    assert ordered_colors(1) == [colors[-1]]
