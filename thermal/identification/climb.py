"""The most probable contact of an object, by damped Gauss-Newton steps; compiled, one object after the other.

A point is (object along the table, heat capacity in standard deviations, contact resistance in m2 K/W). Its misfit is
twice the negative log posterior with the best difference of temperature, up to a constant.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

FARTHEST = 3.2  # standard deviations of heat capacity
_STEPS = 40
_CONVERGED = 2e-3  # of the misfit
_HOPELESS = 4000.0  # of the misfit, above the best object's


@njit(cache=True)
def climb(table, axes, data, prior, limits, index, capacity, resistance):
    """table: (N, C, H, Q). axes: (first log resistance, its spacing, standard deviations of capacity a node). data:
    (Q,). prior: K, mean and standard deviation of the difference. limits: of the resistance. index, capacity,
    resistance: (P,), begins. Returns misfit (P,), the point's capacity, resistance and difference (P, 3), the gradient
    downhill (P, 3) and the curvature (P, 3, 3) by difference (K), capacity and relative resistance."""
    count = len(index)
    misfit, point = np.zeros(count), np.zeros((count, 3))
    gradient, curvature = np.zeros((count, 3)), np.zeros((count, 3, 3))
    low, high = limits
    curve = np.zeros((3, table.shape[3]))
    g, a = np.zeros(3), np.zeros((3, 3))
    move, damped = np.zeros(3), np.zeros((3, 3))
    least = np.inf
    for p in range(count):
        u, r = capacity[p], resistance[p]
        now, difference = _misfit(table, axes, data, prior, index[p], u, r, curve, g, a)
        damping, still = 1e-3, 0
        for _ in range(_STEPS):
            for i in range(3):
                for j in range(3):
                    damped[i, j] = a[i, j]
                damped[i, i] *= 1 + damping
                move[i] = g[i]
            # What is at a limit and would leave it is held there.
            if (u <= -FARTHEST and g[1] < 0) or (u >= FARTHEST and g[1] > 0):
                _hold(damped, move, 1)
            if (r <= low and g[2] < 0) or (r >= high and g[2] > 0):
                _hold(damped, move, 2)
            _solve(damped, move)
            next_u = min(max(u + move[1], -FARTHEST), FARTHEST)
            next_r = min(max(r * np.exp(min(max(move[2], -1.0), 1.0)), low), high)
            new, best = _misfit(table, axes, data, prior, index[p], next_u, next_r, curve, g, a)
            if new <= now:
                still = still + 1 if now - new < _CONVERGED else 0
                u, r, now, difference = next_u, next_r, new, best
                damping *= 0.1
            else:
                _misfit(table, axes, data, prior, index[p], u, r, curve, g, a)
                still = still + 1 if new - now < _CONVERGED else 0
                damping *= 10
            if still == 2 or damping > 1e4 or (still == 1 and damping < 1e-4):
                break
            if now > least + _HOPELESS and damping < 1e-6:
                break
        least = min(least, now)
        misfit[p], point[p, 0], point[p, 1], point[p, 2] = now, u, r, difference
        gradient[p], curvature[p] = g, a
    return misfit, point, gradient, curvature


@njit(cache=True, inner=True)
def _misfit(table, axes, data, prior, index, capacity, resistance, curve, gradient, curvature):
    """(misfit, difference) at a point; fills curve (3, Q), the curve and its derivatives per kelvin by capacity and
    relative resistance, gradient and curvature."""
    first, spacing, step = axes
    mean, deviation = prior
    middle = (table.shape[1] - 1) / 2
    _interpolate(table, index, middle + capacity / step, (np.log(resistance) - first) / spacing, curve)
    count = len(data)
    weight = 1 / deviation**2
    power, match = weight, mean * weight
    for q in range(count):
        power += curve[0, q] ** 2
        match += curve[0, q] * data[q]
    best = match / power
    if table.shape[1] == 1:
        capacity = 0.0
    misfit = ((best - mean) / deviation) ** 2 + capacity**2
    gradient[:] = 0.0
    curvature[:] = 0.0
    for q in range(count):
        left = data[q] - best * curve[0, q]
        by_capacity, by_resistance = best * curve[1, q] / step, best * curve[2, q] / spacing
        misfit += left * left
        gradient[0] += left * curve[0, q]
        gradient[1] += left * by_capacity
        gradient[2] += left * by_resistance
        curvature[0, 1] += curve[0, q] * by_capacity
        curvature[0, 2] += curve[0, q] * by_resistance
        curvature[1, 1] += by_capacity * by_capacity
        curvature[1, 2] += by_capacity * by_resistance
        curvature[2, 2] += by_resistance * by_resistance
    gradient[0] -= (best - mean) * weight
    gradient[1] -= capacity
    curvature[0, 0] = power
    curvature[1, 1] += 1.0
    curvature[2, 2] += 1e-12  # keeps it regular where the data do not see the resistance at all
    curvature[1, 0], curvature[2, 0], curvature[2, 1] = curvature[0, 1], curvature[0, 2], curvature[1, 2]
    return misfit, best


@njit(cache=True)
def _interpolate(table, x, y, z, curve):
    """Of degree 5, 5 and 3 along the axes, at a point in units of the nodes: value, and derivatives along the second
    and third axis."""
    weight, slope = np.zeros((3, 6)), np.zeros((3, 6))
    i0, ni = _lagrange(x, table.shape[0], 6, weight[0], slope[0])
    j0, nj = _lagrange(y, table.shape[1], 6, weight[1], slope[1])
    k0, nk = _lagrange(z, table.shape[2], 4, weight[2], slope[2])
    curve[:] = 0.0
    for i in range(ni):
        if weight[0, i] == 0.0:
            continue
        for j in range(nj):
            plain, along = weight[0, i] * weight[1, j], weight[0, i] * slope[1, j]
            for k in range(nk):
                a, b, c = plain * weight[2, k], along * weight[2, k], plain * slope[2, k]
                row = table[i0 + i, j0 + j, k0 + k]
                for q in range(len(row)):
                    curve[0, q] += a * row[q]
                    curve[1, q] += b * row[q]
                    curve[2, q] += c * row[q]


@njit(cache=True, inner=True)
def _lagrange(x, length, most, weight, slope):
    """(first node, how many) of at most `most` nodes around x, and their weights for the value and the derivative."""
    size = min(length, most)
    first = min(max(int(np.floor(x)) - size // 2 + 1, 0), length - size)
    x -= first
    for i in range(size):
        weight[i], slope[i] = 1.0, 0.0
        for j in range(size):
            if j != i:
                slope[i] = (slope[i] * (x - j) + weight[i]) / (i - j)
                weight[i] *= (x - j) / (i - j)
    return first, size


@njit(cache=True, inner=True)
def _hold(matrix, vector, axis):
    for i in range(3):
        if i != axis:
            matrix[axis, i] = matrix[i, axis] = 0.0
    vector[axis] = 0.0


@njit(cache=True, inner=True)
def _solve(matrix, vector):
    """Of a positive definite matrix, in place: Gauss without pivots."""
    for i in range(3):
        for j in range(i + 1, 3):
            factor = matrix[j, i] / matrix[i, i]
            for k in range(i, 3):
                matrix[j, k] -= factor * matrix[i, k]
            vector[j] -= factor * vector[i]
    for i in (2, 1, 0):
        for j in range(i + 1, 3):
            vector[i] -= matrix[i, j] * vector[j]
        vector[i] /= matrix[i, i]
