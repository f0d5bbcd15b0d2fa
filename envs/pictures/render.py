"""Pictures of an environment: sensor faces and objects coloured by temperature.

A Renderer draws into memory and needs no screen; a Window shows MuJoCo's own viewer and does. OpenGL is looked for
only when one of them is made, so mechanics run without it.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import threading
from collections.abc import Mapping

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, MissingDependencyError, unknown_name
from thermograsp.opengl import has_display, offscreen

from ..limits import TIPS
from ..mechanics import Mechanics, element_geom
from .colormap import temperature_colour

MAX_WIDTH, MAX_HEIGHT = 1280, 960  # the offscreen buffer of assets/gripper.xml
_MAX_GEOMS = 500
_COLOURED = 20.0, 40.0  # degC, the range of the colours
_CLOSING = 5.0  # s, at most, that a closing window is waited for


class _Stage:
    """One environment's model and data, copied out of a batch, with temperatures as colours."""

    def __init__(self, mechanics: Mechanics, low: float, high: float) -> None:
        temperature_colour(low, low, high)  # checks the range
        self.low, self.high = low, high
        self.model, self.data = mechanics.env_model(0), mechanics.env_data(0)
        self._geoms: dict[str, list[int]] = {}
        elements = {element_geom(tip, name) for tip in TIPS for name in mechanics.names}
        for geom in range(self.model.ngeom):
            name = self.model.geom(geom).name
            body = self.model.body(self.model.geom_bodyid[geom]).name
            part = body if body in mechanics.names and name not in elements else name
            self._geoms.setdefault(part, []).append(geom)

    def load(self, mechanics: Mechanics, env: int, temperatures: Mapping[str, float]) -> None:
        mechanics.env_model(env, self.model)
        mechanics.env_data(env, self.data)
        mujoco.mj_forward(self.model, self.data)
        for name, celsius in temperatures.items():
            if name not in self._geoms:
                raise unknown_name("coloured part", name, self._geoms)
            self.model.geom_rgba[self._geoms[name], :3] = temperature_colour(celsius, self.low, self.high)


class Renderer:
    """Draws frames of a Mechanics' environments offscreen. Where there is no screen it falls back to EGL, which
    mujoco.Renderer does only with MUJOCO_GL=egl, set before mujoco is imported.

    width, height: pixels. shadows: off is some ten times faster in software. low, high: degC, the colour range.
    Usable as a context manager; `close` frees OpenGL's buffers.
    Raises InvalidValueError (size, range) or MissingDependencyError (no OpenGL; the message says what to install).
    """

    def __init__(
        self,
        mechanics: Mechanics,
        *,
        width: int = 640,
        height: int = 480,
        shadows: bool = True,
        low: float = _COLOURED[0],
        high: float = _COLOURED[1],
    ) -> None:
        if not (1 <= width <= MAX_WIDTH and 1 <= height <= MAX_HEIGHT):
            raise InvalidValueError(
                f"frame of {width} x {height} pixels: give 1 to {MAX_WIDTH} x {MAX_HEIGHT}"
            )
        self._mechanics = mechanics
        self._stage = _Stage(mechanics, low, high)
        self._view = mujoco.MjrRect(0, 0, width, height)
        self._scene = mujoco.MjvScene(self._stage.model, maxgeom=_MAX_GEOMS)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = shadows
        self._options = mujoco.MjvOption()
        self._context, self._buffers = offscreen(self._stage.model, width, height)

    @property
    def cameras(self) -> tuple[str, ...]:
        """Names that `frame` takes."""
        model = self._stage.model
        return tuple(model.camera(i).name for i in range(model.ncam))

    def frame(
        self, env: int = 0, *, camera: str = "overview", temperatures: Mapping[str, float] | None = None
    ) -> np.ndarray:
        """One picture (height, width, 3) uint8 RGB of environment `env` as it is now.

        temperatures: degC by name: "sensor_left", "sensor_right" or an object's name.
        Raises UnknownNameError for a camera or a name that is not there.
        """
        if self._context is None:
            raise InvalidValueError("this Renderer is closed; make another one")
        if camera not in self.cameras:
            raise unknown_name("camera", camera, self.cameras)
        stage = self._stage
        stage.load(self._mechanics, env, temperatures or {})
        view = mujoco.MjvCamera()
        view.type, view.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, stage.model.camera(camera).id
        self._context.make_current()
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(stage.model, stage.data, self._options, None, view, everything, self._scene)
        mujoco.mjr_render(self._view, self._scene, self._buffers)
        pixels = np.zeros((self._view.height, self._view.width, 3), dtype=np.uint8)
        mujoco.mjr_readPixels(pixels, None, self._view, self._buffers)
        return pixels[::-1].copy()  # OpenGL's rows run upwards

    def close(self) -> None:
        """Free what OpenGL holds; may be called twice."""
        for held in (self._buffers, self._context):
            if held is not None:
                held.free()
        self._context = self._buffers = None

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()


class Window:
    """MuJoCo's interactive viewer on a screen, fed by `show`.

    Raises MissingDependencyError when there is no display or the viewer cannot open.
    """

    def __init__(self, mechanics: Mechanics) -> None:
        if not has_display():
            raise MissingDependencyError(
                "no display to open a window on; use render_mode 'rgb_array', or set DISPLAY to a running X server"
            )
        self._mechanics = mechanics
        self._stage = _Stage(mechanics, *_COLOURED)
        try:
            import mujoco.viewer

            others = set(threading.enumerate())
            self._viewer = mujoco.viewer.launch_passive(
                self._stage.model, self._stage.data, show_left_ui=False, show_right_ui=False
            )
            self._threads = set(threading.enumerate()) - others
        except Exception as error:  # glfw and the viewer raise several kinds
            raise MissingDependencyError(
                f"the viewer cannot open ({error}); check DISPLAY and OpenGL"
            ) from error

        with self._viewer.lock():
            camera = self._viewer.cam
            camera.lookat[:] = (0.0, 0.0, 0.08)
            camera.distance, camera.azimuth, camera.elevation = 0.7, 120.0, -20.0

    @property
    def open(self) -> bool:
        """False once the user has closed it."""
        return self._viewer.is_running()

    def show(self, env: int = 0, *, temperatures: Mapping[str, float] | None = None) -> None:
        """Bring environment `env` as it is now on the screen; temperatures as in Renderer.frame."""
        with self._viewer.lock():
            self._stage.load(self._mechanics, env, temperatures or {})
        self._viewer.sync()

    def close(self) -> None:
        """Close the window, and wait for the thread that draws it: X kills a process that ends while it still draws."""
        self._viewer.close()
        for thread in self._threads:
            thread.join(_CLOSING)
