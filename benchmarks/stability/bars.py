"""Two bars that touch: the smallest problem on which time stepping of a contact can fail, and the steps that are tried.

Each bar has CELLS cells of unit length and unit diffusivity; sides and far ends are adiabatic. The first is of unit
conductivity k and starts at 1; the second, of LIGHT times its conductivity and heat capacity, starts at 0. Between the
middles of the cells that face each other stands the conductance h. So the Fourier number of a step is
F = alpha dt/dx^2, and the contact's stiffness beta = h dx/k. No temperature may ever leave [0, 1], and the gap between
the two faces only shrinks while they touch.

Arrays: P rows, one a pair (F, beta); n = 2 CELLS temperatures, the first bar's from its far end to the contact, then
the second's from the contact on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.linalg import eigh

from thermograsp.thermal.network import coupling

CELLS = 16
FIRST, SECOND = CELLS - 1, CELLS  # the cells that face each other
LIGHT = 0.1
"""Conductivity and heat capacity of the second bar over the first's: an object that conducts worse than the sensor."""
PULL = 1 + 1 / LIGHT
"""How much more a flux changes the gap than the first face."""
WEIGHTS = np.repeat([1.0, LIGHT], CELLS)
"""(n,) heat capacities of the cells."""

History = Iterator[np.ndarray]
"""Temperatures (P, n) after each step."""
Scheme = Callable[[np.ndarray, np.ndarray, np.ndarray], History]
"""scheme(F (P,), beta (P,), closed (steps, P)): a step for each row of closed, whose contacts are closed or open."""


def first_temperatures(rows: int) -> np.ndarray:
    """(rows, n)."""
    return np.tile(np.repeat([1.0, 0.0], CELLS), (rows, 1))


def conduction(beta: np.ndarray) -> np.ndarray:
    """(P, n, n): u' = -conduction u in units of dx and diffusivity."""
    matrix = np.zeros((len(beta), 2 * CELLS, 2 * CELLS))
    for i in range(2 * CELLS - 1):
        link = beta if i == FIRST else np.full(len(beta), WEIGHTS[i])
        for a, b in ((i, i + 1), (i + 1, i)):
            matrix[:, a, a] += link / WEIGHTS[a]
            matrix[:, a, b] -= link / WEIGHTS[a]
    return matrix


def bar() -> np.ndarray:
    """(CELLS, CELLS) of one bar by itself, the contact at its cell 0."""
    matrix = np.diag(np.full(CELLS, 2.0)) - np.eye(CELLS, k=1) - np.eye(CELLS, k=-1)
    matrix[0, 0] = matrix[-1, -1] = 1.0
    return matrix


def surface_admittance(sigma: np.ndarray) -> np.ndarray:
    """Flux into the contact cell per temperature of it, where (sigma + conduction) u = flux; sigma (P,)."""
    unit = np.linalg.inv(sigma[:, None, None] * np.eye(CELLS) + bar())
    return 1 / unit[:, 0, 0]


def _repeat(shut: np.ndarray, open_: np.ndarray, closed: np.ndarray) -> History:
    """Steps by matrices (P, n, n), one for the closed contact and one for the open one."""
    u = first_temperatures(len(shut))[..., None]
    for now in closed:
        u = shut @ u if now.all() else np.where(now[:, None, None], shut @ u, open_ @ u)
        yield u[..., 0]


