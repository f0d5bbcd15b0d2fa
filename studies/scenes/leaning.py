"""What a straight fingertip feels that leans on a flat face, and what the springs under it bear cell by cell.

    python studies/scenes/leaning.py
    python studies/scenes/leaning.py --tip cylinder --skin filled_silicone --materials aluminium wood --json

A capsule or a cylinder's side of 8 mm radius and 24 mm length is pressed on a block by ThermalTouch in a scene of
MuJoCo. Its drop, and the area and the force on the sensor's face, count half a second after the touch, of a difference
of 12 K.

Beside them stand springs that share no code with touch/contacts/round_pads.py: the pad is cut into cells, the gap of
each is that between a round rod and a plane that falls away from it by the angle, each spring bears its stiffness times
what the plane is nearer than that, and bisection finds the depth at which they bear the force together. They act across
the pad, and without friction; at 10 degrees that is 1.5 % of the force.

ThermalTouch counts a fingertip as level up to ALIGNED, .05 m per m or 2.9 degrees, and a steeper one as that much less
steep. Springs that keep to this ("less the zone") tell how well its law is solved. Springs at the whole angle tell what
the zone costs: they bear less on the sensor's face from the first degree on. A capsule's round ends, which are no part
of its pad, bear a part as well, and the last springs have them. The drop without the zone is that of ThermalTouch
itself on a fingertip that leans by the zone more.

Under a skin the face's springs are the skin's and those beside it the pad's. ThermalTouch takes a level face to bear
the whole force then; of these springs those beside it bear a part.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import product

import mujoco
import numpy as np

from thermograsp import Fingertip, ThermalTouch
from thermograsp.thermal.contact import beside_round, conductance
from thermograsp.touch.contacts import AREA
from thermograsp.touch.contacts.round_pads import ALIGNED, round_contact
from thermograsp.touch.scene import PadPlace

RADIUS, HALF, TOP = 0.008, 0.012, 0.02
"""m: of the fingertip, half of its straight part, and half of the block's sides."""
ANGLES = (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0)
"""Degrees."""
STEEPEST = 30.0
"""Degrees, far beyond where its pad ends."""
CELL = 2.5e-5
"""m, sides of the springs' cells, roughly."""
_DOWN = 2  # the axis of the block that the pad looks along


@dataclass(frozen=True, slots=True)
class Borne:
    """On the sensor's face: area m2 and force N."""

    area_m2: float
    force_N: float


@dataclass(frozen=True, slots=True)
class Row:
    """drop_K: ThermalTouch's; without_zone_K: the same did every angle count. touch: what it takes from the contact.
    Springs: at the angle less the zone, at the angle, and at the angle with a capsule's round ends."""

    tip: str
    skin: str | None
    material: str
    degrees: float
    drop_K: float
    without_zone_K: float
    touch: Borne
    less_zone: Borne
    whole_angle: Borne
    with_ends: Borne


def leant(tip: str, skin: str | None, name: str, force: float, slope: float) -> ThermalTouch:
    """Of a model with that fingertip above a block; slope: m per m that it falls by along its axis."""
    turn = math.atan(slope)
    lowest = HALF * math.sin(turn) + RADIUS * (1.0 if tip == "capsule" else math.cos(turn))
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><compiler angle="radian"/><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="block"><geom type="box" size="{TOP} {TOP} {TOP}"/></body>
        <body pos="0 0 {TOP + lowest + 0.0005}" euler="0 {turn} 0">
          <joint name="down" type="slide" axis="{math.sin(turn)} 0 {-math.cos(turn)}" damping="20"/>
          <geom name="tip" type="{tip}" size="{RADIUS} {HALF}" euler="0 {math.pi / 2} 0" mass=".1"/></body>
      </worldbody><actuator><motor joint="down"/></actuator></mujoco>""")
    tips = {"tip": Fingertip("tip", skin=skin)}
    return ThermalTouch(model, fingertips=tips, objects={"block": name}, air=0.0, chain="ideal")


def pressed(touch: ThermalTouch, force: float, seconds: float) -> tuple[float, Borne]:
    """K of drop so many seconds after the touch, and what was on the sensor's face."""
    model, data, began = touch._model, mujoco.MjData(touch._model), None
    data.ctrl[:] = force
    while began is None or data.time < began + seconds:
        mujoco.mj_step(model, data)
        touch.update(data)
        if began is None and touch.reading.force[0] + touch.reading.beside[0] > 0:
            began = data.time
    return float(touch.reading.temperature_drop[0]), borne(touch, data)


def borne(touch: ThermalTouch, data: mujoco.MjData) -> Borne:
    """What touch/contacts/round_pads.py says of the contact; the reader notes the area, but no force on the face."""
    reader, pad, force = touch._reader, touch._pads[0], float(touch.reading.force[0])
    if force <= 0:
        return Borne(0.0, 0.0)  # beside the pad
    # of the block's axes along the pad's normal, y and z, the block being upright
    seen = data.xmat[pad.body].reshape(3, 3) @ pad.axes
    sides = np.array([*seen[0, 1:], *seen[1, 1:], *(seen[_DOWN, 1:] / seen[_DOWN, 0]), 0.0, 0.0])
    area, load, share, longer, even, wedge = round_contact(
        reader._bend[0], reader._curve[0, _DOWN], sides, force, 0.0, 0.0
    )
    law = reader._laws[0, 0, 0, _DOWN]
    patch = area * share * (1 - float(law["narrowing"]) * (1 - even))
    conducts = conductance(law, load / area) * area * share if area > 0 else 0.0
    _, patch, _ = beside_round(law, wedge, conducts, patch, math.sqrt(patch * longer))
    reader.touches[:] = 0.0
    reader.read(data)
    noted = float(reader.touches[0, 0, 0, AREA])
    if abs(noted - patch) > 1e-3 * noted + 1e-9:
        raise RuntimeError(f"the touch noted an area of {noted:g} m2, and its law says {patch:g} m2")
    return Borne(area * share, load * share)


