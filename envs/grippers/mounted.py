"""Any gripper in place of the shipped one: what is known of it, and how it is mounted over the table."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from dataclasses import fields
from functools import cached_property
from typing import Any

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, distinct_text

from ..bodies import ObjectSpec
from ..limits import CLEARANCE
from .found import FoundGripper
from .mount import (
    DRIVE,
    joint_name,
    mounted,
    palm_height,
)

_SLACK = 0.004  # m beside the object on either side, at which a lone jaw's gripper is centred


class Gripper(FoundGripper):
    """Your own gripper with our fingertips on it, mounted over the table."""

    joints = (DRIVE, DRIVE)

    def __getstate__(self) -> dict[str, Any]:
        """All but what is made of it on demand: specs can't be copied that way."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def scene(self) -> mujoco.MjSpec:
        """See GripperModel."""
        return self._scene.copy()

    @cached_property
    def _scene(self) -> mujoco.MjSpec:
        return mounted(self)

    @cached_property
    def reach(self) -> float:
        """m, from the grasp centre up to the palm, inf where that is not above it."""
        return palm_height(self)

    def wrist_at(self, item: ObjectSpec) -> np.ndarray:
        """See GripperModel. Raises InvalidValueError for an object that does not fit."""
        room = self.widest - CLEARANCE
        if item.width > room:
            raise InvalidValueError(
                f"object {item.name!r} is {distinct_text(1e3 * item.width, 1e3 * room)} mm wide along x, {self.name} "
                f"opens {1e3 * self.widest:.1f} mm: make it at most {math.floor(1e4 * room + 1e-6) / 10:.1f} mm or "
                "turn it (yaw)"
            )
        if item.width < self.narrowest:
            raise InvalidValueError(
                f"object {item.name!r} is {distinct_text(1e3 * item.width, 1e3 * self.narrowest)} mm thin along x, "
                f"{self.name} closes to {1e3 * self.narrowest:.1f} mm: its pads would never meet it; make it thicker "
                "or turn it (yaw)"
            )
        height = max(item.grasp_height, item.size[2] + CLEARANCE - self.reach)
        if item.elements and height != item.grasp_height:
            raise InvalidValueError(
                f"object {item.name!r} is {1e3 * item.size[2]:.1f} mm high, {self.name} reaches "
                f"{1e3 * self.reach:.0f} mm down: its pads miss the elements (mode O); make it lower"
            )
        touching, beside = self.centre(item.width), self.centre(item.width + 2 * _SLACK)
        return np.array([-beside[0], -touching[1], height - touching[2]])

    def centre(self, opening: float) -> np.ndarray:
        """(3,) m, the middle between the pads at that opening, from the wrist's frame."""
        way = self.closing
        return np.array([np.interp(opening, way.openings, way.centres[:, i]) for i in range(3)])

    def rest(self, model: mujoco.MjModel, opening: float) -> tuple[np.ndarray, np.ndarray]:
        """See GripperModel."""
        half = np.clip(opening, self.narrowest, self.widest) / 2
        places, values = [model.joint(DRIVE).qposadr[0]], [half]
        for joint, polynomial in self.polynomials.items():
            places.append(model.joint(joint_name(joint)).qposadr[0])
            values.append(np.polynomial.polynomial.polyval(half, polynomial))
        return np.array(places), np.array(values)

    def control(self, opening: float) -> dict[str, float]:
        """Lengths of the closing actuators (m or rad) at an opening (m) of the pads."""
        way = self.closing
        return {
            one.name: float(np.interp(opening, way.openings, way.controls[:, i]))
            for i, one in enumerate(self.actuators)
        }

    def actuator_limits(self, force: float) -> dict[str, float]:
        """N or N m by closing actuator, for `force` N on the pads."""
        return {one.name: force * abs(one.per_newton) for one in self.actuators}

    def document(self) -> dict[str, Any]:
        """The report for machines, SI units and degrees as the names say."""
        return {
            "name": self.name,
            "palm": self.palm,
            "fingers": self.fingers,
            "pads": self.pads,
            "areas_m2": self.areas,
            "wedges_deg": self.wedges,
            "narrowest_m": self.narrowest,
            "widest_m": self.widest,
            "flat_m": self.flat,
            "strongest_N": self.strongest,
            "reach_m": self.reach,
            "actuators": [
                {
                    "name": a.name,
                    "unit": a.unit,
                    "wide": a.wide,
                    "narrow": a.narrow,
                    "per_newton": a.per_newton,
                }
                for a in self.actuators
            ],
        }

    def __str__(self) -> str:
        lines = [
            f"{self.name}: palm {self.palm!r}, fingertips on {self.fingers[0]!r} and {self.fingers[1]!r}"
        ]
        for side, finger, pad, area, wedge in zip(
            ("left", "right"), self.fingers, self.pads, self.areas, self.wedges, strict=True
        ):
            where = "a given place" if pad == "given" else f"{1e6 * area:.0f} mm2 of geom {pad!r}"
            turned = f", turned by {wedge:.0f} degrees" if wedge > 0.5 else ""
            lines.append(f"  {side:5s} {finger}: {where}{turned}")
        lines.append(
            f"  opens {1e3 * self.narrowest:.1f} to {1e3 * self.widest:.1f} mm between the pads, flat on parallel "
            f"faces from {1e3 * self.flat[0]:.0f} to {1e3 * self.flat[1]:.0f} mm; up to {self.strongest:.3g} N; "
            + (f"{1e3 * self.reach:.0f} mm" if np.isfinite(self.reach) else "nothing")
            + " from the grasp up to the palm"
        )
        for one in self.actuators:
            lines.append(
                f"  actuator {one.name}: {one.wide:.4g} {one.unit} wide, {one.narrow:.4g} {one.unit} narrow, "
                f"{abs(one.per_newton):.3g} {'N' if one.unit == 'm' else 'N m'} for each newton"
            )
        return "\n".join(lines)
