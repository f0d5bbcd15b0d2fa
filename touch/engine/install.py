"""Heat in a scene's spec: one instance of the plugin, whose sensor holds the voltages of all fingertips."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Mapping

import mujoco

from thermograsp.errors import InvalidValueError, MissingDependencyError, celsius, non_negative, positive

from ...thermal import Material
from ..contacts import require_sensors
from ..scene import (
    Fingertip,
    ThermalBody,
    bodies,
    glued_elements,
    pads,
    refuse_sleep,
    samples_in,
    warn_of_boxes,
    warn_of_contact_filters,
    warn_of_fixed_bodies,
    warn_of_wide_faces,
    whole_steps,
)
from .library import load_plugin
from .numbers import packed

PLUGIN = "thermograsp.heat"
_UNNAMED = "thermograsp:heat:"


def install(
    spec: mujoco.MjSpec,
    *,
    fingertips: Mapping[str, str | Fingertip],
    objects: Mapping[str, str | Material | ThermalBody] | None = None,
    name: str = "heat",
    dt: float = 0.02,
    tolerance: float = 0.05,
    ambient: float = 24.0,
    air: float = 5.0,
) -> mujoco.MjModel:
    """Adds a sensor of that name to the spec and returns the compiled model: its data are the voltages (S,) V of the
    fingertips and then of the elements on objects, in ThermalTouch's orders, before low-pass, noise and converter. The
    heat is advanced in mj_step, and what it remembers is part of the simulation's state (mjSTATE_PLUGIN).

    The arguments are those of ThermalTouch, and so are the voltages'. The pads, objects and the timestep are those that
    the spec has now: install after everything else. Geoms without a name get one. Raises what ThermalTouch and
    load_plugin do, and MissingDependencyError below MuJoCo 3.3.2."""
    if not hasattr(mujoco.MjSpec, "activate_plugin"):
        raise MissingDependencyError(
            "install adds a plugin to the spec, which MuJoCo's Python can do from 3.3.2 on; this is "
            f"{mujoco.__version__}: pip install 'mujoco>=3.3.2', or call ThermalTouch.update after every step"
        )
    if not isinstance(spec, mujoco.MjSpec):
        raise InvalidValueError(f"spec must be a mujoco.MjSpec, got {type(spec).__name__}")
    if not isinstance(name, str) or not name:
        raise InvalidValueError(f"name must be a sensor's name, got {name!r}")
    if any(taken.name == name for taken in (*spec.sensors, *spec.plugins)):
        raise InvalidValueError(f"the spec has a sensor or plugin {name!r}: give install another name")
    celsius("ambient (°C)", ambient)
    non_negative("air (W/(m2 K))", air)
    positive("tolerance (K)", tolerance)
    for label, made_of in (objects or {}).items():
        if isinstance(made_of, list | tuple):
            raise InvalidValueError(
                f"object {label!r}: a list of {len(made_of)} materials is one for each of many worlds, and a model "
                "with heat inside its step is one world's: give one material, and install into a spec for each, or use "
                "ThermalTouch(model, worlds=...)"
            )
    load_plugin()
    model = spec.compile()
    require_sensors(model)
    substeps = whole_steps(positive("dt (s)", dt), float(model.opt.timestep))
    shapes = bodies(model, objects, ambient)
    found = pads(model, fingertips, shapes)
    warn_of_fixed_bodies(model, fingertips, found, shapes)
    warn_of_contact_filters(model, found, shapes)
    warn_of_wide_faces(model, found)
    refuse_sleep(model, found, shapes)
    for shape in shapes:
        if shape.contents is not None:
            raise InvalidValueError(
                f"object {shape.name!r}: heat inside MuJoCo's step knows no contents: leave contents out, or call "
                "ThermalTouch.update after every step"
            )
    for pad in found:
        if pad.surround is not None:
            raise InvalidValueError(
                f"fingertip {pad.label!r}: heat inside MuJoCo's step knows a sensor without the pad around it: leave "
                "surround out, or call ThermalTouch.update after every step"
            )
    warn_of_boxes(
        model, shapes, "in MuJoCo's step there are networks of boxes alone; ThermalTouch knows its shape"
    )
    numbers = packed(
        model,
        found,
        glued_elements(model, shapes, ambient),
        shapes,
        steps=substeps // samples_in(substeps, dt),
        tolerance=tolerance,
        film=air,
        ambient=ambient,
    )
    geoms = [geom for pad in found for geom in pad.geoms] + [
        geom for shape in shapes for geom in shape.touched
    ]
    spec.activate_plugin(PLUGIN)
    plugin = spec.add_plugin(name=name, plugin_name=PLUGIN, active=True)
    plugin.config = {"geoms": ",".join(_names(spec, geoms)), "numbers": numbers}
    sensor = spec.add_sensor(name=name, type=mujoco.mjtSensor.mjSENS_PLUGIN)
    sensor.plugin.active, sensor.plugin.name, sensor.plugin.plugin_name = True, name, PLUGIN
    return spec.compile()


def _names(spec: mujoco.MjSpec, geoms: list[int]) -> list[str]:
    named, found = {geom.id: geom for geom in spec.geoms}, []
    for number in geoms:
        geom = named[number]
        if not geom.name:
            geom.name = f"{_UNNAMED}{number}"
        if "," in geom.name:
            raise InvalidValueError(
                f"geom {geom.name!r}: rename it, as the plugin reads names between commas"
            )
        found.append(geom.name)
    return found
