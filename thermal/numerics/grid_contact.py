"""Two finite-volume bodies and the cells through which they touch: rates of heat, and one implicit stage of both.

The bodies touch along few cells. Within a step each body is solved by itself (finite_volume), and the heat that
crosses follows from a dense system as large as the number of touching cells, (I + sqrt(U) G sqrt(U)) y = sqrt(U) gap,
with U the cells' conductances and G the bodies' response. It is symmetric positive definite for every conductance from
0 to infinity, and only it changes when the conductance does.

Temperatures are differences to the object's first temperature, which is also the air's. Arrays as in finite_volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve, lu_factor, lu_solve

from .finite_volume import Body, FactoredBody

SENSOR, OBJECT = 0, 1
TOP, BOTTOM = 0, -1


@dataclass(frozen=True)
class Interface:
    """Cells that touch: (i, j) next to the middle of the sensor's row and of the object's top.

    above: body whose bottom (or, for the thermostat, None) lies above; below: body whose top lies below. bonded: the
    two are one solid, else the press's conductance is between them.
    """

    above: int | None
    below: int
    cells: tuple[int, int]
    bonded: bool


@dataclass(frozen=True)
class Grid:
    """The two bodies of a press and where they touch; interfaces[0] is the contact that opens.

    The sensor's cells in depth begin at the thermostat, the object's at the touched face. interfaces[-1] is the one on
    the object. thermostat: K above the object's first temperature. first: the bodies' temperatures at first.
    sensed: (start, stop) cells in depth of the sensor's sensed layer.
    """

    bodies: tuple[Body, Body]
    interfaces: tuple[Interface, ...]
    thermostat: float
    first: tuple[float, float]
    sensed: tuple[int, int]

    def contact_area(self, interface: Interface) -> np.ndarray:
        """(i, j) m2 of the touching cells."""
        i, j = interface.cells
        return self.bodies[interface.below].area[:i, :j]

    def conductances(self, interface: Interface, conductance: float) -> np.ndarray:
        """(i, j) W/K between the middles of the cells above (or the thermostat) and below."""
        half = self.bodies[interface.below].half_resistance[TOP]
        if interface.above is not None:
            half += self.bodies[interface.above].half_resistance[BOTTOM]
        unit = 1 / half if interface.bonded else conductance / (1 + conductance * half)
        return unit * self.contact_area(interface)

    def gap(
        self, interface: Interface, rows: Sequence[tuple[np.ndarray, np.ndarray]], thermostat: float
    ) -> np.ndarray:
        """(i, j) K above less below. rows: (top, bottom) temperatures (I, J) of each body, or just their corners."""
        i, j = interface.cells
        below = rows[interface.below][0][:i, :j]
        if interface.above is None:
            return thermostat - below
        return rows[interface.above][1][:i, :j] - below


def rates(
    grid: Grid, state: list[np.ndarray], conductance: float
) -> tuple[list[np.ndarray], tuple[float, float, float]]:
    """W into every cell, and W through the contact, from the thermostat and from the air."""
    surroundings = _surroundings(grid)
    conducted = [b.conduct(u, s) for b, u, s in zip(grid.bodies, state, surroundings, strict=True)]
    heat = [c[0] for c in conducted]
    rows = [(u[TOP], u[BOTTOM]) for u in state]
    crossing = []
    for interface in grid.interfaces:
        flow = grid.conductances(interface, conductance) * grid.gap(interface, rows, grid.thermostat)
        i, j = interface.cells
        heat[interface.below][TOP, :i, :j] += flow
        if interface.above is not None:
            heat[interface.above][BOTTOM, :i, :j] -= flow
        crossing.append(flow.sum())
    thermostat = conducted[SENSOR][1][0] + (crossing[0] if grid.interfaces[0].above is None else 0.0)
    return heat, (crossing[0], thermostat, conducted[OBJECT][1].sum())


def _surroundings(grid: Grid) -> tuple[tuple[float, float], tuple[float, float]]:
    return (grid.thermostat, 0.0), (0.0, 0.0)


class Stage:
    """One implicit stage of both bodies for one step (s) times gamma."""

    def __init__(self, grid: Grid, step: float) -> None:
        self.grid = grid
        self.step = step
        self.factored = [body.factor(step) for body in grid.bodies]
        self._driven = [
            body.surface_heat(s) for body, s in zip(grid.bodies, _surroundings(grid), strict=True)
        ]
        self._shield = _Shield(self.factored[OBJECT]) if grid.bodies[OBJECT].top else None
        self._last: tuple[float, _Crossing] | None = None
        contact, *bonds = grid.interfaces
        self._contact_response = self._response(contact, contact)
        self._bond: _Crossing | None = None
        if bonds:
            # The bond never changes: what it does to the contact's response is found once.
            root = np.sqrt(grid.conductances(bonds[0], 0.0).ravel())
            self._bond = _Crossing(root, self._response(bonds[0], bonds[0]))
            self._between = self._response(contact, bonds[0])
            self._bond_follows = self._bond.flow(self._between.T)
            self._contact_response -= self._between @ self._bond_follows

    def _response(self, at: Interface, into: Interface) -> np.ndarray:
        """(at, into) K/W: fall of the gap at one interface per heat that flows through the other."""
        block = np.zeros((at.cells[0] * at.cells[1], into.cells[0] * into.cells[1]))
        for body, at_row, at_sign in ((at.above, BOTTOM, 1.0), (at.below, TOP, -1.0)):
            for other, into_row, into_sign in ((into.above, BOTTOM, 1.0), (into.below, TOP, -1.0)):
                if body is not None and body == other:
                    part = self.factored[body].response(into_row, at_row, into.cells, at.cells)
                    if body == OBJECT and self._shield is not None:
                        part = self._shield.correct(part)
                    block += at_sign * into_sign * self.step * part
        return block

    def _flows(self, gaps: list[np.ndarray], conductance: float) -> list[np.ndarray]:
        """W through the cells of every interface from the gaps K that would be if nothing flowed."""
        if self._last is None or self._last[0] != conductance:
            root = np.sqrt(self.grid.conductances(self.grid.interfaces[0], conductance).ravel())
            self._last = (conductance, _Crossing(root, self._contact_response))
        crossing = self._last[1]
        if self._bond is None:
            return [crossing.flow(gaps[0])]
        held = self._bond.flow(gaps[1])
        opening = crossing.flow(gaps[0] - self._between @ held)
        return [opening, held - self._bond_follows @ opening]

    def solve(self, heat: list[np.ndarray], conductance: float) -> list[np.ndarray]:
        """Temperatures u of the bodies with capacity u - step * rates(u) = heat (J in the cells)."""
        modes = []
        for factored, before, driven in zip(self.factored, heat, self._driven, strict=True):
            total = before.copy()
            for row, flow in driven:
                total[row] += self.step * flow
            modes.append(factored.forward(total))
        free = [factored.eliminate(m) for factored, m in zip(self.factored, modes, strict=True)]
        corners = (self.grid.bodies[SENSOR].area.shape, self.grid.interfaces[-1].cells)
        rows = [
            (factored.corner(u[TOP], cells), factored.corner(u[BOTTOM], cells))
            for factored, u, cells in zip(self.factored, free, corners, strict=True)
        ]
        if self._shield is not None:
            rows[OBJECT] = (self._shield.correct_temperatures(rows[OBJECT][0]), rows[OBJECT][1])
        gaps = [
            self.grid.gap(interface, rows, self.grid.thermostat).ravel() for interface in self.grid.interfaces
        ]
        for interface, flows in zip(self.grid.interfaces, self._flows(gaps, conductance), strict=True):
            flow = below = self.step * flows.reshape(interface.cells)
            if interface.below == OBJECT and self._shield is not None:
                below = self._shield.total_heat(rows[OBJECT][0], flow)
            modes[interface.below][TOP] += self.factored[interface.below].from_corner(below)
            if interface.above is not None:
                modes[interface.above][BOTTOM] -= self.factored[interface.above].from_corner(flow)
        return [f.backward(f.eliminate(m)) for f, m in zip(self.factored, modes, strict=True)]


class _Crossing:
    """Flow through cells of conductance root**2 (W/K) between bodies that answer with response (K/W)."""

    def __init__(self, root: np.ndarray, response: np.ndarray) -> None:
        system = root[:, None] * response * root
        system[np.diag_indices_from(system)] += 1.0
        self._root = root
        self._factor = cho_factor(system, lower=True, overwrite_a=True, check_finite=False)

    def flow(self, gap: np.ndarray) -> np.ndarray:
        """W (n, ...) from the gap K (n, ...) that would be without flow."""
        root = self._root if gap.ndim == 1 else self._root[:, None]
        return root * cho_solve(self._factor, root * gap, check_finite=False)


class _Shield:
    """Takes the air out of the object's covered cells: the separable operator has a film on the whole top."""

    def __init__(self, factored: FactoredBody) -> None:
        body = factored.body
        self._film = factored.step * body.shielded_film
        self._top_response = factored.response(TOP, TOP, body.shielded, body.shielded)
        self._matrix = lu_factor(
            np.eye(self._film.size) - self._top_response * self._film.ravel(), check_finite=False
        )
        self._true = self.correct(self._top_response)

    def correct(self, response: np.ndarray) -> np.ndarray:
        """Response of the covered cells without their film."""
        return lu_solve(self._matrix, response, check_finite=False)

    def correct_temperatures(self, u: np.ndarray) -> np.ndarray:
        """The covered cells' temperatures without their film, no heat crossing."""
        return self.correct(u.ravel()).reshape(u.shape)

    def total_heat(self, free: np.ndarray, heat: np.ndarray) -> np.ndarray:
        """What to put into the separable operator so that it answers like the body: heat and the film's share back."""
        u = free.ravel() + self._true @ heat.ravel()
        return heat + self._film * u.reshape(heat.shape)
