"""What a skinned fingertip touches: its own springs on the sensor's face, both in series around it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.thermal import LAPPED_ALUMINA, SKINS, Pad, Skin, Surface, material
from thermograsp.thermal.contact import cylinder_contact, face_joint, flat_contact, skinned, sphere_contact

PAD, SKIN = Pad(), SKINS["filled_silicone"]
SPRINGS = PAD.foundation_modulus / PAD.thickness


def test_springs_are_in_series_around_the_sensor_and_alone_on_it() -> None:
    worn = skinned(PAD, SKIN)
    around = worn.foundation_modulus / worn.thickness
    assert 1 / around == pytest.approx(1 / SPRINGS + 1 / SKIN.stiffness)
    assert worn.face_ratio * around == pytest.approx(SKIN.stiffness)
    assert skinned(PAD, None) is PAD
    share = SKIN.stiffness * PAD.face**2
    share /= share + around * (PAD.width**2 - PAD.face**2)
    assert flat_contact(worn, 10.0).face_force == pytest.approx(10 * share)


def test_a_ball_and_a_rod_sink_into_the_sheet_alone() -> None:
    """Contacts within the sensor's face: a^4 = 4 F R/(pi K), 4 b^3 l K = 6 F R."""
    worn, force, radius = skinned(PAD, SKIN), np.array([1.0, 10.0]), 0.02
    ball = sphere_contact(worn, force, radius)
    assert ball.face == pytest.approx(np.pi * (4 * force * radius / (np.pi * SKIN.stiffness)) ** 0.5)
    short = replace(worn, width=worn.face)  # all of it sensor
    rod = cylinder_contact(short, force, radius)
    assert rod.face == pytest.approx(
        2 * worn.face * (1.5 * force * radius / (SKIN.stiffness * worn.face)) ** (1 / 3)
    )


def test_a_softer_or_thicker_sheet_touches_more() -> None:
    areas = [
        float(sphere_contact(skinned(PAD, Skin(made, deep)), 10.0, 0.02).face)
        for made, deep in (("rubber", 1e-4), ("rubber", 1e-3), ("glass", 1e-4))
    ]
    assert areas[2] < areas[0] < areas[1]


def test_a_skin_s_surface_replaces_the_alumina() -> None:
    steel = Surface.of(material("steel"))
    assert face_joint(None, steel).conductivity == pytest.approx(
        2 / (1 / LAPPED_ALUMINA.conductivity + 1 / steel.conductivity)
    )
    pair = face_joint(SKIN, steel)
    assert pair.conductivity < 2 * SKIN.made_of.conductivity and np.isfinite(pair.solid_most)
