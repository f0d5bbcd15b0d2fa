from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.contact.area import (
    ContactArea,
    Pad,
    cylinder_contact,
    flat_contact,
    sphere_contact,
)

Curved = Callable[[Pad, np.ndarray, float], ContactArea]
PAD = Pad()
K = PAD.foundation_modulus
FORCES = np.concatenate(([0.0], np.geomspace(1e-3, 1e4, 29)))


def test_a_sensor_is_no_narrower_than_what_touches_of_it() -> None:
    assert Pad(width=0.006, face=0.006).sensor_width == 0.006
    assert Pad(width=0.006, face=0.006, sensor=0.009).sensor_width == 0.009
    with pytest.raises(
        InvalidValueError, match=r"sensor 0.005 m is narrower than what touches of it, 0.006 m"
    ):
        Pad(width=0.006, face=0.006, sensor=0.005)


def test_sphere_follows_the_winkler_foundation() -> None:
    """Johnson, Contact Mechanics, section 4.3: F = pi K a^4/(4 R d) = pi K R delta^2/d with a^2 = 2 R delta."""
    radius, force = 0.03, np.array([0.01, 0.1, 1.0])
    delta = np.sqrt(force * PAD.thickness / (np.pi * K * radius))
    contact = sphere_contact(PAD, force, radius)
    np.testing.assert_allclose(contact.pad, np.pi * 2 * radius * delta, rtol=1e-12)
    small = contact.pad < np.pi * (PAD.face / 2) ** 2
    assert small.any()
    np.testing.assert_allclose(contact.face_force[small], force[small], rtol=1e-12)
    np.testing.assert_allclose(contact.face[small], contact.pad[small], rtol=1e-12)


def test_cylinder_follows_the_winkler_foundation() -> None:
    """Johnson, section 4.3: load per length 2 K a^3/(3 R d)."""
    radius, force = 0.02, np.array([0.1, 1.0, 5.0])
    contact = cylinder_contact(PAD, force, radius)
    a = np.cbrt(1.5 * force / PAD.width * radius * PAD.thickness / K)
    assert (a < PAD.width / 2).all()
    np.testing.assert_allclose(contact.pad, 2 * a * PAD.width, rtol=1e-12)


@pytest.mark.parametrize("radius", [0.005, 0.03, 0.3, 3.0])
@pytest.mark.parametrize("force", [0.2, 2.0, 40.0, 1e4])
@pytest.mark.parametrize("solve", [sphere_contact, cylinder_contact])
def test_areas_and_forces_are_integrals_of_the_pressure(solve: Curved, force: float, radius: float) -> None:
    """Over a grid of points in a quarter of the pad; the depth is found by bisection on the force."""
    n = 500
    x = (np.arange(n) + 0.5) / n * PAD.width / 2
    distance = x[:, None] ** 2 + (x**2 if solve is sphere_contact else np.zeros(n))
    cell = PAD.width**2 / n**2

    def pressure_at(square: float) -> np.ndarray:
        return K * np.maximum(square - distance, 0) / (2 * radius * PAD.thickness)

    low, high = 0.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if pressure_at(middle).sum() * cell < force else (low, middle)
    pressure = pressure_at(low)
    on_face = np.maximum(x[:, None], x) < PAD.face / 2
    contact = solve(PAD, np.array(force), radius)
    assert float(contact.face_force) == pytest.approx((pressure * on_face).sum() * cell, rel=1e-3)
    assert float(contact.pad) == pytest.approx((pressure > 0).sum() * cell, rel=1e-2)
    assert float(contact.face) == pytest.approx(((pressure > 0) & on_face).sum() * cell, rel=1e-2)


@pytest.mark.parametrize("solve", [sphere_contact, cylinder_contact])
def test_grows_from_nothing_to_the_whole_pad(solve: Curved) -> None:
    contact = solve(PAD, FORCES, 0.05)
    for values in (contact.pad, contact.face, contact.face_force, contact.face_pressure):
        assert values[0] == 0
        assert (np.diff(values) >= 0).all()
    assert contact.pad[-1] == pytest.approx(PAD.width**2)
    assert contact.face[-1] == pytest.approx(PAD.face**2)
    assert (contact.face_force <= FORCES * (1 + 1e-12)).all()
    assert (contact.face_force * PAD.width**2 >= FORCES * PAD.face**2 * (1 - 1e-12)).all()


