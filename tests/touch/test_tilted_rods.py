"""Rods that lie at an angle on a pad, beside sums over cells of the same springs and the same gap, and in scenes."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import importlib.util
import math
import os
import shutil

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import AIR, IDEAL, Pad, Surface, material
from thermograsp.thermal.contact import curved_contact, curved_table, cylinder_footprint, face_joint, skinned
from thermograsp.thermal.matter import skin as named_skin
from thermograsp.touch import Fingertip, ThermalTouch, install
from thermograsp.touch.contacts import pair_laws
from thermograsp.touch.contacts.tilt import HALF, TURN, array_tilted, tilted
from thermograsp.touch.scene import bodies, pads

PAD = Pad(width=0.020, face=0.009)
RADIUS = 0.01
ANGLES = (0.5, 1.0, 2.0, 5.0, 15.0)  # degrees that are left when the face has turned
SCENE = """
<mujoco><option timestep=".002" cone="elliptic" impratio="10"/><worldbody>
  <body name="rod" euler="0 {} 0" pos="{} 0 0"><geom type="cylinder" size=".01 {}" euler="0 90 0"/></body>
  <body name="tip" pos="0 0 {}"><joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
    <geom name="tip" type="box" size=".01 .01 .004" mass=".05" contype="1"/></body>
</worldbody><actuator><motor joint="tip"/></actuator></mujoco>"""


def scene(degrees: float, half: float = 0.01, at: float = 0.0) -> str:
    """Of a rod whose middle is that many m beside the pad's, along its line."""
    up = RADIUS + half * math.sin(math.radians(abs(degrees))) + 0.0045
    return SCENE.format(degrees, at, half, up)


def tilt_of(name: str, skin: str | None, half: float) -> np.ndarray:
    model = mujoco.MjModel.from_xml_string(scene(0.0, half))
    shapes = bodies(model, {"rod": name}, 24.0)
    tips = pads(model, {"tip": Fingertip("tip", skin=skin)}, shapes)
    return pair_laws(model, tips, shapes).tilts[0, 0, 0]


def test_a_pad_on_a_round_geom_has_no_edge_for_a_rod_to_lie_on() -> None:
    text = scene(0.0).replace('type="box" size=".01 .01 .004"', 'type="capsule" size=".01 .02"')
    model = mujoco.MjModel.from_xml_string(text)
    shapes = bodies(model, {"rod": "steel"}, 24.0)
    given = Fingertip("tip", (0.0, 0.01, 0.0), (0.0, 1.0, 0.0), (0.02, 0.02))
    assert tilt_of("steel", None, 0.01).any()
    assert not pair_laws(model, pads(model, {"tip": given}, shapes), shapes).tilts.any()


def test_a_pad_on_a_cylinder_s_end_has_an_edge_and_on_its_side_none() -> None:
    """On its end a rod that leans is felt as on a square pad of the same area."""
    fingers: tuple[tuple[str, str, dict[str, str | Fingertip]], ...] = (
        ("square", 'type="box" size=".0053174 .0053174 .004"', {"tip": "tip"}),
        ("end", 'type="cylinder" size=".006 .004"', {"tip": "tip"}),
        (
            "side",
            'type="cylinder" size=".006 .02" euler="90 0 0"',
            {"tip": Fingertip("tip", (0.0, 0.0, -0.006), (0.0, 0.0, -1.0), (0.02, 0.02))},
        ),
    )
    rows, drops = {}, {}
    for name, geom, tips in fingers:
        text = scene(6.0, 0.04).replace('type="box" size=".01 .01 .004"', geom)
        model = mujoco.MjModel.from_xml_string(text)
        touch = ThermalTouch(model, fingertips=tips, objects={"rod": "aluminium"}, chain=IDEAL)
        rows[name] = pair_laws(model, touch._pads, touch._shapes).tilts
        data = mujoco.MjData(model)
        data.ctrl[0] = 8.0
        for _ in range(200):
            mujoco.mj_step(model, data)
            touch.update(data)
        drops[name] = float(touch.reading.temperature_drop[0])
    assert rows["square"].any() and rows["end"].any() and not rows["side"].any()
    assert drops["end"] == pytest.approx(drops["square"], rel=0.15)


def sunk(springs: np.ndarray, height: np.ndarray, area: float, force: float) -> float:
    """Depth m at which the springs Pa/m of cells take the force N, by halving an interval."""
    low, high = 0.0, 0.02
    for _ in range(200):
        depth = (low + high) / 2
        if (springs * np.maximum(depth - height, 0)).sum() * area > force:
            high = depth
        else:
            low = depth
    return (low + high) / 2


