"""One touch, told to ThermalTouch in several ways that mean the same, or nearly so: by how much the drops differ.

    python studies/scenes/retold.py                                every case, aluminium and wood
    python studies/scenes/retold.py --cases seam order --materials glass --json

| case | the same told as |
|---|---|
| seam | a block of 40 mm as one box, as two halves, as eight slabs with a `shape` or without, and as two objects |
| leaning | the same, under a pad that leans by 4 degrees about the seam |
| capsule | the same, under a capsule across the seams |
| overlap | the block as two boxes of one body that share a half, or that cross |
| edge | the block as a box and as a mesh, under a pad that leans by 25 degrees near an edge |
| turned | a plate as a box, and as a mesh whose file is turned, in the middle and at a corner |
| pinch | a sheet of 1 mm between two fingertips that do not meet, and half of it under one, whose back is insulated |
| swapped | under a skin, a flat fingertip on a ball or across a rod of 20 mm, and such a fingertip on the block |
| order | two fingertips that press one another aside of their middles, in both orders |

Each fingertip of 36 degrees is pressed with 8 N on a body of 24; the drops count a second after the start of the fall
over .1 mm, of which the touch comes after some hundredths. In `order` the second fingertip has 10 degrees.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass

import mujoco
import trimesh
from scipy.spatial.transform import Rotation

from thermograsp import Fingertip, ThermalBody, ThermalTouch

FORCE, SECONDS, GAP = 8.0, 1.0, 1e-4
"""N on each fingertip, s, and m of its fall."""
TOP = 0.02
"""m, half of the block's sides; its halves and slabs meet under the pad's middle."""
FLAT, NARROW = ("box", ".01 .01 .004", 0.004), ("box", ".003 .003 .004", 0.004)
BALL, CAPSULE = ("sphere", ".008", 0.008), ("capsule", ".006 .012", 0.006)
BAR = ("box", ".003 .02 .004", 0.004)
"""Geoms of fingertips: type, size, and m from the middle to what touches."""
PLATE = (0.06, 0.04, 0.012)
"""m, sides."""
COOLER = 10.0
"""Degrees Celsius, of a second fingertip in `order`."""


@dataclass(frozen=True, slots=True)
class Row:
    """drops_K: of the first fingertip, by how the touch is told; the first is the simplest."""

    case: str
    material: str
    what: str
    drops_K: dict[str, float]


def fingertip(
    name: str, geom: tuple[str, str, float], height: float, *, down: int = 1, lean: float = 0.0,
    off: tuple[float, float] = (0.0, 0.0),
    turn: str = "0 0 0",
) -> str:  # fmt: skip
    """MJCF of one above a height m, which slides down, or up where that is -1. off: m along x and y."""
    kind, size, half = geom
    at = down * (height + half + GAP + 0.02 * math.radians(lean))
    return f"""<body name="{name}" pos="{off[0]} {off[1]} {at}"><joint type="slide" axis="0 0 {-down}" damping="20"/>
      <body name="{name} end" euler="0 {lean} 0">
      <geom name="{name}" type="{kind}" size="{size}" euler="{turn}" mass=".1"/></body></body>"""


def drop(
    world: str,
    objects: Mapping[str, str | ThermalBody],
    fingertips: Mapping[str, str | Fingertip] | None = None,
    *,
    assets: str = "",
    more: str = "",
    air: float = 5.0,
) -> float:
    """K of the fingertip `tip`, or of the first one told, SECONDS after the start."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option gravity="0 0 0"/><asset>{assets}</asset><worldbody>{world}</worldbody>{more}</mujoco>'
    )
    data, tips = mujoco.MjData(model), fingertips or {"tip": "tip"}
    touch = ThermalTouch(model, fingertips=tips, objects=objects, chain="ideal", air=air)
    data.qfrc_applied[:] = FORCE
    while data.time < SECONDS - 1e-9:
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch.reading.temperature_drop[list(tips).index("tip")])


