"""Rays down through a body's surfaces, across a curved face that is unrolled.

F: triangles, A, B: rays along u and v.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

_HITS = 24  # of a ray, at most
_BESIDE = 1.3  # of the rays' reach, beyond which nothing is hit
_SIDEWAYS = 0.3  # of the way to a face's axis that is left above a corner, below which it tells no angle
_SLACK = 1e-6  # m, by which a triangle may reach farther along the face than its corners
_TWICE_BENT = 0.01  # of the rays' reach, the same where the face is curved both ways


class Face(NamedTuple):
    """A curved face, unrolled: u, v m along it from its middle, w m above it. centre: (3,) m. axes: (3, 3), rows are
    the directions of u, v and w in the middle. bend: (2,) 1/m, curvature along u and v, 0 for one that is as good as
    flat."""

    centre: np.ndarray
    axes: np.ndarray
    bend: np.ndarray

    def seen(self, along: np.ndarray, axis: int) -> np.ndarray:
        """m from the middle, seen along the normal there, of places along the face."""
        bend = float(self.bend[axis])
        return np.sin(bend * along) / bend if bend else along

    def along(self, seen: float, axis: int) -> float:
        """m along the face of a place that is seen at that distance."""
        bend = float(self.bend[axis])
        return float(np.arcsin(np.clip(bend * seen, -1.0, 1.0)) / bend) if bend else seen

    def local(self, triangles: np.ndarray) -> np.ndarray:
        """(F, 3, 3) m along the axes."""
        return (triangles - self.centre) @ self.axes.T

    def unrolled(self, points: np.ndarray) -> np.ndarray:
        """(..., 2) m of u and v of points (..., 3) m along the axes; not a number near the face's axis and beyond."""
        height = 1 + self.bend * points[..., 2:]
        flat = self.bend == 0
        angles = np.arctan2(self.bend * points[..., :2], height)
        along = np.where(flat, points[..., :2], angles / np.where(flat, 1.0, self.bend))
        return np.where(height > _SIDEWAYS, along, np.nan)

    def located(self, points: np.ndarray) -> np.ndarray:
        """(..., 3) m of u, v and w of points (..., 3) m along the axes; u and v as `unrolled` has them."""
        along = self.unrolled(points)
        turned = self.bend * along
        curved = self.bend != 0
        bend = np.where(curved, self.bend, 1.0)
        start = np.where(curved, np.sin(turned) / bend, along)
        sunk = np.where(curved, (1 - np.cos(turned)) / bend, 0.0).sum(axis=-1)
        across = np.concatenate((np.tan(turned), np.ones((*along.shape[:-1], 1))), axis=-1)
        offset = points - np.concatenate((start, -sunk[..., None]), axis=-1)
        above = (offset * across).sum(axis=-1) / np.linalg.norm(across, axis=-1)
        return np.concatenate((along, above[..., None]), axis=-1)


class Hits(NamedTuple):
    """What rays meet on their way down. heights: (A, B, n) m, w of each. surfaces: (A, B, n), the number of what is
    entered there, negative where it is left, 0 for nothing more. slopes: (A, B, n) cosine to the ray."""

    heights: np.ndarray
    surfaces: np.ndarray
    slopes: np.ndarray


def cast(
    face: Face,
    triangles: np.ndarray,
    surfaces: np.ndarray,
    u: np.ndarray,
    v: np.ndarray,
    above: float,
    depth: float,
) -> Hits:
    """triangles: (F, 3, 3) m along the face's axes, and surfaces (F,), their numbers from 1 on. u: (A,), v: (B,) m of
    the rays, ascending. above, depth: m above and below the face, from which to which they go. One that begins within
    the body enters it there."""
    reach = np.array([np.abs(u).max(), np.abs(v).max()])
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    sunk = float((np.abs(face.bend) * reach**2).sum()) / 2
    near = (high[:, 2] > -depth - sunk) & np.all(
        (low[:, :2] < _BESIDE * reach) & (high[:, :2] > -_BESIDE * reach), axis=1
    )
    if (face.bend < 0).any():  # the other side of a hollow, where rays cross
        near &= low[:, 2] < above + sunk
    triangles = np.ascontiguousarray(triangles[near])
    along = face.unrolled(triangles)
    low, high = along.min(axis=1), along.max(axis=1)
    low, high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)
    slack = _TWICE_BENT * reach.max() if face.bend.all() else _SLACK
    first, last = (
        np.stack([np.searchsorted(rays, end[:, k] + way) for k, rays in enumerate((u, v))], axis=1)
        for end, way in ((low, -slack), (high, slack))
    )
    shape = len(u), len(v), _HITS
    found = Hits(np.zeros(shape), np.zeros(shape, np.int64), np.zeros(shape))
    _cast(triangles, surfaces[near], first, last, u, v, face.bend, above, depth, *found)
    return found


