"""Cell-centred finite volumes on tensor grids, solved by separation of variables.

A body is a stack of homogeneous layers over a lateral section, and its grid the product of a lateral grid (x and y, or
r) and a grid in depth. The discrete conduction operator is then a sum of Kronecker products: two small eigenproblems
diagonalise it laterally, and what is left for each lateral mode is tridiagonal in depth (fast diagonalisation: Lynch,
Rice & Thomas 1964, Numerische Mathematik 6, 185). No large matrix is factored, so the time step may change at will.
Where two bodies touch only the cells along the contact couple; see grid_contact.py.

Temperatures are arrays (D, I, J): D cells in depth, I and J along the two lateral axes (J = 1 on a disc).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import eigh_tridiagonal

from thermograsp.compiled import njit


def graded_cells(
    breaks: Sequence[float], fine: Mapping[float, float], growth: float, largest: float, resolution: int = 1
) -> np.ndarray:
    """Cell boundaries (n + 1,) m that contain every break and shrink toward the fine points.

    breaks: m, increasing, the ends included. fine: points m and the length m of a cell there; at a distance d a cell is
    about growth * d (growth > 0) longer, and in number there are no fewer than if none were longer than largest (m).
    resolution: each cell cut into so many, of equal ratio, so that the boundaries of a coarse grid are among those of a
    finer one.
    """
    points = np.array(sorted(fine))
    lengths = np.array([fine[point] for point in points])
    middles = (points[:-1] + points[1:]) / 2 + np.diff(lengths) / (
        2 * growth
    )  # as long seen from either side
    knots = np.unique([*breaks, *(p for p in (*points, *middles) if breaks[0] < p < breaks[-1])])
    edges = [knots[:1]]
    for start, stop in zip(knots[:-1], knots[1:], strict=True):
        if stop - start < 1e-12 * (knots[-1] - knots[0]):
            continue
        near, far = (np.min(lengths + growth * np.abs(points - x)) for x in (start, stop))
        count = max(abs(np.log(far / near)) / np.log1p(growth), (stop - start) / largest, 1.0)
        parts = resolution * int(np.ceil(count - 1e-9))
        fraction = np.arange(1, parts + 1) / parts
        span = (
            np.expm1(fraction * np.log(far / near)) / (far / near - 1)
            if abs(far / near - 1) > 1e-9
            else fraction
        )
        edges.append(start + (stop - start) * span)
    return np.concatenate(edges)


@dataclass(frozen=True, slots=True)
class Axis:
    """One lateral axis of a grid, as numbers per unit of height and of the other axis.

    volumes: (n,) lengths m of the cells (areas m2 along a radius). links: (n - 1,) conductance between neighbouring
    cells over conductivity. end: the same between the last cell and what surrounds the body, 0 if adiabatic.
    """

    volumes: np.ndarray
    links: np.ndarray
    end: float

    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Squared wave numbers (n,) 1/m2 and vectors (n, n), orthonormal in the volumes."""
        diagonal = np.zeros(len(self.volumes))
        diagonal[:-1] += self.links
        diagonal[1:] += self.links
        diagonal[-1] += self.end
        root = np.sqrt(self.volumes)
        if len(root) == 1:
            return diagonal / self.volumes, 1 / root[:, None]
        values, vectors = eigh_tridiagonal(diagonal / self.volumes, -self.links / (root[:-1] * root[1:]))
        return np.maximum(values, 0.0), vectors / root[:, None]


def symmetric_axis(edges: np.ndarray, film_over_conductivity: float = 0.0) -> Axis:
    """Axis from the middle of a body, mirrored: both halves are counted. film: W/(m2 K) at the end over W/(m K)."""
    widths = np.diff(edges)
    return Axis(
        volumes=2 * widths,
        links=4 / (widths[:-1] + widths[1:]),
        end=2 * film_over_conductivity / (1 + film_over_conductivity * widths[-1] / 2),
    )


def radial_axis(edges: np.ndarray, film_over_conductivity: float = 0.0) -> Axis:
    """Axis along the radius of a disc. film: W/(m2 K) on the rim over W/(m K)."""
    widths = np.diff(edges)
    return Axis(
        volumes=np.pi * np.diff(edges**2),
        links=4 * np.pi * edges[1:-1] / (widths[:-1] + widths[1:]),
        end=2 * np.pi * edges[-1] * film_over_conductivity / (1 + film_over_conductivity * widths[-1] / 2),
    )


def single_cell() -> Axis:
    """The second lateral axis of a grid that has only one."""
    return Axis(volumes=np.ones(1), links=np.zeros(0), end=0.0)


