"""The pad around a sensor's element: limits that are known exactly, balance of heat, convergence and refusals. Beside
finite elements it is in tests/studies/test_pad_square.py."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import Layer, Material, SensorStack, Surround
from thermograsp.thermal.kernels import GRAM
from thermograsp.thermal.matter import sensor, skin
from thermograsp.thermal.padded import RINGS, squares
from thermograsp.thermal.padded.fingertip import RingedSamples, ringed_samples
from thermograsp.thermal.padded.rings import nested_sides

BLOCK = (0.04, 0.03, 0.01)
NOTHING = Material("nothing", conductivity=1e-3, density=1.0, specific_heat=1e3)


def _seed_in_silicone(worn: str | None = None) -> RingedSamples:
    stack, known = sensor("seed"), skin(worn)
    around = Surround().around(stack)
    return ringed_samples(stack if known is None else known.over(stack), around, nested_sides(0.009, 0.02))


def test_what_tells_rings_apart_is_orthonormal_over_the_front() -> None:
    seen = _seed_in_silicone()
    basis = seen.orthonormal(np.eye(len(GRAM), 1))
    # of each combination W/m2 times the front's area, in face and rings
    densities = np.concatenate((basis[:1] / seen.face, basis[len(GRAM) :] / seen.areas[:, None])) * seen.front
    shares = np.array([seen.face, *seen.areas]) / seen.front
    np.testing.assert_allclose(densities.T @ (shares[:, None] * densities), np.eye(1 + RINGS), atol=1e-12)
    np.testing.assert_allclose(densities[:, 0], 1.0, rtol=1e-12)


def _press(name: str, **words) -> thermal.Press:
    return thermal.press(
        name, **{"object_size": BLOCK, "conductance": 1e4, "seconds": 10.0, "dt": 0.05} | words
    )


@pytest.mark.parametrize("name", ["wood", "glass", "aluminium"])
def test_a_pad_that_hardly_conducts_changes_hardly_anything(name: str) -> None:
    alone, padded = _press(name), _press(name, surround=NOTHING, surround_conductance=1e4)
    late = alone.t >= 0.05
    assert np.abs(padded.temperature_drop - alone.temperature_drop)[late].max() < 0.05


@pytest.mark.parametrize("name", ["wood", "glass", "aluminium"])
def test_a_pad_of_the_elements_own_material_makes_a_wider_element(name: str) -> None:
    """Heat through the front is then that of an element as wide as the pad, which needs no squares."""
    layer = Layer("rubber", 0.003, 0.3, 1300.0, 1200.0)
    small = SensorStack("small", (layer,), 0.009, 0, 1e-3)
    wide = SensorStack("wide", (layer,), 0.020, 0, 1e-3)
    rubber = Material("rubber", conductivity=0.3, density=1300.0, specific_heat=1200.0)
    padded = _press(name, sensor=small, surround=rubber, surround_conductance=1e4)
    whole = _press(name, sensor=wide, area=4e-4, tolerance=0.02)
    late = padded.t >= 0.05
    scale = whole.heat_flow[late].max()
    np.testing.assert_allclose(padded.heat_flow[late], whole.heat_flow[late], atol=0.015 * scale)
    np.testing.assert_allclose(
        padded.stored_heat, whole.stored_heat, atol=0.015 * abs(whole.stored_heat).max()
    )


@pytest.mark.parametrize("words", [{}, {"skin": "filled_silicone"}, {"opposite": 5e3}, {"air": 20.0}])
def test_what_flows_through_the_front_is_in_the_object(words: dict) -> None:
    pressed = _press("glass", dt=0.01, surround="silicone", **words)
    if "opposite" in words or "air" in words:
        assert np.isfinite(pressed.temperature_drop).all()
        alone = _press("glass", dt=0.01, **words)
        assert 0.1 < abs(pressed.temperature_drop - alone.temperature_drop).max() < 0.6
        return
    flow = pressed.heat_flow
    gained = np.concatenate(([0.0], np.cumsum((flow[1:] + flow[:-1]) / 2 * 0.01)))
    settled = pressed.t > 0.5
    first = np.flatnonzero(settled)[0]
    gain = pressed.stored_heat[:, 1]
    np.testing.assert_allclose(
        (gain - gain[first])[settled], (gained - gained[first])[settled], rtol=2e-3, atol=2e-3
    )


def test_the_drop_converges_with_the_squares_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    def samples() -> np.ndarray:
        squares.bonded.cache_clear()
        ringed_samples.cache_clear()
        return _seed_in_silicone().drop[:, [0, *range(-RINGS, 0)]].copy()

    found = [samples()]
    for name, shares in (("_WIDTH", 2.0), ("_DEPTH", 2.0), ("_BETWEEN", 2.0)):
        monkeypatch.setattr(squares, name, getattr(squares, name) / shares)
    monkeypatch.setattr(squares, "_GROWTH", 0.12)
    found.append(samples())
    monkeypatch.undo()
    samples()
    np.testing.assert_allclose(found[0], found[1], rtol=2e-3, atol=2e-3 * abs(found[1]).max())


def test_networks_are_passive_and_reciprocal() -> None:
    seen = _seed_in_silicone("filled_silicone")
    np.testing.assert_allclose(seen.impedance, seen.impedance.transpose(0, 2, 1), rtol=1e-9)
    for value, slope in zip(seen.impedance, seen.slope, strict=True):
        size = np.sqrt(np.diag(value))
        assert np.linalg.eigvalsh(value / np.outer(size, size)).min() > -1e-9
        size = np.sqrt(-np.diag(slope))
        assert np.linalg.eigvalsh(-slope / np.outer(size, size)).min() > -1e-6


def test_a_wider_pad_and_a_narrower_object_are_served() -> None:
    narrow = _press("glass", object_size=(0.012, 0.03, 0.01), surround="silicone")
    wide = _press("glass", surround=Surround("silicone", width=0.028))
    usual = _press("glass", surround="silicone")
    assert abs(wide.temperature_drop - usual.temperature_drop).max() < 0.1
    assert np.isfinite(narrow.temperature_drop).all()
    assert narrow.rung.error <= 0.05


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ({"mode": "O"}, "mode 'O'"),
        ({"shape": "round"}, "square"),
        ({"area": 5e-5}, "area"),
        ({"thermostat": thermal.Thermostat()}, "ideal thermostat"),
        ({"sensor": "heated_thermistor"}, "heater"),
        ({"rung": "semi_analytic"}, "surround"),
        ({"rung": "network:2/4/4"}, "orders"),
        ({"tolerance": 1e-3}, "tolerance"),
        ({"conductance": 1e7}, "conductances"),
        ({"seconds": 1000.0, "dt": 1.0}, "600 s"),
        ({"surround": Surround(width=0.008)}, "leaves hardly anything"),
        ({"surround": Surround(width=0.0095)}, "0.0099 m or more"),
        ({"surround": Surround(depth=0.01)}, "deeper|more than"),
        ({"surround": 3.0}, "material"),
        ({"surround": "aluminium"}, "conducts 237"),
        ({"surround": NOTHING}, "nothing has no roughness.*surround_conductance"),
        ({"surround_conductance": -1.0}, "surround_conductance"),
        ({"surround": None, "surround_conductance": 1e4}, "surround_conductance"),
    ],
)
def test_what_a_surround_cannot_do_is_refused(words: dict, says: str) -> None:
    with pytest.raises(InvalidValueError, match=says):
        _press("glass", **{"surround": "silicone"} | words)


TIMES = (0.5, 1.0, 2.0, 5.0, 10.0)  # s
ELEMENTS = (
    ("sandstone", None, 304.251, 940.061, (0.5877, 1.0343, 1.6588, 2.4561, 2.7041)),
    ("wood", None, 1509.383, 2760.895, (0.8314, 1.1212, 1.3766, 1.459, 1.2713)),
    ("glass", None, 12793.206, 8403.702, (2.9204, 3.5759, 4.0461, 4.0864, 3.7145)),
    ("potato", "filled_silicone", 7278.093, 1062.441, (2.0746, 2.8155, 3.4373, 3.7156, 3.4588)),
    ("stainless_steel", "filled_silicone", 176839.4, 16640.24, (5.6352, 7.1165, 8.0105, 8.3979, 8.4153)),
    ("cotton", "filled_silicone", 3136.275, 1629.785, (0.1632, 0.218, 0.2714, 0.3017, 0.2747)),
)
"""Material, skin, W/(m2 K) of the face and of the pad under 10 N, and drops K of a difference of 12 K at TIMES, by
studies/surround/pad_square.py: drops(Touch(material, skin)), whose through() tells conductances by rough_faces.py."""


@pytest.mark.parametrize(("name", "skin", "face", "pad", "elements"), ELEMENTS)
def test_the_pad_conducts_by_its_own_contact(
    name: str, skin: str | None, face: float, pad: float, elements: tuple[float, ...]
) -> None:
    """Which press knows; and the drop is that of three-dimensional finite elements with both."""
    words = {"skin": skin, "conductance": face, "object_size": (0.04, 0.04, 0.01), "surround": "silicone"}
    pressed = _press(name, **words)
    given = _press(name, surround_conductance=pad, **words)
    np.testing.assert_allclose(pressed.temperature_drop, given.temperature_drop, atol=1e-4)
    found = pressed.temperature_drop[np.round(np.array(TIMES) / 0.05).astype(int)]
    np.testing.assert_allclose(found, elements, atol=pressed.rung.error)
    alike = _press(name, surround_conductance=face, **words).temperature_drop - pressed.temperature_drop
    assert (abs(alike).max() > 0.06) == (name in ("sandstone", "potato"))


@pytest.mark.parametrize(
    ("name", "skin", "size", "conducts", "elements", "within"),
    [
        ("glass", None, (0.010, 0.04, 0.01), (13195.4, 10520.3), (2.922, 3.551, 3.962, 3.873, 3.382), 0.05),
        ("glass", None, (0.012, 0.04, 0.01), (13085.6, 9823.98), (2.928, 3.581, 4.043, 4.04, 3.592), 0.05),
        (
            "aluminium",
            None,
            (0.012, 0.04, 0.01),
            (13158.7, 10754.5),
            (8.421, 9.579, 9.881, 9.699, 9.323),
            0.05,
        ),
        (
            "aluminium",
            None,
            (0.010, 0.04, 0.002),
            (13689.8, 11645.3),
            (7.386, 8.088, 8.108, 7.185, 5.877),
            0.075,
        ),
        (
            *("stainless_steel", "filled_silicone", (0.010, 0.04, 0.01), (196004.7, 17835.0)),
            *((5.596, 6.999, 7.779, 7.989, 7.817), 0.05),
        ),
    ],
)
def test_a_bar_that_the_pad_stands_over(
    name: str,
    skin: str | None,
    size: tuple[float, float, float],
    conducts: tuple[float, float],
    elements: tuple[float, ...],
    within: float,
) -> None:
    """Beside three-dimensional finite elements, drops(Touch(material, skin, size=..., depth=...))."""
    face, pad = conducts
    pressed = _press(
        name,
        skin=skin,
        object_size=size,
        conductance=face,
        surround="silicone",
        surround_conductance=pad,
        tolerance=0.045,
    )
    found = pressed.temperature_drop[np.round(np.array(TIMES) / 0.05).astype(int)]
    np.testing.assert_allclose(found, elements, atol=within)


def test_a_pad_that_does_not_touch_warms_its_sensor_alone() -> None:
    """Of glass: studies/surround/pad_heat.py has it as the silicone that touches the sensor alone."""
    apart = _press("glass", surround="silicone", surround_conductance=0.0)
    alone = _press("glass")
    change = (apart.temperature_drop - alone.temperature_drop)[[20, 40, 100, 200]]
    np.testing.assert_allclose(change, (-0.20, -0.30, -0.34, -0.30), atol=0.08)


def test_a_pad_leaves_with_its_face() -> None:
    """A conductance that varies: while the face is apart, so is its pad."""
    pressed = _press("glass", surround="silicone", conductance=lambda t: 1e4 if t < 5.0 else 0.0)
    steady = _press("glass", surround="silicone")
    t, gained = pressed.t, pressed.stored_heat[:, 1]
    np.testing.assert_allclose(pressed.temperature_drop[t < 5], steady.temperature_drop[t < 5], atol=0.02)
    assert (pressed.heat_flow[t > 5] == 0).all()
    np.testing.assert_allclose(gained[t > 5.01], gained[-1], rtol=1e-9)


def test_bad_surrounds_are_named() -> None:
    with pytest.raises(UnknownNameError, match="silicone"):
        _press("glass", surround="silicone_rubber")
    with pytest.raises(InvalidValueError, match=r"millimetres: give 0\.02"):
        Surround("silicone", width=20.0)
    for words in ({"width": -1.0}, {"width": float("nan")}, {"depth": 0.0}):
        with pytest.raises(InvalidValueError, match="surround"):
            Surround("silicone", **words)