@njit(cache=True, error_model="numpy")
def _cast(triangles, surfaces, first, last, u, v, bend, above, depth, heights, hit, slopes):
    """Moller & Trumbore, J. Graph. Tools 2, 1997. first, last: (F, 2), of the rays that a triangle may be met by."""
    within = np.zeros((len(u), len(v)), np.int64)  # of the body, how often a ray enters it before it begins
    for f in range(len(triangles)):
        a = triangles[f, 0]
        e0, e1, e2 = triangles[f, 1, 0] - a[0], triangles[f, 1, 1] - a[1], triangles[f, 1, 2] - a[2]
        g0, g1, g2 = triangles[f, 2, 0] - a[0], triangles[f, 2, 1] - a[1], triangles[f, 2, 2] - a[2]
        n0, n1, n2 = e1 * g2 - e2 * g1, e2 * g0 - e0 * g2, e0 * g1 - e1 * g0
        size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
        if size == 0.0:
            continue
        for i in range(first[f, 0], last[f, 0]):
            t0, x, down = 0.0, u[i], 0.0
            if bend[0] != 0.0:
                t0, x = np.tan(bend[0] * u[i]), np.sin(bend[0] * u[i]) / bend[0]
                down = (1 - np.cos(bend[0] * u[i])) / bend[0]
            for j in range(first[f, 1], last[f, 1]):
                t1, y, z = 0.0, v[j], -down
                if bend[1] != 0.0:
                    t1, y = np.tan(bend[1] * v[j]), np.sin(bend[1] * v[j]) / bend[1]
                    z -= (1 - np.cos(bend[1] * v[j])) / bend[1]
                scale = 1 / np.sqrt(1 + t0 * t0 + t1 * t1)
                d0, d1, d2 = t0 * scale, t1 * scale, scale
                facing = n0 * d0 + n1 * d1 + n2 * d2
                if abs(facing) < 1e-9 * size:
                    continue
                r0, r1, r2 = x - a[0], y - a[1], z - a[2]
                c0, c1, c2 = r1 * d2 - r2 * d1, r2 * d0 - r0 * d2, r0 * d1 - r1 * d0
                p = -(g0 * c0 + g1 * c1 + g2 * c2) / facing
                q = (e0 * c0 + e1 * c1 + e2 * c2) / facing
                if p < 0 or q < 0 or p + q > 1:
                    continue
                w = -(n0 * r0 + n1 * r1 + n2 * r2) / facing
                last_one = heights.shape[2] - 1
                if w < -depth or hit[i, j, last_one] != 0:
                    continue
                code = surfaces[f] if facing > 0 else -surfaces[f]
                if w > above:
                    within[i, j] += 1 if facing > 0 else -1
                    continue
                twice = False  # on an edge of two triangles
                for m in range(last_one):
                    if hit[i, j, m] == 0:
                        break
                    twice |= hit[i, j, m] == code and abs(heights[i, j, m] - w) < 1e-9
                if twice:
                    continue
                k = last_one
                while k > 0 and (hit[i, j, k - 1] == 0 or heights[i, j, k - 1] < w):  # from the top down
                    heights[i, j, k] = heights[i, j, k - 1]
                    hit[i, j, k] = hit[i, j, k - 1]
                    slopes[i, j, k] = slopes[i, j, k - 1]
                    k -= 1
                heights[i, j, k] = w
                hit[i, j, k] = code
                slopes[i, j, k] = abs(facing) / size
    for i in range(len(u)):
        for j in range(len(v)):
            if hit[i, j, 0] < 0 or (hit[i, j, 0] == 0 and within[i, j] > 0):
                for k in range(heights.shape[2] - 1, 0, -1):
                    heights[i, j, k] = heights[i, j, k - 1]
                    hit[i, j, k] = hit[i, j, k - 1]
                    slopes[i, j, k] = slopes[i, j, k - 1]
                heights[i, j, 0], hit[i, j, 0], slopes[i, j, 0] = above, 1, 1.0