@dataclass(frozen=True)
class Body:
    """A layered body on a tensor grid.

    first, second: lateral axes. edges: (D + 1,) m, in depth from the top. conductivity (D,) W/(m K), heat_capacity (D,)
    J/(m3 K) of the cells. top, bottom: W/(m2 K) from the body's outer surfaces to the surroundings, inf = held at
    their temperature. shielded: numbers of cells (i, j) from the middle of the top that the surroundings do not reach.
    """

    first: Axis
    second: Axis
    edges: np.ndarray
    conductivity: np.ndarray
    heat_capacity: np.ndarray
    top: float = 0.0
    bottom: float = 0.0
    shielded: tuple[int, int] = (0, 0)

    @cached_property
    def area(self) -> np.ndarray:
        """(I, J) m2 of the cells seen from above."""
        return np.outer(self.first.volumes, self.second.volumes)

    @cached_property
    def capacity(self) -> np.ndarray:
        """(D, I, J) J/K of the cells."""
        return (self.heat_capacity * np.diff(self.edges))[:, None, None] * self.area

    @cached_property
    def half_resistance(self) -> np.ndarray:
        """(D,) m2 K/W from the middle of a cell to its top or bottom."""
        return np.diff(self.edges) / (2 * self.conductivity)

    @cached_property
    def _depth_links(self) -> np.ndarray:
        return 1 / (self.half_resistance[:-1] + self.half_resistance[1:])

    @cached_property
    def _layer(self) -> np.ndarray:
        """(D, 1, 1) W/K along a layer of cells as wide as it is long."""
        return (self.conductivity * np.diff(self.edges))[:, None, None]

    @cached_property
    def _links(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """W/K between neighbours in depth (D - 1, I, J) and along either axis."""
        return (
            self._depth_links[:, None, None] * self.area,
            self._layer * np.outer(self.first.links, self.second.volumes),
            self._layer * np.outer(self.first.volumes, self.second.links),
        )

    @cached_property
    def _surface_films(self) -> tuple[float, float]:
        """W/(m2 K) from the middles of the top and bottom cells to the surroundings."""
        top, bottom = (
            0.0 if film == 0 else 1 / (1 / film + half)
            for film, half in ((self.top, self.half_resistance[0]), (self.bottom, self.half_resistance[-1]))
        )
        return top, bottom

    @cached_property
    def shielded_film(self) -> np.ndarray:
        """(i, j) W/K that the separable operator has too much at the shielded cells of the top."""
        i, j = self.shielded
        return self._surface_films[0] * self.area[:i, :j]

    @cached_property
    def _modes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        first, self_first = self.first.modes()
        second, self_second = self.second.modes()
        return first[:, None] + second, self_first, self_second

    def conduct(self, u: np.ndarray, surroundings: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        """Heat into every cell (D, I, J) W, in flux form: what leaves one cell enters its neighbour to the last bit.

        surroundings: temperatures above and below; the sides' is 0. Also returns the heat (3,) W that enters through
        top, bottom and sides.
        """
        heat = np.empty(u.shape)
        _conduct(np.ascontiguousarray(u), *self._links, heat)
        entering = np.zeros(3)
        for n, (row, film) in enumerate(zip((0, -1), self._surface_films, strict=True)):
            if film:
                flux = film * self.area * (surroundings[n] - u[row])
                if n == 0:
                    i, j = self.shielded
                    flux[:i, :j] = 0.0
                heat[row] += flux
                entering[n] = flux.sum()
        for axis, last in ((self.first, np.s_[:, -1, :]), (self.second, np.s_[:, :, -1])):
            if axis.end:
                other = self.second if axis is self.first else self.first
                flux = -axis.end * self._layer[:, :, 0] * other.volumes * u[last]
                heat[last] += flux
                entering[2] += flux.sum()
        return heat, entering

    def surface_heat(self, surroundings: tuple[float, float]) -> list[tuple[int, np.ndarray]]:
        """(row, W per cell) that the surroundings' temperatures alone drive into a body at 0."""
        films = zip((0, -1), self._surface_films, surroundings, strict=True)
        return [
            (row, film * temperature * self.area) for row, film, temperature in films if film * temperature
        ]

    def factor(self, step: float) -> FactoredBody:
        """The operator capacity + step * conduction (shielded cells not corrected), ready to be solved. step: s."""
        return FactoredBody(self, step)


class FactoredBody:
    """capacity + step * conduction of one body for one step (s), eliminated in depth for every lateral mode at once."""

    def __init__(self, body: Body, step: float) -> None:
        self.body = body
        self.step = step
        wave2, self._first, self._second = body._modes
        thickness = np.diff(body.edges)
        links = step * body._depth_links
        diagonal = np.multiply.outer(step * body.conductivity * thickness, wave2)
        diagonal += (body.heat_capacity * thickness)[:, None, None]
        diagonal[:-1] += links[:, None, None]
        diagonal[1:] += links[:, None, None]
        for row, film in zip((0, -1), body._surface_films, strict=True):
            diagonal[row] += step * film
        self._links = links
        self._pivots = np.empty_like(diagonal)
        self._pivots[0] = 1 / diagonal[0]
        for n, link in enumerate(links):
            self._pivots[n + 1] = 1 / (diagonal[n + 1] - link**2 * self._pivots[n])

    def forward(self, heat: np.ndarray) -> np.ndarray:
        """Lateral modes (D, I, J) of heat (D, I, J) in the cells."""
        return self._first.T @ heat @ self._second

    def backward(self, modes: np.ndarray) -> np.ndarray:
        """Temperatures of the cells from those of the modes."""
        return self._first @ modes @ self._second.T

    def corner(self, modes: np.ndarray, cells: tuple[int, int]) -> np.ndarray:
        """Temperatures (i, j) of the cells next to the middle from one row's modes (I, J)."""
        return self._first[: cells[0]] @ modes @ self._second[: cells[1]].T

    def from_corner(self, heat: np.ndarray) -> np.ndarray:
        """Lateral modes (I, J) of heat (i, j) in the cells next to the middle."""
        return self._first[: heat.shape[0]].T @ heat @ self._second[: heat.shape[1]]

    def eliminate(self, modes: np.ndarray) -> np.ndarray:
        """Temperatures (D, I, J) of the modes from their heat (tridiagonal in depth)."""
        flat = np.ascontiguousarray(modes).reshape(len(modes), -1)
        x = np.empty_like(flat)
        _eliminate(flat, self._links, self._pivots.reshape(flat.shape), x)
        return x.reshape(modes.shape)

    def response(
        self, into: int, at: int, into_cells: tuple[int, int], at_cells: tuple[int, int]
    ) -> np.ndarray:
        """(at, into) K/J: temperature of the cells next to the middle of row `at` per heat in those of row `into`."""
        unit = np.zeros_like(self._pivots)
        unit[into] = 1.0
        gain = self.eliminate(unit)[at]
        (ia, ja), (ib, jb) = at_cells, into_cells
        first = (self._first[:ia, None] * self._first[None, :ib]).reshape(ia * ib, -1)
        second = (self._second[:ja, None] * self._second[None, :jb]).reshape(ja * jb, -1)
        product = (first @ gain @ second.T).reshape(ia, ib, ja, jb)
        return product.transpose(0, 2, 1, 3).reshape(ia * ja, ib * jb)


@njit(cache=True, error_model="numpy")
def _conduct(u, in_depth, along_first, along_second, heat):
    """Writes to heat (D, I, J) what flows into each cell from its neighbours."""
    depth, rows, columns = u.shape
    for n in range(depth):
        for i in range(rows):
            for j in range(columns):
                into, here = 0.0, u[n, i, j]
                if n < depth - 1:
                    into += in_depth[n, i, j] * (u[n + 1, i, j] - here)
                if n > 0:
                    into -= in_depth[n - 1, i, j] * (here - u[n - 1, i, j])
                if i < rows - 1:
                    into += along_first[n, i, j] * (u[n, i + 1, j] - here)
                if i > 0:
                    into -= along_first[n, i - 1, j] * (here - u[n, i - 1, j])
                if j < columns - 1:
                    into += along_second[n, i, j] * (u[n, i, j + 1] - here)
                if j > 0:
                    into -= along_second[n, i, j - 1] * (here - u[n, i, j - 1])
                heat[n, i, j] = into


@njit(cache=True, error_model="numpy")
def _eliminate(modes, links, pivots, x):
    """Writes to x (D, M) the solution of a tridiagonal system for each mode, pivots being those of its factors."""
    depth, count = x.shape
    for m in range(count):
        x[0, m] = modes[0, m]
    for n in range(depth - 1):
        for m in range(count):
            x[n + 1, m] = pivots[n, m] * links[n] * x[n, m] + modes[n + 1, m]
    for m in range(count):
        x[depth - 1, m] *= pivots[depth - 1, m]
    for n in range(depth - 2, -1, -1):
        for m in range(count):
            x[n, m] = (x[n, m] + links[n] * x[n + 1, m]) * pivots[n, m]
