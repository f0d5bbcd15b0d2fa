"""What a robot's actuators move, and where: forward kinematics of any MJCF mechanism, its couplings kept.

A coordinate is an actuator's length: m or rad times gear of a joint, m of a tendon. Joints that equalities couple to
actuated ones (joint, tendon, connect, weld) follow them.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from thermograsp.errors import GripperError, InvalidValueError, unknown_name

_LINEAR = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
_COUPLED = 1e-9  # of a constraint's derivative that counts
_CLOSED = 1e-7  # m or rad, at which couplings are kept
_STEPS = 12  # of Gauss-Newton


@dataclass(frozen=True, slots=True)
class Coordinate:
    """One actuator. name, number (in the model), unit: "m" or "rad". low, high: its range. slope (nv,): how the joints
    move with it."""

    name: str
    number: int
    unit: str
    low: float
    high: float
    slope: np.ndarray


_SMALL_TURN = 0.05  # rad, as ranges meant in radians look when they are read as degrees


def angle_hint(coordinates: Sequence[Coordinate]) -> str:
    """What to look at where the coordinates that move the fingers hardly turn; "" where they do, or one slides."""
    turns = [one.high - one.low for one in coordinates if one.unit == "rad"]
    if not turns or len(turns) < len(coordinates):
        return ""
    if max(turns) < _SMALL_TURN:
        return (
            f"; its joints turn by {math.degrees(max(turns)):.2g} degrees at most: MuJoCo reads angles as degrees. If "
            'the file is in radians, it has to say so: <compiler angle="radian"/>'
        )
    return ""


class Mechanism:
    """The moving parts of a compiled model. actuators: names of those to use, None for all that move joints.

    Raises GripperError where nothing is actuated, UnknownNameError for a name that is none.
    """

    def __init__(self, model: mujoco.MjModel, actuators: Sequence[str] | None = None) -> None:
        self.model = model
        model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        for bit in ("CONTACT", "LIMIT", "FRICTIONLOSS"):
            model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{bit}"))
        self.data = mujoco.MjData(model)
        self.reference = model.qpos0.copy()
        mujoco.mj_forward(model, self.data)
        self._dof_qpos = np.full(model.nv, -1)
        for joint in range(model.njnt):
            if model.jnt_type[joint] in _LINEAR:
                self._dof_qpos[model.jnt_dofadr[joint]] = model.jnt_qposadr[joint]
        self.coordinates = self._find(actuators)
        self.middle = np.array([(c.low + c.high) / 2 for c in self.coordinates])
        self.low = np.array([c.low for c in self.coordinates])
        self.high = np.array([c.high for c in self.coordinates])
        self.first = np.array([self.data.actuator_length[c.number] for c in self.coordinates])
        driven = np.zeros(model.nv, bool)
        for coordinate in self.coordinates:
            driven |= coordinate.slope != 0
        self.moved = self._reach(driven)
        self._followers = np.flatnonzero(self.moved & ~driven)
        self._coupled = bool((self._jacobian()[1] != 0).any())

    def _find(self, names: Sequence[str] | None) -> list[Coordinate]:
        model, moments = self.model, self._moments()
        known = [model.actuator(i).name or f"#{i}" for i in range(model.nu)]
        if isinstance(names, str) or not isinstance(names, Sequence | None):
            raise InvalidValueError(f"actuators must be a list of names, got {names!r}")
        for name in names or ():
            if name not in known:
                raise unknown_name("actuator", name, known)
        found: list[Coordinate] = []
        for number, moment in enumerate(moments):
            usable = (moment != 0).any() and (self._dof_qpos[moment != 0] >= 0).all()
            if not usable or (names is not None and known[number] not in names):
                continue
            slope = moment / (moment @ moment)
            if any(
                abs(slope @ c.slope) > 0.999 * np.linalg.norm(slope) * np.linalg.norm(c.slope) for c in found
            ):
                continue  # a second actuator of the same joint
            low, high = self._range(number, moment)
            if high > low:
                found.append(Coordinate(known[number], number, self._unit(moment), low, high, slope))
        if not found:
            raise GripperError(
                f"no actuator moves a joint with a range (actuators: {', '.join(known) or 'none'}): give the closing "
                "joints actuators, and ranges"
            )
        return found

    def _moments(self) -> np.ndarray:
        """(nu, nv): how each actuator's length changes with the joints."""
        model, data = self.model, self.data
        dense = np.zeros((model.nu, model.nv))
        if model.nu:
            mujoco.mju_sparse2dense(
                dense, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
            )
        return dense

    def _unit(self, moment: np.ndarray) -> str:
        types = {int(self.model.jnt_type[self.model.dof_jntid[dof]]) for dof in np.flatnonzero(moment)}
        return "rad" if types == {_LINEAR[0]} else "m"

    def _range(self, number: int, moment: np.ndarray) -> tuple[float, float]:
        """The actuator's lengths: within its joints' limits and, of a position servo, its controls'."""
        model = self.model
        low, high, first = 0.0, 0.0, self.data.actuator_length[number]
        for dof in np.flatnonzero(moment):
            joint = model.dof_jntid[dof]
            limits = model.jnt_range[joint] if model.jnt_limited[joint] else (-np.inf, np.inf)
            ends = sorted(moment[dof] * (end - self.reference[self._dof_qpos[dof]]) for end in limits)
            low, high = low + ends[0], high + ends[1]
        low, high = first + low, first + high
        stiffness = -model.actuator_biasprm[number, 1]
        rate = model.actuator_dyntype[number] == mujoco.mjtDyn.mjDYN_INTEGRATOR  # its control is no set point
        limited, limits = (
            (model.actuator_actlimited, model.actuator_actrange)
            if rate
            else (model.actuator_ctrllimited, model.actuator_ctrlrange)
        )
        if stiffness > 0 and limited[number]:
            gain, offset = model.actuator_gainprm[number, 0], model.actuator_biasprm[number, 0]
            ends = sorted((gain * c + offset) / stiffness for c in limits[number])
            low, high = max(low, ends[0]), min(high, ends[1])
        return (low, high) if np.isfinite(low) and np.isfinite(high) else (0.0, 0.0)

    def _reach(self, driven: np.ndarray) -> np.ndarray:
        """(nv,) bool: the joints that move with the driven ones through couplings."""
        _, jacobian = self._jacobian()
        moved = driven.copy()
        while True:
            linked = (np.abs(jacobian[:, moved]) > _COUPLED).any(axis=1)
            grown = moved | (np.abs(jacobian[linked]) > _COUPLED).any(axis=0) & (self._dof_qpos >= 0)
            if (grown == moved).all():
                return moved
            moved = grown

    def _jacobian(self) -> tuple[np.ndarray, np.ndarray]:
        """Residuals (n,) and derivatives (n, nv) of all equalities, now."""
        data = self.data
        rows = data.efc_type[: data.nefc] == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        jacobian = (
            np.array(data.efc_J).reshape(-1, self.model.nv)[: data.nefc]
            if data.nefc
            else np.zeros((0, self.model.nv))
        )
        return data.efc_pos[: data.nefc][rows], jacobian[rows]

    def pose(self, values: np.ndarray) -> np.ndarray:
        """Puts the model where its coordinates are the values; returns qpos, a copy."""
        qpos = self.reference.copy()
        step = sum(
            (value - first) * c.slope
            for value, first, c in zip(values, self.first, self.coordinates, strict=True)
        )
        qpos[self._dof_qpos[self.moved]] += np.asarray(step)[self.moved]
        self.data.qpos[:] = qpos
        if not self._coupled:
            mujoco.mj_kinematics(self.model, self.data)
            return qpos
        # First what is not driven follows; where that is not enough, all of it gives way.
        for joints in (self._followers, np.flatnonzero(self.moved)):
            for _ in range(_STEPS if len(joints) else 0):
                mujoco.mj_fwdPosition(self.model, self.data)
                residual, jacobian = self._jacobian()
                rows = (np.abs(jacobian[:, self.moved]) > _COUPLED).any(axis=1)
                if not rows.any() or np.abs(residual[rows]).max() < _CLOSED:
                    return self.data.qpos.copy()
                change = np.linalg.lstsq(jacobian[np.ix_(rows, joints)], -residual[rows], rcond=1e-6)[0]
                self.data.qpos[self._dof_qpos[joints]] += change
        mujoco.mj_fwdPosition(self.model, self.data)
        return self.data.qpos.copy()

    def show(self, qpos: np.ndarray) -> None:
        """Puts the model into a posture."""
        self.data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)

    def place(self, body: int) -> tuple[np.ndarray, np.ndarray]:
        """Position (3,) m and axes (3, 3) of a body, now."""
        return self.data.xpos[body].copy(), self.data.xmat[body].reshape(3, 3).copy()

    def moves(self, body: int) -> list[int]:
        """Which coordinates move the body."""
        start, found = self.pose(self.middle), []
        self.show(start)
        before = self.data.xpos[body].copy(), self.data.xmat[body].copy()
        for number, coordinate in enumerate(self.coordinates):
            values = self.middle.copy()
            values[number] += 0.1 * (coordinate.high - coordinate.low)
            self.pose(values)
            turned = np.abs(self.data.xmat[body] - before[1]).max()
            if max(turned, np.abs(self.data.xpos[body] - before[0]).max()) > 1e-6:
                found.append(number)
        return found
