"""The hand with heat inside MuJoCo's step, how it is told to go, and what is read of it; what such tests need."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import os
import shutil

import mujoco
import mujoco.rollout
import numpy as np
import pytest

from thermograsp.thermal import Thermostat
from thermograsp.thermal.stack import Pid, heated_stack
from thermograsp.touch import Fingertip, SensorElement, ThermalBody, ThermalTouch, install

from . import hand
from .hand import PADS

NEEDS_COMPILER = pytest.mark.skipif(
    shutil.which(os.environ.get("CC", "cc")) is None, reason="needs a C compiler to build the plugin"
)
TIER = pytest.mark.skipif(
    not os.environ.get("THERMOGRASP_ENGINE"), reason="takes minutes and gcc's sanitizers: make test-engine"
)
SPECS_TAKE_PLUGINS = hasattr(mujoco.MjSpec, "activate_plugin")
NEEDS_SPECS = pytest.mark.skipif(not SPECS_TAKE_PLUGINS, reason="specs take plugins from MuJoCo 3.3.2 on")
NEEDS_RECORDS = pytest.mark.skipif(
    not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"), reason="this MuJoCo has no contact sensors"
)
ROUND_OFF = 1e-9  # K; the two sum in another order
OBJECTS = {"can": ThermalBody("aluminium", 5.0), "ball": "glass"}
HEATED, WARM_CORE = heated_stack("heated_thermistor"), heated_stack("biotac_like")
CONTROLLER = Pid(setpoint=36.0, proportional=2e3, integral=500.0, derivative=5e3, limit=10.0)
ORDERS = (10.0, 0.0, 0.0), (10.0, 0.015, 0.0), (-5.0, 0.0, 0.0), (10.0, -0.015, 0.01), (6.0, 0.0, -0.005)
"""Forces N, and places m of the palm, each for a while: touches, slips, lets go, comes back elsewhere."""
FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS


def keep_boxes(patch: pytest.MonkeyPatch) -> None:
    """For ThermalTouch, whose heat in meshes flows in boxes then, as in MuJoCo's step."""
    patch.setattr("thermograsp.touch.thermal_touch.own_shapes", lambda model, shapes, pads: tuple(shapes))


def order(data: mujoco.MjData, force: float, x: float, z: float, fingers: tuple[str, ...] = ()) -> None:
    hand.press(data, force, *fingers)
    data.actuator("palm").ctrl[0], data.actuator("palm_z").ctrl[0] = x, z


def orders(steps: int) -> np.ndarray:
    """(steps * len(ORDERS), 5) controls."""
    rows = [[force, force, force, x, z] for force, x, z in ORDERS]
    return np.repeat(np.array(rows), steps, axis=0)


def states(model: mujoco.MjModel, data: mujoco.MjData, kind: mujoco.mjtState = FULL) -> np.ndarray:
    found = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, found, kind)
    return found


def voltages(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    mujoco.mj_forward(model, data)
    return data.sensor("heat").data.copy()


def sent(touch: ThermalTouch) -> np.ndarray:
    """(S,) V that the sensors send to their electronics."""
    sensors = (*touch._pads, *touch._glued)
    return touch._heat.sent[0] * [1.0 if pad.heated else pad.stack.seebeck for pad in sensors]


def per_kelvin(touch: ThermalTouch) -> np.ndarray:
    """(S,) V/K of the sensors, about."""
    return np.array([pad.stack.seebeck for pad in (*touch._pads, *touch._glued)])


def with_backs(*each: dict) -> dict:
    """The hand with a fingertip of each of these."""
    return {
        "fingertips": {
            name: Fingertip(pad, **words) for (name, pad), words in zip(PADS.items(), each, strict=True)
        }
    }


BACKS = with_backs({"sensor": HEATED}, {"thermostat": Thermostat(power_limit=0.3)}, {"sensor": None})
BOXED = hand.scene().replace('type="cylinder" size="0.03 .05"', 'type="box" size=".03 .03 .05"')
GLUED = SensorElement((0.03, 0.001, 0.002), (1, 0, 0)), SensorElement((-0.015, 0.03, 0.0), (0, 1, 0))
EVERYTHING = {**BACKS, "objects": {"can": ThermalBody("glass", 60.0, elements=GLUED), "ball": "wood"}}
"""In the scene where the can is a box: of what may be behind an element, and elements on an object."""


def furthest(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch) -> float:
    """K between the two in the next steps."""
    most = 0.0
    for n in range(150):
        mujoco.mj_step(model, data)
        touch.update(data)
        if n % 10 == 9:
            difference = voltages(model, data) - sent(touch)
            most = max(most, float(np.abs(difference / per_kelvin(touch)).max()))
    return most


def installed() -> mujoco.MjModel:
    """The hand with bare fingertips."""
    if not SPECS_TAKE_PLUGINS:
        pytest.skip("specs take plugins from MuJoCo 3.3.2 on")
    return install(mujoco.MjSpec.from_string(hand.scene()), fingertips=PADS, objects=OBJECTS)
