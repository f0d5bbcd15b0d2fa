"""thermal.press: tolerances kept, rungs by name, and what it refuses."""

import json
from pathlib import Path

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import RUNGS, Mode, press

REFERENCE = json.loads((Path(__file__).parents[2] / "data" / "press_3d.json").read_text(encoding="utf-8"))[
    "cases"
]
TABLE_ERROR = 0.0015  # K, of the reference itself


@pytest.mark.parametrize("tolerance", [0.05, 0.005])
@pytest.mark.parametrize("case", REFERENCE)
def test_keeps_its_tolerance_on_the_reference(case: str, tolerance: float) -> None:
    name, conductance, mode = case.split("/")
    assert mode in ("T", "O")
    result = press(
        name,
        mode=mode,
        conductance=float(conductance),
        seconds=20.0,
        dt=0.05,
        tolerance=tolerance,
        cache=False,
    )
    index = np.round(np.array(REFERENCE[case]["t"]) / 0.05).astype(int)
    error = np.abs(result.temperature_drop[index] - REFERENCE[case]["Td"])
    assert np.max(error) <= tolerance + TABLE_ERROR
    assert result.rung.error <= tolerance
    np.testing.assert_allclose(result.voltage, result.temperature_drop * 1e-3)


@pytest.mark.parametrize(("mode", "tolerances"), [("T", (0.5, 0.05, 0.03)), ("O", (0.5, 0.01, 0.003))])
def test_smaller_tolerances_take_larger_networks(mode: Mode, tolerances: tuple[float, ...]) -> None:
    """Of the same kind: below .0024 of the difference a search for the one conductance takes over in T mode, and finds
    smaller ones than those from heat kernels, which serve any conductance."""
    states = []
    for tolerance in tolerances:
        found = press("glass", mode=mode, seconds=2.0, tolerance=tolerance, cache=False)
        states.append(sum(map(int, found.rung.orders.split("/")[1:])))
    assert states[0] < states[1] < states[2]


def test_a_simpler_rung_is_no_further_off_before_the_touch_has_settled() -> None:
    """The lumped rung begins with 10.4 K of 12 K: of a film of glass, which is warm within a millisecond, that was the
    largest drop."""
    film = {"object_size": (0.009, 0.009, 1e-6), "seconds": 1.0, "dt": 0.1, "cache": False}
    assert press("glass", rung="lumped", **film).temperature_drop[0] > 10.0
    found = press("glass", **film)
    assert found.temperature_drop[0] == 0.0 and found.temperature_drop.max() < 0.02
    assert press("glass", conductance=1.0, seconds=1.0, dt=0.1, cache=False).rung.name == "lumped"


def test_orders_by_name_and_a_second_fingertip_apart() -> None:
    one = press("glass", rung="network:3/12/16", seconds=5.0, dt=0.05, cache=False)
    two = press("glass", rung="network:2/10/12/12", seconds=5.0, dt=0.05, cache=False)
    assert str(two.rung) == "network:2/10/12/12"
    assert np.max(np.abs(one.temperature_drop - two.temperature_drop)) < 0.05
    again = press("glass", rung=two.rung, seconds=5.0, dt=0.05, cache=False)
    np.testing.assert_array_equal(again.temperature_drop, two.temperature_drop)


def test_two_fingertips_on_a_thin_plate_share_it() -> None:
    """Symmetric presses: no heat crosses the middle plane, so each fingertip sees half the plate."""
    both = press(
        "glass",
        rung="network:3/12/16/12",
        opposite=1e4,
        object_size=(0.03, 0.03, 0.004),
        seconds=5.0,
        cache=False,
    )
    half = press("glass", rung="network:3/12/16", object_size=(0.03, 0.03, 0.002), seconds=5.0, cache=False)
    np.testing.assert_allclose(both.temperature_drop, half.temperature_drop, atol=0.01)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_a_constant_function_is_a_number(mode: Mode) -> None:
    one = press(
        "wood",
        mode=mode,
        rung="network:2/10/12" if mode == "T" else "network:2/0/12",
        seconds=1.0,
        cache=False,
    )
    two = press("wood", mode=mode, rung=one.rung, conductance=lambda time: 1e4, seconds=1.0, cache=False)
    np.testing.assert_allclose(two.temperature_drop, one.temperature_drop, atol=2e-4)


def test_apart_nothing_happens() -> None:
    result = press("glass", conductance=0.0, seconds=1.0, cache=False)
    assert not np.any(result.temperature_drop) and not np.any(result.heat_flow)


def test_no_difference_no_drop() -> None:
    result = press("glass", sensor_temperature=30.0, object_temperature=30.0, seconds=1.0, cache=False)
    assert not np.any(result.temperature_drop)


def test_colder_sensor_mirrors_a_warmer_one() -> None:
    keywords = {"seconds": 1.0, "cache": False, "rung": "network:2/10/12"}
    warm = press("glass", sensor_temperature=36.0, object_temperature=24.0, **keywords)  # pyright: ignore[reportArgumentType]
    cold = press("glass", sensor_temperature=24.0, object_temperature=36.0, **keywords)  # pyright: ignore[reportArgumentType]
    np.testing.assert_allclose(cold.temperature_drop, -warm.temperature_drop, atol=1e-12)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"mode": "X"}, "mode"),
        ({"conductance": -1.0}, "conductance"),
        ({"conductance": float("nan")}, "conductance"),
        ({"conductance": lambda time: 1e4 if time < 0.3 else -5.0}, r"conductance at t = 0\.3\d* s .*got -5"),
        (
            {"conductance": lambda time: np.array([2e3])},
            r"conductance at t = 0 s .*must be a number, got array",
        ),
        ({"opposite": lambda time: "2000"}, "opposite at t = .*must be a number, got '2000'"),
        ({"conductance": lambda time: float("nan")}, "nan"),
        ({"area": 82e-6}, "more than the face"),
        ({"area": 0.0}, "area"),
        ({"shape": "hexagonal"}, "shape"),
        ({"object_size": (0.005, 0.04, 0.01)}, "smaller than the sensor"),
        ({"object_size": (0.04, 0.04)}, "object_size"),
        ({"sensor_temperature": float("nan")}, "sensor_temperature"),
        ({"seconds": -1.0}, "seconds"),
        ({"dt": 0.0}, "dt"),
        ({"dt": 1.1}, "1 s at dt 1.1 s have no sample after the touch"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"seconds": 1e9, "dt": 1e-3}, "larger dt"),
        ({"rung": "layered:2/3"}, "no orders"),
        ({"rung": "network:2"}, "modes/sensor"),
        ({"rung": "network:9/10/12"}, "modes must be"),
        ({"rung": "network:2/0/12"}, "do not fit"),
        ({"rung": "network:2/10/5000"}, "order must be"),
        ({"rung": "layered", "opposite": 1e4}, "one fingertip"),
        ({"tolerance": 1e-7}, "no network keeps"),
    ],
)
def test_refuses(keywords, message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        press("glass", **{"seconds": 1.0, "cache": False, **keywords})


def test_suggests_names() -> None:
    with pytest.raises(UnknownNameError, match="network"):
        press("glass", rung="netwrok")
    with pytest.raises(UnknownNameError, match="aluminium"):
        press("aluminum")
    with pytest.raises(UnknownNameError, match="seed"):
        press("glass", sensor="sead")
    assert {"lumped", "network", "semi_analytic", "grid_3d"} <= set(RUNGS)
