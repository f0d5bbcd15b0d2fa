"""Error classes and the shared checks of numbers."""

import math

import numpy as np
import pytest

from thermograsp.errors import (
    InvalidValueError,
    MeshError,
    MissingDependencyError,
    SimulationError,
    ThermograspError,
    UnknownNameError,
    WriteError,
    celsius,
    distinct_text,
    finite,
    install,
    length,
    non_negative,
    numbers,
    positive,
    unknown_name,
    whole_number,
    within,
)


@pytest.mark.parametrize(
    ("ours", "builtin"),
    [
        (InvalidValueError, ValueError),
        (UnknownNameError, LookupError),
        (MissingDependencyError, ImportError),
        (MeshError, ValueError),
        (SimulationError, RuntimeError),
        (WriteError, OSError),
    ],
)
def test_errors_share_a_base_and_derive_from_a_builtin(ours: type, builtin: type) -> None:
    assert issubclass(ours, ThermograspError)
    assert issubclass(ours, builtin)


@pytest.mark.parametrize("check", [finite, positive, non_negative, celsius])
@pytest.mark.parametrize("value", [2, 2.0, np.float32(2), np.int64(2)])
def test_numbers_pass_as_floats(check, value) -> None:
    result = check("width", value)
    assert type(result) is float
    assert result == 2.0


@pytest.mark.parametrize("check", [finite, positive, non_negative, celsius])
@pytest.mark.parametrize(
    "value", [math.nan, math.inf, -math.inf, True, np.True_, "2", None, [2], 2j, 10**400]
)
def test_what_is_no_finite_number_is_refused_by_name(check, value) -> None:
    with pytest.raises(InvalidValueError, match="width must be a"):
        check("width", value)


@pytest.mark.parametrize("value", [2.0, 2.5, "2", None, True, np.True_, [2], math.nan, 0, -1])
def test_what_is_no_whole_number_or_too_small_is_refused_by_name(value) -> None:
    with pytest.raises(InvalidValueError, match="num_envs must be a whole number, 1 or above, got"):
        whole_number("num_envs", value, 1)


def test_a_whole_number_is_an_int() -> None:
    assert type(whole_number("seed", np.int64(0))) is int


@pytest.mark.parametrize("value", [2.0, "12", "ab", None, (), (1, 2, 3), (1, "2"), (1, math.nan), (1, True)])
def test_what_is_not_so_many_numbers_is_refused_as_a_whole(value) -> None:
    with pytest.raises(InvalidValueError, match=r"placement \(m\) must be 2 finite numbers, got "):
        numbers("placement (m)", value, 2)


@pytest.mark.parametrize("value", [(1, 2.0), [1, 2], np.array([1, 2])])
def test_so_many_numbers_are_a_tuple_of_floats(value) -> None:
    given = numbers("placement (m)", value, 2)
    assert given == (1.0, 2.0) and all(type(one) is float for one in given)


def test_zero_and_below() -> None:
    assert non_negative("width", 0) == 0.0
    assert finite("width", -1) == -1.0
    assert celsius("width", -196) == -196.0
    for check, value in ((positive, 0.0), (positive, -1), (non_negative, -1e-300), (celsius, -274)):
        with pytest.raises(InvalidValueError, match=f"width must be .*, got {value!r}"):
            check("width", value)


@pytest.mark.parametrize(
    ("refused", "unit"),
    [
        (lambda: celsius("t", 309.15), "309.15 looks like kelvin: give 36"),
        (lambda: length("size", 40), "40 looks like millimetres: give 0.04"),
        (lambda: within("opening", [0.01, 40.0], 0.0, 0.085, "m"), "40 looks like millimetres: give 0.04"),
        (lambda: within("rate", 100, -0.1, 0.1, "m/s"), "100 looks like mm/s: give 0.1"),
        (lambda: within("force", 20_000, 0.0, 40.0, "N"), "20000 looks like millinewtons: give 20"),
    ],
)
def test_a_number_in_another_unit_is_asked_about(refused, unit) -> None:
    with pytest.raises(InvalidValueError) as error:
        refused()
    assert str(error.value).endswith("; " + unit)


def test_a_number_that_no_other_unit_explains_is_only_refused() -> None:
    for refused in (
        lambda: celsius("t", 900.0),
        lambda: within("force", 41.0, 0.0, 40.0, "N"),
        lambda: length("size", 1e5),
        lambda: within("force", -1.0, 0.0, 40.0, "N"),
        lambda: within("position", 300, 0, 255, "counts"),
    ):
        with pytest.raises(InvalidValueError) as error:
            refused()
        assert "looks like" not in str(error.value)


def test_what_installs_an_extra_works_in_a_clone_too() -> None:
    assert install("rl") == "pip install 'thermograsp[rl]', or in a clone pip install -e '.[rl]'"


def test_an_unknown_name_comes_with_near_ones() -> None:
    known = ["glass", "stainless_steel", "brass"]
    assert str(unknown_name("material", "glas", known)) == "unknown material 'glas'; did you mean 'glass'?"
    assert "'stainless_steel'" in str(unknown_name("material", "Steel", known))
    assert "'glass' or 'brass'" in str(unknown_name("material", "gras", known))


def test_where_nothing_is_near_all_names_are_listed() -> None:
    assert str(unknown_name("mode", "xyz", ["T", "O"])) == "unknown mode 'xyz'; known: O, T"
    assert str(unknown_name("mode", 3, ["T", "O"])) == "unknown mode 3; known: O, T"
    assert str(unknown_name("mode", "x", [])) == "unknown mode 'x'; none is known"


@pytest.mark.parametrize(
    ("value", "limit", "told"),
    [
        (90.0, 83.0, "90.0"),
        (83.04, 83.0, "83.04"),
        (82.96, 83.0, "82.96"),
        (83.00000001, 83.0, "83.00000001"),
        (84.68, 84.66, "84.7"),
        (0.1 + 0.2, 0.3, "0.30000000000000004"),
    ],
)
def test_what_is_beyond_a_limit_reads_so(value: float, limit: float, told: str) -> None:
    assert distinct_text(value, limit) == told
    assert (float(told) > limit) == (value > limit)
