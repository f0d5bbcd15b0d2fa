"""A press by finite elements in three dimensions with scikit-fem, as one would write it (optional extra `bench`).

Quarter symmetry; triquadratic hexahedra on a tensor mesh; the contact is a conductance between coinciding nodes; in O
mode the element shares the nodes of its bond with the object. Much coarser, and plainer in time, than the project's
independent reference in studies/elements/fem.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from thermograsp.bench.accuracy.semi_discrete import SemiDiscrete
from thermograsp.errors import MissingDependencyError, install
from thermograsp.thermal import PressProblem


def available() -> bool:
    """Whether scikit-fem is installed."""
    try:
        import skfem  # noqa: F401  # pyright: ignore[reportUnusedImport]
    except ImportError:
        return False
    return True


def element_press(problem: PressProblem, cells: int) -> SemiDiscrete:
    """The press with that many elements over half the sensor's face and so many again beside it, shrinking to the edge.

    The contact must be the whole square face, its conductance a number, without air.
    Raises MissingDependencyError without scikit-fem.
    """
    try:
        from skfem import Basis, ElementHex2, MeshHex
    except ImportError as error:
        raise MissingDependencyError(f"finite elements need scikit-fem: {install('bench')}") from error
    assert not callable(problem.conductance) and problem.air == 0
    half, size = problem.stack.width / 2, problem.object_size
    toward = (1 - np.linspace(1, 0, cells + 1) ** 2) * half  # elements shrink toward the edge
    sides = [
        np.append(toward, half + (side / 2 - half) * np.linspace(0, 1, cells + 1)[1:] ** 2)
        for side in size[:2]
    ]
    layers = problem.stack.layers[::-1]
    bounds = np.cumsum([0.0, *(layer.thickness for layer in layers)])
    rise = np.unique(
        np.concatenate([np.linspace(a, b, cells // 2 + 1) for a, b in zip(bounds, bounds[1:], strict=False)])
    )
    upper = Basis(MeshHex.init_tensor(toward, toward, rise), ElementHex2(), intorder=4)
    depth = -size[2] * np.linspace(1, 0, cells + 1) ** 2
    lower = Basis(MeshHex.init_tensor(sides[0], sides[1], depth), ElementHex2(), intorder=4)
    layer_of = np.searchsorted(bounds[1:-1], np.asarray(upper.global_coordinates())[2])
    k = np.array([layer.conductivity for layer in layers])[layer_of]
    c = np.array([layer.volumetric_heat_capacity for layer in layers])[layer_of]
    material = problem.material
    stiff_up, mass_up = _matrices(upper, k, c)
    stiff_low, mass_low = _matrices(lower, material.conductivity, material.volumetric_heat_capacity)
    # heat of the whole sensor and object, not of their quarter
    stiffness = sparse.csr_matrix(4 * sparse.block_diag([stiff_up, stiff_low]))
    mass = sparse.csr_matrix(4 * sparse.block_diag([mass_up, mass_low]))
    n, offset = upper.N + lower.N, upper.N
    load, above, h = np.zeros(n), problem.temperature_difference, problem.conductance
    top, bottom = _face(upper, bounds[-1]), _face(upper, 0.0)
    touched = _face(lower, 0.0, half) + offset
    face = sparse.csr_matrix(4 * h * _facet_mass(upper, 0.0)[bottom][:, bottom])
    target, fixed = np.arange(n), np.zeros(n)
    if problem.mode == "T":
        jump = _select(bottom, n) - _select(touched, n)
        stiffness = stiffness + jump.T @ face @ jump
        fixed[top] = above
        kept = np.setdiff1d(target, top)
    else:
        weights = sparse.csr_matrix(4 * h * _facet_mass(upper, bounds[-1])[top][:, top])
        stiffness = stiffness + _select(top, n).T @ weights @ _select(top, n)
        load[top] = above * np.asarray(weights.sum(axis=1)).ravel()
        target[touched] = bottom
        kept = np.setdiff1d(target, touched)
    number = np.full(n, -1)
    number[kept] = np.arange(len(kept))
    column = number[target]
    used = np.flatnonzero(column >= 0)
    spread = sparse.csr_matrix((np.ones(len(used)), (used, column[used])), shape=(n, len(kept)))
    drop = np.zeros(n)
    sensed = len(layers) - 1 - problem.stack.sensed
    for height, sign in ((bounds[sensed + 1], 1.0), (bounds[sensed], -1.0)):
        mean = np.asarray(_facet_mass(upper, height).sum(axis=1)).ravel()
        drop[:offset] += sign * mean / mean.sum()
    first = np.where(np.arange(n) < offset, above if problem.mode == "T" else 0.0, 0.0)
    return SemiDiscrete(
        sparse.csc_matrix(spread.T @ mass @ spread),
        sparse.csc_matrix(spread.T @ stiffness @ spread),
        spread.T @ (load - stiffness @ fixed),
        spread.T @ drop,
        first[kept],
    )


def _matrices(basis: Any, conductivity: Any, heat_capacity: Any) -> tuple[Any, Any]:
    from skfem import BilinearForm
    from skfem.helpers import dot

    shape = np.asarray(basis.global_coordinates())[2].shape
    k, c = np.broadcast_to(conductivity, shape), np.broadcast_to(heat_capacity, shape)
    stiffness = BilinearForm(lambda u, v, w: k * dot(u.grad, v.grad)).assemble(basis)
    return stiffness, BilinearForm(lambda u, v, w: c * u * v).assemble(basis)


def _facet_mass(basis: Any, height: float) -> Any:
    from skfem import BilinearForm, ElementHex2, FacetBasis

    facets = basis.mesh.facets_satisfying(lambda p: np.abs(p[2] - height) < 1e-9)
    face = FacetBasis(basis.mesh, ElementHex2(), facets=facets, intorder=4)
    return BilinearForm(lambda u, v, w: u * v).assemble(face)


def _face(basis: Any, height: float, within: float = np.inf) -> np.ndarray:
    """Nodes of a horizontal face, ordered by where they are."""
    x, y, z = basis.doflocs
    nodes = np.flatnonzero((np.abs(z - height) < 1e-9) & (x < within + 1e-9) & (y < within + 1e-9))
    return nodes[np.lexsort((np.round(y[nodes] * 1e9), np.round(x[nodes] * 1e9)))]


def _select(nodes: np.ndarray, n: int) -> sparse.csr_matrix:
    return sparse.csr_matrix((np.ones(len(nodes)), (np.arange(len(nodes)), nodes)), shape=(len(nodes), n))
