"""How MuJoCo computes a grasp: time step, integrator, friction and the softness of contacts."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import mujoco

from thermograsp.errors import (
    InvalidValueError,
    numbers,
    positive,
    unknown_name,
    whole_number,
)

_INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
}
_CONES = {"pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL, "elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC}
_SOLVERS = {
    "PGS": mujoco.mjtSolver.mjSOL_PGS,
    "CG": mujoco.mjtSolver.mjSOL_CG,
    "Newton": mujoco.mjtSolver.mjSOL_NEWTON,
}


@dataclass(frozen=True, slots=True)
class SolverSettings:
    """MuJoCo's knobs that decide how well a grasp holds, and at what cost; `thermograsp bench grasp` charts them.

    timestep: s, of a substep; a control step has ten. integrator: `discrete` treats contacts implicitly, so that stiff
    ones do not shake. cone: the friction cone, `elliptic` is round. impratio: stiffness of friction over that of the
    normal direction; what is held creeps in proportion to its inverse. solver, iterations: of the constraint forces,
    iterations the most per substep. noslip_iterations: of a pass afterwards that pulls creep back. solref: softness of
    the object's contacts, (time constant s, damping ratio), or (-stiffness, -damping) per unit of effective mass,
    1/s2 and 1/s. solimp: their impedance (at no depth, at full depth, depth m between the two); 1 would be rigid.
    refsafe: raise time constants that are too short for the time step.

    Names and meanings are MuJoCo's (its documentation, "Computation" and "XML reference: option").
    Raises UnknownNameError for a name, InvalidValueError for a number out of range.
    """

    timestep: float = 0.002
    integrator: Literal["Euler", "RK4", "implicit", "implicitfast", "discrete"] = "discrete"
    cone: Literal["pyramidal", "elliptic"] = "elliptic"
    impratio: float = 100.0
    solver: Literal["PGS", "CG", "Newton"] = "Newton"
    iterations: int = 100
    noslip_iterations: int = 0
    solref: tuple[float, float] = (0.004, 1.0)
    solimp: tuple[float, float, float] = (0.95, 0.99, 0.001)
    refsafe: bool = True

    def __post_init__(self) -> None:
        positive("timestep (s)", self.timestep)
        positive("impratio", self.impratio)
        for kind, known in (("integrator", _INTEGRATORS), ("cone", _CONES), ("solver", _SOLVERS)):
            if getattr(self, kind) not in known:
                raise unknown_name(kind, getattr(self, kind), known)
        for name, least in (("iterations", 1), ("noslip_iterations", 0)):
            whole_number(name, getattr(self, name), least)
        first, second = numbers("solref", self.solref, 2)
        if not (first > 0 and second > 0) and not (first < 0 and second <= 0):
            raise InvalidValueError(
                f"solref {self.solref}: give (time constant s, damping ratio), both above 0, "
                "or (-stiffness 1/s2, -damping 1/s)"
            )
        low, high, _ = (positive("solimp", value) for value in self.solimp)
        if not low <= high < 1:
            raise InvalidValueError(
                f"solimp {self.solimp}: give impedances d0 <= d1 below 1 and a depth in m"
            )

    def apply(self, option: mujoco.MjOption) -> None:
        """Write all but the contacts' softness, which is a property of geoms, into a model's or a spec's options."""
        option.timestep, option.impratio = self.timestep, self.impratio
        option.integrator = _INTEGRATORS[self.integrator]
        option.cone, option.solver = _CONES[self.cone], _SOLVERS[self.solver]
        option.iterations, option.noslip_iterations = self.iterations, self.noslip_iterations
        if not self.refsafe:
            option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)


SHIPPED = SolverSettings()
"""What every environment uses; `thermograsp bench grasp` holds it to the Pareto front."""
