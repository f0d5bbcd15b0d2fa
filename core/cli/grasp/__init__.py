"""`thermograsp grasp`: one scripted grasp in simulation, or on a real gripper beside it, recorded."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from thermograsp.cli.grasp.beside import run_beside
from thermograsp.cli.shared import (
    Output,
    add_materials_file,
    add_mode,
    add_old_name,
    add_seed,
    add_sensor,
    add_surround,
    add_tolerance,
    chosen_material,
    load_mujoco,
    target,
)
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.agents import Recording
    from thermograsp.envs import ObjectSpec

NAME = "grasp"
HELP = (
    "Grasp one object in simulation, lift it by 5 cm and hold it; record what the fingertips feel. Or grasp with a "
    "real gripper, and compare it with the simulation."
)

_FAILED = 1
# Where neither the arguments nor an object of the library says otherwise.
_MATERIAL, _SHAPE, _WIDTH, _SCALE = "glass", "box", 0.04, 1.0  # m
_ROOM, _FORCE = 24.0, 10.0  # °C, N


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "--material",
        help="name of the object's material, see `thermograsp materials` "
        f"(default: the object's own, else {_MATERIAL})",
    )
    add_materials_file(parser)
    add_mode(parser)
    add(
        "--seconds",
        type=float,
        default=6.0,
        help="length of the episode, s; the touch is at about 0.5 s",
    )
    add(
        "--hold",
        type=float,
        default=2.0,
        help="time at a height of 5 cm, up to the end of the episode, that counts as holding, s",
    )
    add_seed(parser, "seed of the object's place and of the noise")
    add(
        "--force",
        type=float,
        help=f"limit of the gripper's force, N (default: enough to hold the object of --object, else {_FORCE:g})",
    )
    add(
        "--object",
        metavar="NAME",
        help="name of an everyday object, such as mug_of_coffee, see `thermograsp objects`",
    )
    add(
        "--shape",
        help=f"shape of the object: box, cylinder or sphere (default: the object's own, else {_SHAPE})",
    )
    add(
        "--width",
        type=float,
        help=f"width of the object between the fingers, m (default: the object's own, else {_WIDTH:g})",
    )
    add("--height", type=float, help="height of the object, m (default: its width)")
    add("--mesh", metavar="FILE", help="mesh file of the object: .stl, .obj, .ply or .glb")
    add("--scale", type=float, help=f"metres per unit of length in the mesh file (default: {_SCALE:g})")
    warmth = add(
        "--object-temperature",
        dest="temperature",
        type=float,
        help=f"initial temperature of the object, degC (default: the object's own, else {_ROOM:g})",
    )
    add_old_name(parser, "--temperature", warmth)
    add_tolerance(parser)
    add_sensor(parser)
    add(
        "--skin",
        default="auto",
        help="name of a skin over the sensor's face, in T mode only; none for a bare one; or auto for filled_silicone "
        "with --object and on objects other than boxes",
    )
    add_surround(parser)
    add(
        "--gripper",
        metavar="FILE",
        help="MJCF file of your own gripper, in simulation (default: the shipped gripper)",
    )
    add(
        "--plant",
        metavar="URL",
        help="real gripper to grasp with, serial://PORT?gripper=URL; the same grasp is simulated beside it",
    )
    add("--no-cache", action="store_true", help="do not keep thermal networks on disk")
    add("--csv", metavar="FILE", help="write a table with one row per voltage sample (100 Hz)")
    add(
        "--render",
        metavar="FILE",
        help="draw the grasp as an animation (.gif, .webp) or a strip of pictures (.png)",
    )
    add(
        "--plot",
        metavar="FILE",
        help="draw the real and the simulated curves, with --plant: .svg, .png or .pdf",
    )


def run(args: argparse.Namespace) -> int:
    """Grasps, writes and prints. 1 where the object was not lifted and held; with --plant, held."""
    output = Output(args.json)
    load_mujoco(output)
    import numpy as np

    from thermograsp.agents import record
    from thermograsp.columns import write_csv
    from thermograsp.envs import GraspBatch, GraspTask

    csv, picture = target(args.csv, ()), target(args.render, (".gif", ".webp", ".png"))
    if args.plot is not None and args.plant is None:
        raise InvalidValueError("--plot draws real beside simulated: give --plant, or use --render or --csv")
    spec = _object(args)
    # a real object is where it was put, in the middle as well as could be
    placement: dict[str, Any] = {} if args.plant is None else {"placement": (0.0, 0.0)}
    batch = GraspBatch(
        1,
        task=GraspTask(hold_seconds=args.hold, seconds=args.seconds),
        material=chosen_material(args.material, args.materials),
        mode=args.mode,
        objects=spec,
        tolerance=args.tolerance,
        object_temperature=args.temperature if args.object is None else _ROOM,
        sensor=args.sensor,
        skin=None if args.skin == "none" else args.skin,
        surround=args.surround,
        gripper=args.gripper,
        cache=not args.no_cache,
        **placement,
    )
    if args.plant is not None:
        return run_beside(args, batch)
    film = None
    if picture is not None:
        from thermograsp.figures import Film

        count = 6 if picture.suffix == ".png" else max(2, round(10 * args.seconds))
        film = Film(batch.plant, np.linspace(0.0, args.seconds, count).tolist())
    with output.progress(args.seconds) as advance:

        def watch(time: float, now: GraspBatch) -> None:
            advance(args.material, now.dt if time else 0.0)
            if film is not None:
                film.watch(time, now)

        (grasp,) = record(batch, [args.seed], args.seconds, args.force, watch=watch)
    if csv is not None:
        write_csv(csv, grasp.columns)
    if film is not None and picture is not None:
        film.write(picture)
    assert batch.reading is not None
    _print(output, args, grasp, float(batch.reading.truth["crushing_force"][0]))
    batch.close()
    return 0 if grasp.success else _FAILED


def _object(args: argparse.Namespace) -> ObjectSpec:
    """The object; fills in the arguments that it decides where they are not given."""
    from thermograsp.envs import ObjectSpec, library_object

    given = {name: getattr(args, name) for name in ("shape", "width", "height", "mesh", "scale")}
    shape_options = {name: value for name, value in given.items() if value is not None}
    if args.object is not None:
        if shape_options:
            raise InvalidValueError(
                f"--object {args.object} has its own shape: leave out --{' and --'.join(shape_options)}"
            )
        preset = library_object(args.object)
        args.material = args.material or preset.material
        args.temperature = preset.temperature if args.temperature is None else args.temperature
        args.force = preset.grip_force if args.force is None else args.force
        return replace(preset.spec(), temperature=args.temperature)
    args.material = args.material or _MATERIAL
    args.temperature = _ROOM if args.temperature is None else args.temperature
    args.force = _FORCE if args.force is None else args.force
    friction = chosen_material(args.material, args.materials).friction
    surface: dict[str, Any] = {} if friction is None else {"friction": friction}
    if args.mesh is not None:
        if unused := [name for name in shape_options if name not in ("mesh", "scale")]:
            raise InvalidValueError(
                f"--mesh {args.mesh} has its own shape and size: leave out --{' and --'.join(unused)}"
            )
        scale = _SCALE if args.scale is None else args.scale
        return ObjectSpec(shape="mesh", mesh=args.mesh, scale=scale, **surface)
    if args.scale is not None:
        raise InvalidValueError("--scale is for meshes: give --mesh FILE too, or leave it out")
    shape, width = args.shape or _SHAPE, shape_options.get("width", _WIDTH)
    if shape == "sphere" and args.height not in (None, width):
        raise InvalidValueError(
            f"a sphere is as high as wide, {width:g} m: leave out --height {args.height:g}"
        )
    height = width if args.height is None else args.height
    return ObjectSpec(shape=shape, size=(width, width, height), **surface)


def _print(output: Output, args: argparse.Namespace, grasp: Recording, crushing: float) -> None:
    columns = grasp.columns
    document: dict[str, Any] = {
        "object": args.object,
        "material": grasp.material,
        "mode": args.mode,
        "seed": grasp.seed,
        "rung": grasp.rung,
        "success": grasp.success,
        "ending": grasp.ending,
        "touch_time_s": grasp.touch,
        "samples": len(columns["time_s"]),
    }
    what = "lifted and held" if grasp.success else grasp.ending or f"not lifted and held for {args.hold:g} s"
    if grasp.ending == "crushed":
        what = f"crushed by more than {crushing:.1f} N"
    name = f"{args.object} of {grasp.material}" if args.object else grasp.material
    output.line(f"{name}, {args.mode} mode: {what}; rung {grasp.rung}")
    if len(columns["time_s"]):
        drop = columns["temperature_drop_left_K"]
        peak = int(abs(drop).argmax())
        document |= {
            "peak_temperature_drop_left_K": drop[peak],
            "peak_time_s": columns["time_s"][peak],
            "final": {name: values[-1] for name, values in columns.items()},
        }
        output.line("touch  none" if grasp.touch != grasp.touch else f"touch  {grasp.touch:.2f} s")
        output.line(f"peak   {drop[peak]:.3f} K at {columns['time_s'][peak]:.2f} s (left fingertip)")
        output.line(f"final  {drop[-1]:.3f} K at {columns['time_s'][-1]:.2f} s")
    for file in (args.csv, args.render):
        if file:
            output.line(f"wrote {file}")
    output.document({**document, "csv": args.csv, "render": args.render})
