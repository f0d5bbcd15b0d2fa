"""`thermograsp view --model`: anyone's MuJoCo scene with what its fingertips feel, drawn and as curves."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.files import atomic_write

if TYPE_CHECKING:
    import mujoco

    from thermograsp.touch import ThermalTouch

_WIDTH, _HEIGHT = 960, 540
_GEOMS = 10_000
_POINTS = 200  # of a live curve


def opened_scene(
    path: Path, fingertips: Sequence[str], objects: Sequence[str]
) -> tuple[mujoco.MjModel, mujoco.MjData, ThermalTouch]:
    """A scene's model, data (at its first keyframe, where it has one) and touch. fingertips: names of geoms, sites or
    bodies; objects: NAME=MATERIAL. Raises InvalidValueError where the file cannot be read."""
    import mujoco

    from thermograsp.touch import ThermalTouch

    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise InvalidValueError(f"--model {path}: {error}") from None
    if not fingertips:
        raise InvalidValueError("--model needs --fingertips: names of geoms, sites or bodies that feel heat")
    made_of = {}
    for one in objects:
        name, _, material = one.partition("=")
        if not material:
            raise InvalidValueError(f"--objects {one}: write NAME=MATERIAL, such as can=aluminium")
        made_of[name] = material
    touch = ThermalTouch(model, fingertips={name: name for name in fingertips}, objects=made_of)
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data, touch


def _drawn(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch) -> np.ndarray:
    """(height, width, 3) uint8, by the default camera. mujoco.Renderer finds no OpenGL where there is no screen."""
    import mujoco

    from thermograsp.opengl import offscreen

    context, buffers = offscreen(model, _WIDTH, _HEIGHT)
    try:
        scene, view = mujoco.MjvScene(model, _GEOMS), mujoco.MjvCamera()
        mujoco.mjv_defaultFreeCamera(model, view)
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, view, everything, scene)
        touch.draw(scene, data)
        whole, pixels = mujoco.MjrRect(0, 0, _WIDTH, _HEIGHT), np.zeros((_HEIGHT, _WIDTH, 3), np.uint8)
        mujoco.mjr_render(whole, scene, buffers)
        mujoco.mjr_readPixels(pixels, None, whole, buffers)
        return pixels[::-1]  # OpenGL's rows run upwards
    finally:
        context.free()


def picture(
    model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch, seconds: float, path: Path
) -> None:
    """Runs the scene for that long and writes what it looks like then, over the curves of the temperature drops."""
    import matplotlib.pyplot as plt
    import mujoco

    times, drops, reading = [], [], touch.reading
    end = data.time + seconds  # a keyframe may have a time of its own
    while data.time < end:
        mujoco.mj_step(model, data)
        latest = touch.update(data)
        if latest is not reading:
            reading = latest
            times.append(reading.time)
            drops.append(reading.temperature_drop)
    model.vis.global_.offwidth = max(model.vis.global_.offwidth, _WIDTH)
    model.vis.global_.offheight = max(model.vis.global_.offheight, _HEIGHT)
    pixels = _drawn(model, data, touch)
    figure, (above, below) = plt.subplots(
        2, 1, figsize=(9.6, 7.6), height_ratios=(5.4, 2.2), layout="constrained"
    )
    above.imshow(pixels)
    above.axis("off")
    curves = np.reshape(drops, (-1, len(touch.fingertips)))  # shorter than a reading takes there is none
    for row, label in enumerate(touch.fingertips):
        below.plot(times, curves[:, row], label=label)
    below.set_xlabel("time (s)")
    below.set_ylabel("temperature drop (K)")
    below.legend(loc="upper left")
    try:
        with atomic_write(path) as temporary:
            figure.savefig(temporary)
    finally:
        plt.close(figure)


def watch(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch) -> None:
    """MuJoCo's passive viewer, until its window is closed, with the fingertips coloured and a live plot."""
    import mujoco
    import mujoco.viewer

    figure = mujoco.MjvFigure()
    mujoco.mjv_defaultFigure(figure)
    figure.title, figure.xlabel = "temperature drop (K)", "s"
    for row, label in enumerate(touch.fingertips):
        figure.linename[row] = label.encode()
    with mujoco.viewer.launch_passive(model, data) as viewer:
        reading, begun, first = touch.reading, time.monotonic(), data.time
        while viewer.is_running():
            mujoco.mj_step(model, data)
            latest = touch.update(data)
            if latest is reading:
                continue
            reading = latest
            for row, drop in enumerate(reading.temperature_drop.tolist()):
                _append(figure, row, float(reading.time), drop)
            drawn = viewer.user_scn
            if drawn is not None:
                with viewer.lock():
                    drawn.ngeom = 0
                    touch.draw(drawn, data)
            if viewer.viewport is not None:
                viewer.set_figures((mujoco.MjrRect(0, 0, 400, 250), figure))
            viewer.sync()
            time.sleep(max(begun + data.time - first - time.monotonic(), 0.0))


def _append(figure: mujoco.MjvFigure, row: int, when: float, value: float) -> None:
    count = int(figure.linepnt[row])
    if count == _POINTS:
        figure.linedata[row, : 2 * _POINTS - 2] = figure.linedata[row, 2 : 2 * _POINTS].copy()
        count -= 1
    figure.linedata[row, 2 * count], figure.linedata[row, 2 * count + 1] = when, value
    figure.linepnt[row] = count + 1