def cells(half_rod: float, slope: float, count: int = 400) -> tuple[np.ndarray, ...]:
    """Places along and across m, the rod's height over the pad, whether the rod is there and whether the face is."""
    at = ((np.arange(count) + 0.5) / count - 0.5) * PAD.width
    along, across = np.meshgrid(at, at, indexing="ij")
    start = max(-half_rod, -PAD.width / 2)
    height = across**2 / (2 * RADIUS) + slope * (along - start)
    face = (abs(along) < PAD.face / 2) & (abs(across) < PAD.face / 2)
    return along, across, height, abs(along) < half_rod, face


def centred(row: np.ndarray, force: float, slope: float) -> tuple[float, float]:
    """tilted of a rod of which so much slope is left, and whose whole line lies over the pad's middle."""
    own, whole = row.copy(), slope + row[TURN] * force
    own[HALF] *= math.sqrt(1 + whole**2)
    return tilted(own, force, whole, 0.0)


@pytest.mark.parametrize("half", [0.004, 0.03])
@pytest.mark.parametrize("degrees", ANGLES)
def test_what_silicone_and_skin_take_is_that_of_springs_cell_by_cell(degrees: float, half: float) -> None:
    """The foundation's pressures are also those that envs finds for a surface of this shape under a force there."""
    force, skin = 8.0, named_skin("filled_silicone")
    row, slope = tilt_of("wood", "filled_silicone", half), math.tan(math.radians(degrees))
    assert skin is not None
    share, on_face = centred(row, force, slope)
    sheet = skinned(PAD, skin)
    along, across, height, over, face = cells(half, slope)
    springs = np.where(face, skin.stiffness, sheet.foundation_modulus / sheet.thickness) * over
    area = (PAD.width / len(along)) ** 2
    depth = sunk(springs, height, area, force)
    pressure = springs * np.maximum(depth - height, 0)
    load = pressure[face].sum() * area
    touched = along[face & (pressure > 0) & (abs(across) < PAD.width / len(along))]
    width = min(2 * half, PAD.face)
    long = np.ptp(touched) / width if len(touched) else 0.0
    assert on_face == pytest.approx(load, abs=0.03 * force)
    assert share == pytest.approx(long, abs=0.02)
    if importlib.util.find_spec("mujoco.batch") is None:  # envs need MuJoCo 4
        return
    from thermograsp.thermal.pressed import pressure_map

    coarse = cells(half, slope, 200)
    places = np.stack([coarse[0].ravel(), coarse[1].ravel()], axis=1)
    stiff = np.where(coarse[4], skin.stiffness, sheet.foundation_modulus / sheet.thickness) * coarse[3]
    middle = np.array([(pressure * along).sum(), (pressure * across).sum()]) / pressure.sum()
    own, cell = sheet.foundation_modulus / sheet.thickness, (PAD.width / 200) ** 2
    found = np.zeros(len(places))
    pressure_map(coarse[2].ravel(), (stiff / own).ravel(), places, cell, own, 0.02, force, middle, found)
    pressures = found.reshape(200, 200)
    assert pressures[coarse[4]].sum() * cell == pytest.approx(load, abs=0.03 * force)


@pytest.mark.parametrize("name", ["aluminium", "wood"])
@pytest.mark.parametrize("degrees", ANGLES)
def test_gas_beside_a_bare_tilted_rod_is_that_of_its_gap(name: str, degrees: float) -> None:
    """A short rod, whose end is over the face: k over the gap, summed over the face, beside what the table's line of
    no force conducts on the share that is left."""
    force, half = 0.021, 0.004
    row, slope = tilt_of(name, None, half), math.tan(math.radians(degrees))
    share, on_face = centred(row, force, slope)
    assert on_face == force
    law = cylinder_footprint(PAD, face_joint(None, Surface.of(material(name))), RADIUS, 2 * half)
    _, _, height, over, face = cells(half, slope, 1000)
    apart = float(law["mean_gap"])
    sloping = (over & face) / (apart + height)
    level = (over & face) / (apart + cells(half, 0.0, 1000)[2])
    assert share == pytest.approx(sloping.sum() / level.sum(), rel=0.1)
    whole = curved_contact(curved_table(PAD, None, material(name), RADIUS, 2 * half), force, 0.0, 0.0)[0]
    gas = AIR.conductivity * level.sum() * (PAD.width / 1000) ** 2
    assert 0.8 * gas < whole < 1.6 * gas  # with what little the solid spots conduct at this force


def test_arrays_do_as_compiled_code_does() -> None:
    rng = np.random.default_rng(0)
    for skin in (None, "filled_silicone"):
        for half in (0.003, 0.008, 0.04):
            row = tilt_of("glass", skin, half)
            force = np.concatenate((10 ** rng.uniform(-3, 2, 300), [0.0]))
            slope, middle = rng.normal(0, 0.1, 301), rng.uniform(-0.02, 0.02, 301)
            slope[:20] = 0.0
            share, pressed = array_tilted(row, force, slope, middle)
            every = [tilted(row, *each) for each in zip(force[:-1], slope[:-1], middle[:-1], strict=True)]
            np.testing.assert_allclose(share[:-1], [each[0] for each in every], rtol=1e-12)
            np.testing.assert_allclose(pressed[:-1], [each[1] for each in every], rtol=1e-12)
            assert ((share >= 0) & (share <= 1)).all() and (pressed[:-1] <= force[:-1]).all()
            assert share[-1] == 1.0 and pressed[-1] == 0.0
            assert (share[:20] == 1.0).all() and (pressed[:20] == force[:20]).all()


