"""The largest eigenvalues of a large symmetric operator, of which many are alike."""

import numpy as np
import pytest
from scipy.sparse import csc_array, eye_array, kron
from scipy.sparse.linalg import splu

from thermograsp.thermal.numerics import largest_eigenvalues

SHIFT = 0.01


def cube(side: int) -> csc_array:
    """The Laplacian of a cube of so many cells a side, whose eigenvalues are sums of those of a chain."""
    ends = np.r_[1.0, np.full(side - 2, 2.0), 1.0]
    chain = csc_array(np.diag(ends) - np.eye(side, k=1) - np.eye(side, k=-1))
    one = eye_array(side)
    along = (kron(kron(chain, one), one), kron(kron(one, chain), one), kron(kron(one, one), chain))
    return csc_array(along[0] + along[1] + along[2])


def rates(side: int) -> np.ndarray:
    chain = 2 - 2 * np.cos(np.pi * np.arange(side) / side)
    return np.sort(np.add.outer(np.add.outer(chain, chain), chain).ravel())


@pytest.mark.parametrize(("side", "count"), [(4, 20), (10, 40), (16, 150)], ids=["dense", "few", "many"])
def test_all_of_a_cube_s_are_found_as_often_as_they_are(side: int, count: int) -> None:
    laplacian, unknowns = cube(side), side**3
    factors = splu(csc_array(laplacian + SHIFT * eye_array(unknowns)))
    values, vectors = largest_eigenvalues(factors.solve, unknowns, count, 1e-3)
    exact = rates(side)
    assert 1 / values - SHIFT == pytest.approx(exact[:count], rel=1e-5, abs=1e-9)
    assert len(np.unique(exact[:count].round(9))) < count / 2  # the same ones, several times
    np.testing.assert_allclose(vectors.T @ vectors, np.eye(count), atol=1e-12)
    residuals = factors.solve(vectors) - vectors * values
    assert (np.linalg.norm(residuals, axis=0) <= 1e-3 * values).all()


def test_what_is_known_more_exactly_takes_more_vectors() -> None:
    factors = splu(csc_array(cube(12) + SHIFT * eye_array(12**3)))
    taken, errors = [], []
    for accuracy in (1e-2, 1e-8):
        blocks: list[int] = []

        def operator(columns: np.ndarray, blocks: list[int] = blocks) -> np.ndarray:
            blocks.append(columns.shape[1])
            return factors.solve(columns)

        values, vectors = largest_eigenvalues(operator, 12**3, 60, accuracy)
        taken.append(sum(blocks))
        errors.append(np.max(np.linalg.norm(factors.solve(vectors) - vectors * values, axis=0) / values))
    assert errors[1] <= 1e-8 < errors[0] <= 1e-2
    assert taken[0] < taken[1]