def springs(pad: PadPlace, force: float, slope: float, ends: bool = False, cell: float = CELL) -> Borne:
    """On the sensor's face, of the pad of a straight fingertip that falls by slope m per m. ends: with the half
    balls at both ends. cell: m."""
    sheet, (across, along) = pad.silicone, sorted(pad.size.tolist())
    around = sheet.foundation_modulus / sheet.thickness
    on_face = around if pad.skin is None else pad.skin.stiffness
    radius, reach = 1 / max(pad.curvature), across / 2

    def middles(low: float, high: float) -> tuple[np.ndarray, float]:
        count = max(round((high - low) / cell), 1)
        return low + (np.arange(count) + 0.5) * (high - low) / count, (high - low) / count

    x, dx = middles(0.0, reach)  # the other half is alike
    last = along / 2 + (reach if ends else 0.0)
    s, ds = middles(-last, last)
    x, s = x[:, None], s[None]
    beyond = np.maximum(abs(s) - along / 2, 0.0)  # m, on the round ends
    fallen = np.hypot(x, beyond)
    rises = radius - np.sqrt(np.maximum(radius**2 - fallen**2, 0.0))
    gap = np.where(fallen < reach, rises, np.inf) + slope * (s + along / 2)
    half = np.minimum(pad.stack.width, pad.size).min() / 2
    face = (x < half) & (abs(s) < half)
    stiffness = np.where(face, on_face, around) * 2 * dx * ds

    def held(depth: float) -> float:
        return float((stiffness * np.maximum(depth - gap, 0.0)).sum())

    low, high = float(gap.min()), float(gap.min()) + 0.01
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if held(middle) < force else (low, middle)
    sunk = np.where(face, np.maximum(high - gap, 0.0), 0.0)
    return Borne(float((sunk > 0).sum() * 2 * dx * ds), float((stiffness * sunk).sum()))


def row(
    tip: str,
    skin: str | None,
    name: str,
    degrees: float,
    force: float = 10.0,
    seconds: float = 0.5,
    cell: float = CELL,
) -> Row:
    """One angle."""
    slope = math.tan(math.radians(degrees))
    touch = leant(tip, skin, name, force, slope)
    drop, contact = pressed(touch, force, seconds)
    without_zone, _ = pressed(leant(tip, skin, name, force, slope + ALIGNED), force, seconds)
    pad = touch._pads[0]
    less, whole, with_ends = (
        springs(pad, force, fall, ends, cell)
        for fall, ends in ((max(slope - ALIGNED, 0.0), False), (slope, False), (slope, tip == "capsule"))
    )
    return Row(tip, skin, name, degrees, drop, without_zone, contact, less, whole, with_ends)


def line_of(found: Row) -> str:
    """A line of the table."""
    borne = (found.touch, found.less_zone, found.whole_angle, found.with_ends)
    cells = "".join(f"{1e6 * each.area_m2:7.1f}{each.force_N:6.2f}  " for each in borne)
    area, force = (
        1e6 * (found.touch.area_m2 - found.less_zone.area_m2),
        found.touch.force_N - found.less_zone.force_N,
    )
    return (
        f"{found.degrees:6.1f}{found.drop_K:8.2f}{found.without_zone_K:9.2f}  {cells}{area:7.1f}{force:6.2f}"
    )


HEAD = """degrees  drop   without  touch          less the zone  whole angle    with its ends  touch - less the zone
            K   a zone K    mm2     N      mm2     N      mm2     N      mm2     N      mm2     N"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--tip", choices=("capsule", "cylinder"), default="capsule")
    parser.add_argument("--skin", default=None, help="a name of thermal.SKINS (default: bare)")
    parser.add_argument("--materials", nargs="+", default=["aluminium", "glass"])
    parser.add_argument("--angles", nargs="+", type=float, default=ANGLES, help="degrees")
    parser.add_argument("--force", type=float, default=10.0, help="N (default 10)")
    parser.add_argument("--seconds", type=float, default=0.5, help="after the touch (default .5)")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    given = parser.parse_args(arguments)
    if not (math.isfinite(given.force) and given.force > 0 and 0 < given.seconds < math.inf):
        parser.error(f"--force and --seconds must be above 0, got {given.force:g} N and {given.seconds:g} s")
    if not all(0 <= degrees <= STEEPEST for degrees in given.angles):
        parser.error(f"--angles must be 0 to {STEEPEST:g} degrees, got {given.angles}")
    last = None
    for name, degrees in product(given.materials, given.angles):
        if not given.json and name != last:
            print(f"{given.tip} on {name}, {given.skin or 'bare'}, {given.force:g} N\n{HEAD}")
        last = name
        found = row(given.tip, given.skin, name, degrees, given.force, given.seconds)
        print(json.dumps(asdict(found)) if given.json else line_of(found), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
