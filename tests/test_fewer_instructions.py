"""Elements of arrays and loops, which become fewer instructions than numba makes of them, do what Python does."""

import gc
import weakref

import numpy as np
import pytest

from thermograsp.compiled import njit


@njit()
def counted(start, stop, step):
    total, last = 0.0, -100
    for i in range(start, stop, step):
        total, last = 1.5 * total + i, i
    for i in range(stop):
        total += i
    for i in range(start, stop):
        if i == start:
            continue
        total -= i
    return total, last


@pytest.mark.parametrize(
    "of", [(0, 5, 1), (5, 0, -1), (5, -3, -2), (3, 3, 1), (0, 7, 3), (1, -1, 1), (-4, 5, 4), (2, 9, 100)]
)
def test_a_loop_takes_the_same_numbers(of: tuple[int, int, int]) -> None:
    assert counted(*of) == counted.py_func(*of)


@njit()
def looked_at(array, i, j, k):
    part, row = array[i], array[i, j]
    array[i, j, k] += 2
    array[-1, 0, -1] = 7
    part[0, 0] += 1
    return (
        array[i, j, k],
        array[-i - 1, -1, 0],
        row[-1],
        part[-1, k],
        len(row),
        part.size,
        part.shape[1],
        row.ndim,
    )


def _arrays(kind: type) -> list[np.ndarray]:
    whole = np.arange(120).reshape(4, 5, 6).astype(kind)
    return [whole, whole[::2, 1:, ::-1], whole.transpose(2, 0, 1), np.asfortranarray(whole), whole[:, :3]]


@pytest.mark.parametrize("kind", [float, np.float32, int, np.int8, complex])
def test_an_element_is_numpys(kind: type) -> None:
    for given, expected in zip(_arrays(kind), _arrays(kind), strict=True):
        for index in ((0, 0, 0), (1, 2, 1), (-1, -2, -3), (np.int32(-1), np.uint8(1), np.uint64(2))):
            assert looked_at(given, *index) == looked_at.py_func(expected, *index)
            np.testing.assert_array_equal(given, expected)


@njit()
def noted(flags, chains, i):
    flags[i] = not flags[i]
    chains[i].gain = 2.0
    chains[i]["gain"] += chains[-1].gain
    return flags[i], chains[i].gain


def test_booleans_and_records_stay_as_they_are() -> None:
    flags, chains = np.array([True, False]), np.zeros(2, [("delay", "i8"), ("gain", "f8")])
    chains["gain"][1] = 5.0
    assert noted(flags, chains, 0) == (False, 7.0)
    assert noted(flags, chains, -1) == (True, 4.0)
    assert chains["gain"].tolist() == [7.0, 4.0] and chains["delay"].tolist() == [0, 0]


@njit()
def last_row(rows, count):
    kept = rows[0]
    for i in range(count):
        made = np.full((2, 3), float(i))
        kept = made[1]
    return kept


def test_a_part_keeps_its_array_alive_and_lets_it_go() -> None:
    rows = np.arange(6.0).reshape(2, 3)
    own, made = last_row(rows, 0), last_row(rows, 50)
    assert own.tolist() == [0.0, 1.0, 2.0] and made.tolist() == [49.0] * 3
    gone = weakref.ref(rows)
    del rows
    gc.collect()
    assert gone() is not None and own.tolist() == [0.0, 1.0, 2.0]
    del own
    gc.collect()
    assert gone() is None