@pytest.mark.parametrize("solve", [sphere_contact, cylinder_contact])
def test_a_flat_body_is_a_curved_one_of_large_radius(solve: Curved) -> None:
    force = np.array([1.0, 30.0])
    curved, flat = solve(PAD, force, 1e6), flat_contact(PAD, force)
    np.testing.assert_allclose(curved.pad, flat.pad)
    np.testing.assert_allclose(curved.face_force, flat.face_force, rtol=1e-3)
    np.testing.assert_allclose(curved.face_pressure, force / PAD.width**2, rtol=1e-3)


def test_sphere_load_is_inverted_to_round_off() -> None:
    """Where the disc is cut by the pad's edges: from a = half width to its diagonal."""
    radius = 0.2
    edge = np.pi * K * 0.01**4 / (4 * radius * PAD.thickness)
    force = edge * np.linspace(0.9, 4.0, 200)
    contact = sphere_contact(Pad(face=PAD.width), force, radius)
    np.testing.assert_allclose(contact.face_force, force, rtol=1e-13)


def test_flat_overlap_and_offset() -> None:
    contact = flat_contact(PAD, np.array([0.0, 8.0]), size=(0.04, 0.04))
    assert contact.pad.tolist() == [0.0, pytest.approx(4e-4)] and contact.face.tolist() == [
        0.0,
        pytest.approx(81e-6),
    ]
    assert contact.face_force[1] == pytest.approx(8 * 81 / 400)
    small = flat_contact(PAD, 8.0, size=(0.005, 0.1))
    assert float(small.pad) == pytest.approx(0.005 * 0.02) and float(small.face) == pytest.approx(
        0.005 * 0.009
    )
    shifted = flat_contact(PAD, 8.0, size=(0.02, 0.02), offset=(np.array([0.0, 0.008, 0.015, 0.05]), 0.0))
    np.testing.assert_allclose(shifted.face, np.array([0.009, 0.0065, 0, 0]) * 0.009, atol=1e-18)
    np.testing.assert_allclose(shifted.pad, np.array([0.02, 0.012, 0.005, 0]) * 0.02, atol=1e-18)
    np.testing.assert_allclose(shifted.face_pressure[:2], 8 / shifted.pad[:2])


def test_short_cylinder() -> None:
    contact = cylinder_contact(PAD, 20.0, 0.02, length=0.006)
    assert float(contact.face) <= 0.006 * 0.009 * (1 + 1e-12)
    assert float(contact.pad) <= 0.006 * 0.02 * (1 + 1e-12)


def test_a_row_does_not_depend_on_the_others() -> None:
    force = np.random.default_rng(2).uniform(0, 60, (37, 2))
    for solve in (partial(sphere_contact, radius=0.03), partial(cylinder_contact, radius=0.03), flat_contact):
        batch = solve(PAD, force[:, 1])
        rows = [solve(PAD, f) for f in force[:, 1]]
        for name in ("pad", "face", "face_force", "face_pressure"):
            assert getattr(batch, name).tolist() == [float(getattr(row, name)) for row in rows]


def test_pad_stiffens_with_its_shape() -> None:
    """Gent & Lindley 1959: S = 20/12, so K = 1.14 MPa (1 + 1.86 (5/3)^2)."""
    assert pytest.approx(1.14e6 * (1 + 2 * 0.93 * 25 / 9)) == K
    hardness = 30
    gent = 0.0981 * (56 + 7.62336 * hardness) / (0.137505 * (254 - 2.54 * hardness)) * 1e6
    assert PAD.youngs_modulus == pytest.approx(gent, rel=0.01)


def test_refusals() -> None:
    for bad in (-1.0, np.nan, np.inf):
        with pytest.raises(InvalidValueError, match="force"):
            sphere_contact(PAD, np.array([1.0, bad]), 0.03)
    with pytest.raises(InvalidValueError, match="radius"):
        cylinder_contact(PAD, 1.0, 0.0)
    with pytest.raises(InvalidValueError, match="length"):
        cylinder_contact(PAD, 1.0, 0.01, length=-1.0)
    with pytest.raises(InvalidValueError, match="size"):
        flat_contact(PAD, 1.0, size=(0.0, 1.0))
    with pytest.raises(InvalidValueError, match="wider"):
        Pad(face=0.03)
