"""Draws all objects of the library, each in a frame of its own, as docs/images/objects.png shows them.

python examples/draw_objects.py objects.png
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import sys
from pathlib import Path

import mujoco
import numpy as np
import trimesh
from matplotlib.colors import to_rgb
from PIL import Image, ImageDraw, ImageFont

from thermograsp.envs import ObjectPreset, objects
from thermograsp.envs.bodies import object_solid
from thermograsp.files import atomic_write
from thermograsp.thermal import material

COLUMNS, CELL, LABEL = 10, 150, 34  # objects in a row; pixels of a picture and of what stands under it
FINER = 2
_PAPER, _INK, _SOFT = "#ffffff", "#22252a", "#8a9099"
_COLOURS = {
    "metal": "#9aa1ab",
    "glass": "#a5cfca",
    "ceramic": "#d8cbb4",
    "stone": "#b5623f",
    "wood": "#c0925c",
    "polymer": "#6f9ccb",
    "elastomer": "#59626d",
    "foam": "#e6c667",
    "paper": "#d9c7a8",
    "wax": "#efe6cf",
    "water": "#cfe6f2",
}
"""By family of material."""
_OF_FOOD = {
    "apple": "#c4453a",
    "tomato": "#d4503b",
    "potato": "#c7a46b",
    "banana": "#e9cf56",
    "egg": "#e8cdb0",
    "butter": "#f1dd8c",
    "cheese": "#ecbf55",
}
_OTHER = "#c8ccd2"
_STANDING_OUT = 2e-4  # m


def main() -> int:
    """Draws the sheet; the exit status."""
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    presets = list(objects().values())
    rows = -(-len(presets) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * CELL, rows * (CELL + LABEL)), _PAPER)
    draw = ImageDraw.Draw(sheet)
    bold, small = (ImageFont.load_default(size) for size in (11, 10))
    for number, preset in enumerate(presets):
        x, y = number % COLUMNS * CELL, number // COLUMNS * (CELL + LABEL)
        sheet.paste(picture(preset), (x, y))
        spec = preset.spec()
        label = f"{1e3 * spec.width:.0f} mm, {1e3 * spec.weight:.0f} g, {preset.temperature:.0f} °C"
        draw.text((x + CELL / 2, y + CELL), preset.name, _INK, bold, anchor="ma")
        draw.text((x + CELL / 2, y + CELL + 14), label, _SOFT, small, anchor="ma")
    with atomic_write(Path(sys.argv[1])) as temporary:
        sheet.quantize(256).save(temporary, "PNG", optimize=True)
    return 0


def picture(preset: ObjectPreset) -> Image.Image:
    """One object on white, from a corner."""
    parts = object_solid(preset.spec(), material(preset.material)).parts
    spec = mujoco.MjSpec()
    spec.visual.global_.offwidth = spec.visual.global_.offheight = CELL * FINER
    spec.visual.headlight.ambient, spec.visual.headlight.diffuse = (0.35,) * 3, (0.35,) * 3
    spec.visual.headlight.specular = (0.1,) * 3
    spec.add_texture(
        name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        rgb1=(1, 1, 1), rgb2=(1, 1, 1), width=16, height=16,
    )  # fmt: skip
    for number, part in enumerate(parts):
        surface = trimesh.Trimesh(part.vertices, part.faces, process=False)
        # parts that come to the surface stand out of it a little, so as to be seen
        vertices = part.vertices + number * _STANDING_OUT * surface.vertex_normals
        spec.add_mesh(name=f"part {number}", uservert=vertices.ravel(), userface=part.faces.ravel())
        geom = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, contype=0, conaffinity=0)
        geom.meshname = f"part {number}"
        colour = _OF_FOOD.get(part.material.name, _COLOURS.get(part.material.family, _OTHER))
        geom.rgba = (*to_rgb(colour), 1.0)
    spec.worldbody.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=(-1.0, -0.3, -0.9),
        diffuse=(0.6,) * 3,
        castshadow=False,
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = 0.0
    camera.azimuth, camera.elevation = 212.0, -26.0
    camera.distance = 1.55 * float(np.linalg.norm(np.ptp(parts[0].vertices, axis=0)))
    with mujoco.Renderer(model, CELL * FINER, CELL * FINER) as renderer:
        renderer.update_scene(data, camera)
        return Image.fromarray(renderer.render()).resize((CELL, CELL), Image.Resampling.LANCZOS)


if __name__ == "__main__":
    sys.exit(main())
