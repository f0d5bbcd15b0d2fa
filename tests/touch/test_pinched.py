"""A wall between two fingertips that press on the same place of it from both sides: each has half of it."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import warnings

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import IDEAL
from thermograsp.touch import Fingertip, ThermalTouch, install, prepare
from thermograsp.touch.heat import Pinched

from .engine_scene import NEEDS_COMPILER, NEEDS_RECORDS, NEEDS_SPECS, ROUND_OFF, per_kelvin, sent, voltages
from .recorded import felt_alike

TIPS = {"above": "above", "below": "below"}
FORCE = 8.0  # N on each


def scene(half: float, tips: int, off: float = 0.0, mesh: bool = False, width: float = 0.003) -> str:
    """Fingertips on slides above the sheet, and below it, off m aside; the
    sheet is twice half m thick. They are damped and stiff: MuJoCo's usual pads
    sink in deeper than such a sheet is thick, and older releases let them
    through. The two are never in contact with one another."""
    corners = " ".join(f"{x} {y} {z}" for x in (-0.02, 0.02) for y in (-0.02, 0.02) for z in (-half, half))
    bodies = ""
    for name, way, x in (("above", 1, 0.0), ("below", -1, off))[:tips]:
        bodies += f"""<body name="{name}" pos="{x} 0 {way * (half + 0.0041)}">
          <joint name="{name}" type="slide" axis="0 0 {-way}" damping="200"/>
          <geom type="box" size="{width} {width} .004" mass=".05"/></body>"""
    sheet = '<geom type="mesh" mesh="sheet"/>' if mesh else f'<geom type="box" size=".02 .02 {half}"/>'
    joints = "".join(f'<motor joint="{name}"/>' for name in list(TIPS)[:tips])
    return f"""<mujoco><option gravity="0 0 0"/><default><geom solref=".004 1"/></default>
      <asset><mesh name="sheet" vertex="{corners}"/></asset><worldbody>
      <body name="sheet">{sheet}</body>{bodies}</worldbody><actuator>{joints}</actuator>
      {'<contact><exclude body1="above" body2="below"/></contact>' * (tips == 2)}</mujoco>"""


def felt(text: str, tips: int, of: str, seconds: float = 1.0) -> tuple[float, ThermalTouch]:
    """K of the first fingertip after that time, and the touch."""
    model = mujoco.MjModel.from_xml_string(text)
    data, names = mujoco.MjData(model), dict(list(TIPS.items())[:tips])
    touch = ThermalTouch(model, fingertips=names, objects={"sheet": of}, chain=IDEAL, air=0.0)
    data.ctrl[:] = FORCE
    while data.time < seconds - 1e-9:
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch.reading.temperature_drop[0]), touch


def pinched(touch: ThermalTouch) -> list[float]:
    """The share that presses from behind of each fingertip's wall."""
    pairs = touch._heat._pairs
    sides = {number: side for (side, _), number in pairs._numbers.items()}
    found = []
    for f in range(len(touch.fingertips)):
        matter, _ = sides[int(pairs.kinds[0, f, 0, 1])]
        found.append(matter.by if isinstance(matter, Pinched) else 0.0)
    return found


@pytest.mark.parametrize("mesh", [False, True])
@pytest.mark.parametrize("of", ["glass", "stainless_steel"])
def test_two_have_half_of_it_each(of: str, mesh: bool) -> None:
    """By symmetry, as one that presses on half of it, whose back gives no heat away. On a whole wall, they would have
    .2 and .4 K more."""
    alone, _ = felt(scene(2.5e-4, 1), 1, of)
    both, touch = felt(scene(5e-4, 2, mesh=mesh), 2, of)
    assert both == pytest.approx(alone, abs=0.01 if not mesh else 0.03)
    assert pinched(touch) == [1.0, 1.0]


@pytest.mark.parametrize(("off", "share"), [(0.002, 0.75), (0.0045, 0.5), (0.01, 0.0)])
def test_aside_of_one_another_they_share_less_of_it(off: float, share: float) -> None:
    assert pinched(felt(scene(5e-4, 2, off), 2, "glass", 0.1)[1]) == pytest.approx([share, share], abs=0.13)


