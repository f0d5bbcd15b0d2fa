"""Crowns of a mesh: how curved it is where it comes to a rigid face first, and Hertz's contact there."""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

AROUND = 1e-3  # m, within which a crown's curvature is told
LINE, COMPACT = 0.1, 0.25
"""Breadth over length of a contact up to which it is a line, which constricts no heat here, and from which it does so
as a disc."""
CURVED = 1e-3  # of the face: what touches less is no flat face
_FEWEST = 30  # points
_UPRIGHT = 1e-9  # of a point, by which all paraboloids that fit points in a line are told apart
_FLATTEST = 0.5  # m, of the radii of crowns
_UNLIKE = 0.1  # of the squares of the heights' differences, that a paraboloid leaves at most


@njit(cache=True, error_model="numpy")
def crown_at(points, heights, cover, counted, law):
    """(1/m, 1/m, m): how curved the mesh is, more and less, around what of it comes to the face first; 0 and 0 where
    that is no crown: flat, or a shape that no paraboloid is. How far that is from the face's middle, along the side
    where it is further."""
    low, total, y, z = np.inf, 0.0, 0.0, 0.0
    for i in range(counted):
        if cover[i] > 0.0:
            low = min(low, heights[i])
    for i in range(counted):
        if cover[i] > 0.0 and heights[i] <= low + law.roughness:
            total += cover[i]
            y += cover[i] * points[i, 0]
            z += cover[i] * points[i, 1]
    y, z = y / total, z / total
    off = max(abs(y), abs(z))
    terms = 6 if at_edge(off, law) else 4  # beside a crown the surface slopes, too
    matrix, right, square, count = np.zeros((terms, terms)), np.zeros(terms), 0.0, 0
    row = np.ones(6)
    for i in range(counted):
        u, v = (points[i, 0] - y) / AROUND, (points[i, 1] - z) / AROUND
        if u * u + v * v < 1.0 and cover[i] > 0.0:
            height = heights[i] - low
            row[1], row[2], row[3], row[4], row[5] = u * u, v * v, u * v, u, v
            for j in range(terms):
                right[j] += row[j] * height
                for k in range(terms):
                    matrix[j, k] += row[j] * row[k]
            square += height**2
            count += 1
    if count < _FEWEST:
        return 0.0, 0.0, off
    for j in range(terms):
        matrix[j, j] += _UPRIGHT * count  # of points in a line
    found = np.linalg.solve(matrix, right)
    spread = square - right[0] ** 2 / count
    left = square - (found * right).sum()
    mean, half = (found[1] + found[2]) / 2, np.hypot((found[1] - found[2]) / 2, found[3] / 2)
    most, least = 2 * (mean + half) / AROUND**2, 2 * (mean - half) / AROUND**2
    if not (most > 1 / _FLATTEST and left < _UNLIKE * spread):
        return 0.0, 0.0, off
    return most, max(least, 0.0), off


@njit(cache=True, inner=True, error_model="numpy")
def at_edge(off, law):
    """Whether a crown is at the face's edge, or beyond it."""
    return off > law.half_face - AROUND


@njit(cache=True, error_model="numpy")
def hertz_contact(crown, load, long, modulus):
    """(m2 of Hertz's contact on a crown, how round it is: its breadth over its length). long: m, of the contact, where
    the crown is a line."""
    most, least, _ = crown
    round = (least / most) ** (2 / 3)  # nearly, of Hertz's ellipse
    if round <= LINE:
        return 4 * np.sqrt(load * long / (most * np.pi * modulus)), round
    return np.pi * (0.75 * load / (np.sqrt(most * least) * modulus)) ** (2 / 3), round


@njit(cache=True, inner=True, error_model="numpy")
def compact(round):
    """0 of a line, 1 of what constricts heat as a disc. round: breadth over length."""
    return min(max((round - LINE) / (COMPACT - LINE), 0.0), 1.0)