def slabs(count: int) -> str:
    """The block's geoms, side by side along x."""
    half = TOP / count
    return "".join(
        f'<geom name="{n}" type="box" size="{half} {TOP} {TOP}" pos="{-TOP + half * (2 * n + 1)} 0 0"/>'
        for n in range(count)
    )


def block(geoms: str) -> str:
    return f'<body name="block">{geoms}</body>'


def _of_slabs(case: str, material: str, what: str, tip: str) -> Row:
    told = {f"{count} geoms": drop(block(slabs(count)) + tip, {"block": material}) for count in (1, 2, 8)}
    seen = f'<geom name="whole" type="box" size="{TOP} {TOP} {TOP}" contype="0" conaffinity="0"/>'
    whole = ThermalBody(material, shape="whole")
    told["8 geoms, shape told"] = drop(block(slabs(8) + seen) + tip, {"block": whole})
    told["2 objects"] = drop(block(slabs(2)) + tip, {"0": material, "1": material})
    return Row(case, material, what, told)


def seam(material: str) -> Iterator[Row]:
    yield _of_slabs("seam", material, "flat pad", fingertip("tip", FLAT, TOP))


def leaning(material: str) -> Iterator[Row]:
    yield _of_slabs("leaning", material, "flat pad, 4 degrees", fingertip("tip", FLAT, TOP, lean=4.0))


def capsule(material: str) -> Iterator[Row]:
    yield _of_slabs("capsule", material, "capsule", fingertip("tip", CAPSULE, TOP, turn="0 90 0"))


def overlap(material: str) -> Iterator[Row]:
    tip, objects = fingertip("tip", FLAT, TOP), {"block": material}
    shared = "".join(f'<geom type="box" size=".015 {TOP} {TOP}" pos="{x} 0 0"/>' for x in (-0.005, 0.005))
    crossed = "".join(f'<geom type="box" size="{x} {y} {TOP}"/>' for x, y in ((TOP, 0.01), (0.01, TOP)))
    ways = {"1 geom": slabs(1), "share a half": shared, "cross": crossed}
    yield Row(
        "overlap", material, "flat pad", {way: drop(block(it) + tip, objects) for way, it in ways.items()}
    )


def edge(material: str) -> Iterator[Row]:
    asset, objects = _mesh("own", trimesh.creation.box((2 * TOP,) * 3)), {"block": material}
    tip = fingertip("tip", FLAT, TOP, lean=25.0, off=(0.022, 0.0))
    ways = {"box": slabs(1), "mesh": '<geom type="mesh" mesh="own"/>'}
    told = {way: drop(block(it) + tip, objects, assets=asset) for way, it in ways.items()}
    yield Row("edge", material, "flat pad, 25 degrees", told)


def turned(material: str) -> Iterator[Row]:
    objects = {"block": material}
    for what, off in (("in the middle", (0.0, 0.0)), ("at a corner", (0.02, 0.018))):
        tip = fingertip("tip", FLAT, PLATE[2] / 2)
        beside = f'pos="{-off[0]} {-off[1]} 0"'
        told = {"box": drop(block(f'<geom type="box" size="{_halves(PLATE)}" {beside}/>') + tip, objects)}
        for way, angles in (
            ("mesh", (0, 0, 0)),
            ("turned by 37", (0, 0, 37)),
            ("turned by all", (20, 50, 10)),
        ):
            turn = Rotation.from_euler("xyz", angles, degrees=True)
            file = trimesh.creation.box(PLATE)
            file.vertices = turn.apply(file.vertices)
            x, y, z, w = turn.inv().as_quat()
            geom = f'<geom type="mesh" mesh="own" quat="{w} {x} {y} {z}" {beside}/>'
            told[way] = drop(block(geom) + tip, objects, assets=_mesh("own", file))
        yield Row("turned", material, what, told)