def _one_step(function: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Scheme:
    """A scheme from (identity, F conduction) -> step matrix."""

    def scheme(fourier: np.ndarray, beta: np.ndarray, closed: np.ndarray) -> History:
        shut, open_ = (
            function(np.eye(2 * CELLS), fourier[:, None, None] * conduction(stiffness))
            for stiffness in (beta, np.zeros_like(beta))
        )
        yield from _repeat(shut, open_, closed)

    return scheme


_GAMMA = 1 - 1 / np.sqrt(2)

ftcs = _one_step(lambda one, z: one - z)
backward_euler = _one_step(lambda one, z: np.linalg.inv(one + z))
crank_nicolson = _one_step(lambda one, z: np.linalg.solve(one + z / 2, one - z / 2))
sdirk2 = _one_step(
    lambda one, z: np.linalg.solve(
        one + _GAMMA * z, np.linalg.solve(one + _GAMMA * z, one - (1 - 2 * _GAMMA) * z)
    )
)


def lagged_flux(fourier: np.ndarray, beta: np.ndarray, closed: np.ndarray) -> History:
    """Staggered: both bars by backward Euler, the flux between them from the temperatures before the step."""
    separate = conduction(np.zeros_like(beta))
    inverse = np.linalg.inv(np.eye(2 * CELLS) + fourier[:, None, None] * separate)
    exchange = fourier[:, None, None] * (conduction(beta) - separate)
    yield from _repeat(inverse @ (np.eye(2 * CELLS) - exchange), inverse, closed)


def dirichlet_neumann(fourier: np.ndarray, beta: np.ndarray, closed: np.ndarray) -> History:
    """Staggered: the first bar sees the second's face as it was; the flux that it finds goes into the
    second. Both by backward Euler."""
    count, e = len(beta), np.eye(CELLS)[0]
    base = np.eye(CELLS) + fourier[:, None, None] * bar()
    film = fourier * beta
    free = np.linalg.inv(base)
    held = np.linalg.inv(base + film[:, None, None] * np.outer(e, e))
    u, v = np.ones((count, CELLS)), np.zeros((count, CELLS))
    for now in closed:
        first = np.where(now[:, None, None], held, free)
        face = v[:, :1]
        u = np.einsum("pij,pj->pi", first, u + (film * now)[:, None] * face * e)
        flux = (beta * now)[:, None] * (u[:, :1] - face)
        v = np.einsum("pij,pj->pi", free, v + fourier[:, None] * flux / LIGHT * e)
        yield np.concatenate((u[:, ::-1], v), axis=1)


def first_order_hold(fourier: np.ndarray, beta: np.ndarray, closed: np.ndarray) -> History:
    """Each bar exactly, under a flux that runs straight from its value at the step's begin to that at its end."""
    decay, early, late = _hold(fourier)
    count = len(beta)
    u, v = np.ones((count, CELLS)), np.zeros((count, CELLS))
    for now in closed:
        stiffness = beta * now
        flux = stiffness * (u[:, 0] - v[:, 0])
        u = np.einsum("pij,pj->pi", decay, u) - early * flux[:, None]
        v = np.einsum("pij,pj->pi", decay, v) + early * flux[:, None] / LIGHT
        flux = stiffness * (u[:, 0] - v[:, 0]) / (1 + PULL * stiffness * late[:, 0])
        u, v = u - late * flux[:, None], v + late * flux[:, None] / LIGHT
        yield np.concatenate((u[:, ::-1], v), axis=1)


def _hold(fourier: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(P, n, n) decay of a bar over a step, and (P, n) what a unit flux leaves that falls to, or rises from, 0."""
    rates, vectors = eigh(bar())
    rates[0] = 0.0
    z = fourier[:, None] * rates
    safe = np.where(z < 1e-5, 1.0, z)
    whole = np.where(z < 1e-5, 1 - z / 2, -np.expm1(-safe) / safe)  # integral of exp(-z x), 0 <= x <= 1
    falls = np.where(
        z < 1e-5, 0.5 - z / 3, (-np.expm1(-safe) / safe - np.exp(-safe)) / safe
    )  # ... of x exp(-z x)
    port = vectors[0]
    decay = np.einsum("ik,pk,jk->pij", vectors, np.exp(-z), vectors)
    early = fourier[:, None] * np.einsum("ik,pk,k->pi", vectors, falls, port)
    late = fourier[:, None] * np.einsum("ik,pk,k->pi", vectors, whole - falls, port)
    return decay, early, late


def hold_limit(fourier: np.ndarray) -> np.ndarray:
    """beta at which a first-order hold turns the flux around in its first step: PULL beta w = 1, w what the flux at
    the begin leaves on the first face."""
    return 1 / (PULL * _hold(fourier)[1][:, 0])


def modal_bars() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The two bars for thermal.coupling: rates (n,), ports (n, 1) and the temperatures' rows (n, n) on the states,
    which start at 0, above what each bar started from."""
    rates, vectors = eigh(bar())
    rates[0] = 0.0
    rows = np.zeros((2 * CELLS, 2 * CELLS))
    rows[:CELLS, :CELLS], rows[CELLS:, CELLS:] = vectors[::-1], vectors / np.sqrt(LIGHT)
    ports = np.concatenate((-vectors[0], vectors[0] / np.sqrt(LIGHT)))[:, None]
    return np.concatenate((rates, rates)), ports, rows


def package_step(fourier: np.ndarray, beta: np.ndarray, closed: np.ndarray, single: bool = False) -> History:
    """The package's step, thermal.coupling. single: in float32."""
    rates, ports, rows = modal_bars()
    real, complex_ = (np.float32, np.complex64) if single else (np.float64, np.complex128)
    kinds, which = np.unique(fourier, return_inverse=True)
    systems = [_cast(coupling.propagator(rates, ports, dt), real, complex_) for dt in kinds]
    states = np.zeros((len(beta), 2 * CELLS), real)
    start, rows = first_temperatures(len(beta)), rows.astype(real)
    groups = [np.flatnonzero(which == kind) for kind in range(len(kinds))]
    for now in closed:
        weight = (beta * now)[:, None].astype(real)
        for chosen, system in zip(groups, systems, strict=True):
            difference = np.ones((len(chosen), 1), real)
            states[chosen] = coupling.step(system, states[chosen], weight[chosen], difference)[0]
        yield start + states @ rows.T


def _cast(system: coupling.Propagator, real: type, complex_: type) -> coupling.Propagator:
    return coupling.Propagator(
        real(system.dt),
        system.rates.astype(real),
        system.ports.astype(real),
        system.scale.astype(complex_),
        system.gram.astype(complex_),
    )
