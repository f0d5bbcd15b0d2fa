"""What it would change that heat in a ball, cylinder, capsule or ellipsoid flowed in its own shape, where ThermalTouch
has a box of its volume: a flat pad pressed on it in MuJoCo.

    python studies/scenes/round_geoms.py
    python studies/scenes/round_geoms.py sphere --materials rubber --force 30 --surround silicone
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
from unittest import mock

import mujoco
import numpy as np

from thermograsp.touch import Fingertip, ThermalTouch

GEOMS = {
    "sphere 5 mm": ('type="sphere" size=".005"', 0.005),
    "sphere 10 mm": ('type="sphere" size=".01"', 0.01),
    "sphere 20 mm": ('type="sphere" size=".02"', 0.02),
    "cylinder 5 mm": ('type="cylinder" size=".005 .02" euler="90 0 0"', 0.005),
    "cylinder 10 mm": ('type="cylinder" size=".01 .02" euler="90 0 0"', 0.01),
    "cylinder 20 mm": ('type="cylinder" size=".02 .03" euler="90 0 0"', 0.02),
    "capsule 12 mm": ('type="capsule" size=".012 .02" euler="90 0 0"', 0.012),
    "ellipsoid 30 x 20 x 5 mm": ('type="ellipsoid" size=".03 .02 .005"', 0.005),
}
"""By their radii, and how high they are, m."""
MATERIALS = "aluminium", "ceramic", "rubber"
STEP = 0.002  # s


def felt(
    geom: str, high: float, made_of: str, force: float, seconds: float, *, own: bool, surround: str | None
) -> np.ndarray:
    """K of the drop every 0.1 s."""
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep="{STEP}" gravity="0 0 0"/><worldbody>
      <body name="thing"><geom name="thing" {geom} friction="0"/></body>
      <body name="tip" pos="0 0 {high + 0.0045}"><joint name="tip" type="slide" axis="0 0 -1" damping="100"/>
      <geom name="tip" type="box" size=".01 .01 .004" mass=".05" friction="0"/></body>
      </worldbody><actuator><motor joint="tip"/></actuator></mujoco>""")
    with mock.patch("thermograsp.touch.scene.own_shape._has_own", lambda *_: own):
        touch = ThermalTouch(
            model,
            fingertips={"tip": Fingertip("tip", surround=surround)},
            objects={"thing": made_of},
            chain="ideal",
            air=0.0,
        )
    assert (touch._shapes[0].solid is not None) == own
    data = mujoco.MjData(model)
    data.ctrl[:] = force
    found = []
    for n in range(round(seconds / STEP)):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if n % 50 == 49:
            found.append(reading.temperature_drop[0])
    return np.array(found)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description="What boxes in place of round geoms change.")
    parser.add_argument("geom", nargs="?", default="", help="part of a geom's name")
    parser.add_argument("--materials", nargs="+", default=MATERIALS)
    parser.add_argument("--force", type=float, default=30.0, help="N")
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--surround", default=None, help="material of the pad around the sensor")
    options = parser.parse_args()
    for name, (geom, high) in GEOMS.items():
        if options.geom not in name:
            continue
        for made_of in options.materials:
            words = geom, high, made_of, options.force, options.seconds
            box, own = (felt(*words, own=each, surround=options.surround) for each in (False, True))
            most = np.abs(box - own).max()
            print(f"{name:26}{made_of:11}largest {own.max():.2f} K, box {most:.3f} K off", flush=True)


if __name__ == "__main__":
    main()
