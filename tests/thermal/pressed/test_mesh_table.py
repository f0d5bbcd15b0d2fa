"""Tables of meshes between their places, beside the springs themselves there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from thermograsp.thermal import SKINS, Pad, material
from thermograsp.thermal.contact import (
    FIRST_FORCE,
    FORCE_STEP,
    FORCES,
    curved_contact,
    skinned,
)
from thermograsp.thermal.pressed import PressedMesh, pressed_view

PAD, SKIN, METAL = Pad(), SKINS["filled_silicone"], material("aluminium")
AXES = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
SOLIDS = {
    "rod": trimesh.creation.cylinder(0.01, 0.06, sections=96),
    "ball": trimesh.creation.icosphere(4, 0.02),
    "small ball": trimesh.creation.icosphere(4, 0.006),
    "box": trimesh.creation.box((0.04, 0.04, 0.04)),
}
HALF_FELT = 0.4  # W/K, by which about half of the temperature difference is felt


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("shape", SOLIDS)
def test_between_places_it_tells_what_the_springs_do(shape: str, skin: str | None) -> None:
    """At forces of .5 to 25 N, while a crown slides over the face's edge and beyond it, where a contact ends within
    tenths of a millimetre: in shares of what can be felt, beyond what springs tell a quarter of a millimetre away."""
    solid, worn = SOLIDS[shape], SKINS[skin] if skin else None
    vertices, faces = np.ascontiguousarray(solid.vertices, float), np.asarray(solid.faces, np.int64)
    one = PressedMesh(PAD, worn, METAL, vertices.tobytes(), faces.tobytes(), AXES.tobytes())
    table, sheet = one.table(), skinned(PAD, worn)
    view = pressed_view(sheet, one.vertices, one.faces, one.axes)
    middle, count = view.spans / 2, 97
    across = np.linspace(-0.0115, 0.0115, count)
    finer = replace(view, places=np.stack((middle[0] + across, np.full(count, middle[1]))))
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    found = finer.conducted(worn, METAL, ((1, count - 1), (1, 2)))[:, :, 0]
    conducts = found[..., 6] + found[..., 7]
    felt = conducts / (conducts + HALF_FELT)
    off = []
    for n in range(4, 10):
        for i in range(1, count - 3):
            near = felt[n, i - 1 : i + 2]
            told = curved_contact(table, float(forces[n]), float(finer.places[0, 1 + i]), float(middle[1]))[0]
            told /= told + HALF_FELT
            off.append((told - felt[n, i], max(near.min() - told, told - near.max(), 0.0)))
    here, nearby = np.abs(off).T
    assert nearby.max() < 0.06
    assert np.sqrt(np.mean(nearby**2)) < 0.006
    assert np.sqrt(np.mean(here**2)) < (0.01 if skin is None else 0.05)