def drop(
    degrees: float, half: float = 0.01, name: str = "glass", skin: str | None = None, at: float = 0.0
) -> float:
    model = mujoco.MjModel.from_xml_string(scene(degrees, half, at))
    data = mujoco.MjData(model)
    tips = {"tip": Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), skin=skin)}
    touch = ThermalTouch(model, fingertips=tips, objects={"rod": name}, chain=IDEAL)
    data.ctrl[0] = 8.0
    for _ in range(200):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.force[0] > 8.0 > touch.reading.beside[0]
    return float(touch.reading.temperature_drop[0])


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("half", [0.004, 0.03])
def test_the_more_it_is_tilted_the_less_is_felt(half: float, skin: str | None) -> None:
    drops = [drop(degrees, half, skin=skin) for degrees in (0.0, 0.5, 3.0, 10.0)]
    assert drops[1] == pytest.approx(drops[0], rel=0.02)  # the pad turns with it
    assert all(less <= more for more, less in zip(drops[1:], drops[2:], strict=False))
    assert drops[-1] < 0.5 * drops[0]
    assert drop(-10.0, half, skin=skin) == pytest.approx(drops[3], rel=0.02)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_disc_that_slides_off_at_an_angle_is_felt_less_and_less(skin: str | None) -> None:
    """Its line ends 4 mm beside its middle, and the middle R sin(angle) beside the disc's."""
    for degrees, way in ((15.0, 1.0), (15.0, -1.0), (-15.0, 1.0), (5.0, 1.0)):
        aside = RADIUS * math.sin(math.radians(degrees))
        drops = [drop(degrees, 0.004, "aluminium", skin, way * at - aside) for at in (0.0, 4e-3, 6e-3, 8e-3)]
        assert all(less <= 1.15 * more for more, less in zip(drops, drops[1:], strict=False)), drops
        assert drops[-1] < 0.6 * drops[0]


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_long_rod_s_end_is_felt_where_it_is(skin: str | None) -> None:
    half, worn = 0.03, named_skin(skin) if skin else None
    long, short = (
        curved_table(PAD, worn, material("steel"), RADIUS, 2 * each) for each in (half, PAD.width / 2)
    )
    whole = curved_contact(long, 8.0, 0.0, 0.0)
    for covered in (1.0, 0.8, 0.5, 0.2):  # of the face, from its one side on
        end = (covered - 0.5) * PAD.face
        found = curved_contact(long, 8.0, 0.0, half - end)
        assert found == pytest.approx(curved_contact(short, 8.0, 0.0, PAD.width / 2 - end), rel=0.02)
    assert curved_contact(long, 8.0, 0.0, half - PAD.width / 2) == pytest.approx(whole, rel=1e-9)
    assert curved_contact(long, 8.0, 0.0, half + PAD.face / 2) == (0.0, 0.0, 0.0)
    level = [
        drop(0.0, half, "aluminium", skin, half + beside) for beside in (-0.0045, -0.002, 0.0, 0.002, 0.0048)
    ]
    assert (
        all(less < 0.95 * more for more, less in zip(level[:-1], level[1:], strict=True)) and level[-1] == 0.0
    )
    tilted_ends = [drop(5.0, half, "aluminium", skin, half + beside) for beside in (-0.003, 0.003)]
    assert tilted_ends[1] < tilted_ends[0] < level[0]


@pytest.mark.skipif(shutil.which(os.environ.get("CC", "cc")) is None, reason="needs a C compiler")
@pytest.mark.skipif(
    not hasattr(mujoco.MjSpec, "activate_plugin"), reason="specs take plugins from MuJoCo 3.3.2 on"
)
@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_the_plugin_feels_the_same(skin: str | None) -> None:
    words = {"fingertips": {"tip": Fingertip("tip", skin=skin)}, "objects": {"rod": "glass"}}
    for degrees, at in ((2.0, 0.0), (5.0, 0.0), (15.0, 4e-3)):
        model = install(mujoco.MjSpec.from_string(scene(degrees, at=at)), **words)
        data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
        data.ctrl[0] = 8.0
        for _ in range(150):
            mujoco.mj_step(model, data)
            touch.update(data)
        mujoco.mj_forward(model, data)
        volts = touch.reading.voltage[0, -1]
        assert data.sensor("heat").data[0] == pytest.approx(volts, abs=1e-9 * abs(volts) + 1e-13)
        assert volts > 0