def pinch(material: str) -> Iterator[Row]:
    for what, geom in (("20 mm wide", FLAT), ("6 mm wide", NARROW), ("ball", BALL)):
        told = {}
        for way, half, tips in (("one, .5 mm", 2.5e-4, ("tip",)), ("two, 1 mm", 5e-4, ("tip", "below"))):
            sheet = f'<geom type="box" size=".02 .02 {half}"/>'
            world = "".join(fingertip(tip, geom, half, down=1 if tip == "tip" else -1) for tip in tips)
            apart = '<contact><exclude body1="tip end" body2="below end"/></contact>' if len(tips) > 1 else ""
            touched = block(sheet) + world
            told[way] = drop(touched, {"block": material}, {tip: tip for tip in tips}, air=0.0, more=apart)
        yield Row("pinch", material, what, told)


def swapped(material: str) -> Iterator[Row]:
    worn, objects = {"tip": Fingertip("tip", skin="filled_silicone")}, {"block": material}
    for what, kind, size, turn in (
        ("ball", "sphere", f"{TOP}", "0 0 0"),
        ("rod", "cylinder", f"{TOP} {TOP}", "0 90 0"),
    ):
        thing = block(f'<geom type="{kind}" size="{size}" euler="{turn}"/>') + fingertip("tip", FLAT, TOP)
        tip = block(slabs(1)) + fingertip("tip", (kind, size, TOP), TOP, turn=turn)
        told = {way: drop(world, objects, worn) for way, world in (("object", thing), ("fingertip", tip))}
        yield Row("swapped", material, f"{what} under a skin", told)


def order(material: str) -> Iterator[Row]:
    """Of any material: the object is far away and never touched."""
    far = f'<body name="block" pos=".5 0 0">{slabs(1)}</body>'
    for what, above, turn, below, other in (
        ("crossed capsules", CAPSULE, "0 90 0", CAPSULE, "90 0 0"),
        ("ball on a bar", BALL, "0 0 0", BAR, "0 0 0"),
    ):
        for off in ((0.0, 0.0), (0.001, 0.002), (0.0, 0.003)):
            world = far + fingertip("tip", above, 0.0, off=off, turn=turn)
            kind, size, half = below
            world += f"""<body pos="0 0 {-half}">
              <geom name="below" type="{kind}" size="{size}" euler="{other}" mass=".1"/></body>"""
            both = {"tip": Fingertip("tip"), "below": Fingertip("below", temperature=COOLER)}
            ways = {" before ".join(names): names for names in (("tip", "below"), ("below", "tip"))}
            told = {
                way: drop(world, {"block": material}, {name: both[name] for name in names})
                for way, names in ways.items()
            }
            yield Row("order", "any", f"{what}, {1e3 * math.hypot(*off):.1f} mm aside", told)


def _mesh(name: str, mesh: trimesh.Trimesh) -> str:
    points, faces = (" ".join(map(str, part.ravel())) for part in (mesh.vertices, mesh.faces))
    return f'<mesh name="{name}" vertex="{points}" face="{faces}"/>'


def _halves(sides: Sequence[float]) -> str:
    return " ".join(str(side / 2) for side in sides)


CASES: dict[str, Callable[[str], Iterator[Row]]] = {
    case.__name__: case for case in (seam, leaning, capsule, overlap, edge, turned, pinch, swapped, order)
}


def of_materials(case: str, materials: Sequence[str]) -> Iterator[Row]:
    for material in materials[:1] if case == "order" else materials:
        yield from CASES[case](material)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="One touch, told to ThermalTouch in several ways.")
    parser.add_argument("--cases", nargs="+", default=list(CASES), choices=CASES, help="which")
    parser.add_argument("--materials", nargs="+", default=["aluminium", "wood"], help="of the bodies")
    parser.add_argument("--json", action="store_true", help="print one JSON array")
    options = parser.parse_args(arguments)
    rows = (row for name in options.cases for row in of_materials(name, options.materials))
    if options.json:
        json.dump([asdict(row) for row in rows], sys.stdout, indent=1)
        return 0
    for row in rows:
        told = "   ".join(f"{way}: {kelvin:.2f}" for way, kelvin in row.drops_K.items())
        print(f"{row.case:9}{row.material:16}{row.what:32}{told}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