def test_a_wide_pad_and_a_thick_block_are_not_pinched() -> None:
    drops = [felt(scene(half, tips, width=0.01), tips, "glass")[0] for half, tips in ((2.5e-4, 1), (5e-4, 2))]
    assert drops[0] == pytest.approx(drops[1], abs=0.01)
    assert pinched(felt(scene(0.01, 2), 2, "glass", 0.1)[1]) == [0.0, 0.0]


@pytest.mark.parametrize(("wide", "celsius"), [(0.01, 36.0), (0.003, 10.0)])
def test_fingertips_of_another_kind_or_warmth_pinch_nothing(wide: float, celsius: float) -> None:
    """Through the wider of two contacts heat flows evenly, and what does needs no further way to spread."""
    above, below = scene(5e-4, 2).split('<body name="below"')
    below = below.replace('size="0.003 0.003 .004"', f'size="{wide} {wide} .004"')
    model = mujoco.MjModel.from_xml_string(f'{above}<body name="below"{below}')
    data, tips = mujoco.MjData(model), {"above": "above", "below": Fingertip("below", temperature=celsius)}
    touch = ThermalTouch(model, fingertips=tips, objects={"sheet": "glass"}, chain=IDEAL, air=0.0)
    data.ctrl[:] = FORCE
    for _ in range(50):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.touching == ("sheet", "sheet") and pinched(touch) == [0.0, 0.0]


def test_one_that_leaves_gives_the_whole_wall_back() -> None:
    model = mujoco.MjModel.from_xml_string(scene(5e-4, 2))
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=TIPS, objects={"sheet": "glass"}, chain=IDEAL, air=0.0)
    seen = []
    for force in (8.0, -2.0, 8.0):
        data.ctrl[:] = 8.0, force
        for _ in range(150):
            mujoco.mj_step(model, data)
            touch.update(data)
        seen.append(pinched(touch)[0])
    assert seen == [1.0, 0.0, 1.0]
    balance = touch.balance
    assert balance.given.sum() == pytest.approx(balance.objects.sum(), rel=1e-10)


@NEEDS_COMPILER
@NEEDS_SPECS
@pytest.mark.parametrize("off", [0.0, 0.002])
def test_inside_mujoco_s_step_they_feel_the_same(off: float) -> None:
    objects = {"sheet": "stainless_steel"}
    model = install(mujoco.MjSpec.from_string(scene(5e-4, 2, off)), fingertips=TIPS, objects=objects)
    data, touch = mujoco.MjData(model), ThermalTouch(model, fingertips=TIPS, objects=objects, chain=IDEAL)
    shares = set()
    for force in (8.0, -2.0, 8.0):
        data.ctrl[:] = 8.0, force
        for n in range(150):
            mujoco.mj_step(model, data)
            touch.update(data)
            if n % 10 == 9:
                difference = voltages(model, data) - sent(touch)
                assert np.abs(difference / per_kelvin(touch)).max() < ROUND_OFF
                shares.add(pinched(touch)[0])
    assert len(shares) == 2


@NEEDS_RECORDS
def test_fixed_touch_is_the_loop() -> None:
    model = prepare(mujoco.MjSpec.from_string(scene(5e-4, 2)), TIPS, {"sheet": "glass"})
    touch = ThermalTouch(
        model, fingertips=TIPS, objects={"sheet": "glass"}, chain=IDEAL, air=0.0, worlds=1, dt=0.01
    )
    drop = felt_alike(touch, model, (8.0, -2.0, 8.0), 30, 1e-6)
    assert drop.max() > 0.5


@pytest.mark.parametrize(("half", "excluded"), [(4e-5, False), (4e-5, True), (5e-4, False)])
def test_fingertips_that_meet_through_a_sheet_are_told(half: float, excluded: bool) -> None:
    text = scene(half, 2)
    text = text if excluded else text.replace('<exclude body1="above" body2="below"/>', "")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=TIPS, objects={"sheet": "glass"}, chain=IDEAL)
    data.ctrl[:] = FORCE
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        for _ in range(1000):
            mujoco.mj_step(model, data)
            touch.update(data)
    expected = [] if excluded or half > 1e-4 else ["'above' and 'below' touch one another through 'sheet'"]
    assert len(told) == len(expected) and all(part in str(told[0].message) for part in expected)
