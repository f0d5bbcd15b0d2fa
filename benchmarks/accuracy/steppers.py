"""Textbook time stepping of a semi-discrete press: each returns its preparation and its march, to be timed apart.

A march returns the temperature drop (count + 1,) K at 0, spacing, 2 spacing, ...
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy import sparse
from scipy.integrate import solve_ivp
from scipy.sparse.linalg import splu

from thermograsp.bench.accuracy.semi_discrete import SemiDiscrete

March = Callable[[], np.ndarray]

_SDIRK = 1 - 1 / np.sqrt(2)


def ftcs_limit(system: SemiDiscrete) -> float:
    """s, step below which explicit steps are stable (Gershgorin: a bound, at most a factor 2 below the true one)."""
    return float(
        np.min(np.asarray(system.mass.diagonal(), float) / np.asarray(system.stiffness.diagonal(), float))
    )


def ftcs(system: SemiDiscrete, spacing: float, count: int, of_limit: float = 0.95) -> March:
    """Explicit (forward) Euler, each step that share of the limit, cut so that whole steps make the spacing."""
    substeps = int(np.ceil(spacing / (of_limit * ftcs_limit(system))))
    dt = spacing / substeps
    inverse = sparse.diags(1 / system.mass.diagonal())
    matrix = sparse.csr_matrix(sparse.identity(len(system.first)) - dt * (inverse @ system.stiffness))
    source = dt * (inverse @ system.load)

    return _marching(system, count, substeps, lambda u: matrix @ u + source)


def theta(system: SemiDiscrete, spacing: float, count: int, weight: float, substeps: int = 1) -> March:
    """Backward Euler (weight 1) or Crank-Nicolson (1/2), factored once."""
    dt = spacing / substeps
    solver = splu(sparse.csc_matrix(system.mass + weight * dt * system.stiffness))
    behind = sparse.csr_matrix(system.mass - (1 - weight) * dt * system.stiffness)
    source = dt * system.load

    return _marching(system, count, substeps, lambda u: solver.solve(behind @ u + source))


def sdirk2(system: SemiDiscrete, spacing: float, count: int, substeps: int = 1) -> March:
    """Two-stage L-stable SDIRK of second order (Alexander 1977), factored once."""
    dt = spacing / substeps
    solver = splu(sparse.csc_matrix(system.mass + _SDIRK * dt * system.stiffness))
    mass, stiffness = sparse.csr_matrix(system.mass), sparse.csr_matrix(system.stiffness)

    def step(u: np.ndarray) -> np.ndarray:
        held = mass @ u
        middle = solver.solve(held + _SDIRK * dt * system.load)
        rate = system.load - stiffness @ middle
        return solver.solve(held + dt * ((1 - _SDIRK) * rate + _SDIRK * system.load))

    return _marching(system, count, substeps, step)


def _marching(
    system: SemiDiscrete, count: int, substeps: int, step: Callable[[np.ndarray], np.ndarray]
) -> March:
    def march() -> np.ndarray:
        u, drops = system.first, [system.drop @ system.first]
        for _ in range(count):
            for _ in range(substeps):
                u = step(u)
            drops.append(system.drop @ u)
        return np.array(drops)

    return march


def ivp(
    system: SemiDiscrete, spacing: float, count: int, method: str, rtol: float = 1e-4, atol: float = 1e-3
) -> March:
    """scipy.integrate.solve_ivp with the exact Jacobian (LSODA: its band)."""
    inverse = sparse.diags(1 / system.mass.diagonal())
    jacobian = sparse.csc_matrix(-(inverse @ system.stiffness))
    rows = sparse.csr_matrix(jacobian)
    source = inverse @ system.load
    t = spacing * np.arange(count + 1)
    if method == "LSODA":
        coo = jacobian.tocoo()
        # u is numbered along the radius, so the band is as wide as the plate has cells across
        width = int(np.max(np.abs(coo.row - coo.col)))
        banded = np.zeros((2 * width + 1, len(source)))
        banded[width + coo.row - coo.col, coo.col] = coo.data
        options: dict[str, Any] = {"lband": width, "uband": width, "jac": lambda time, u: banded}
    else:
        options = {"jac": jacobian}

    def march() -> np.ndarray:
        done = solve_ivp(
            lambda time, u: rows @ u + source,
            (0.0, t[-1]),
            system.first,
            method=method,
            t_eval=t,
            rtol=rtol,
            atol=atol,
            **options,
        )
        return system.drop @ done.y

    return march
