"""Steps of chains of lumps with one link that changes: compiled, one touch after the other.

The steps are an L-stable, stiffly accurate SDIRK2 (gamma = 1 - 1/sqrt 2: Alexander, SIAM J. Numer. Anal. 14, 1977),
each stage one tridiagonal elimination. B: touches, n: steps, N: nodes.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

_GAMMA = 1 - 0.5**0.5


@njit(cache=True, error_model="numpy")
def march(
    capacity, links, joint, contact, state, heater, power, controller, until, back, loss, ambient, readout, dt
):
    """capacity: (B, N). links: (B, N - 1), of which `joint` is the contact, (B, n) W/(m2 K) in each step. state: (B, N)
    °C, which goes on in place. power: (B, n) W/m2 into node `heater`, or where controller's limit is above 0 what its
    integral starts with. loss: W/(m2 K) of node `back` to ambient (B,) °C. Returns reading (B, n + 1) °C of node
    `readout`, heat (B, n) J/m2 through the contact, out of the stack, and used (B, n) W/m2."""
    count, steps = contact.shape
    nodes = capacity.shape[1]
    reading, heat, used = np.zeros((count, steps + 1)), np.zeros((count, steps)), np.zeros((count, steps))
    setpoint, proportional, integral, derivative, limit = controller
    first, second = np.zeros(nodes), np.zeros(nodes)
    diagonal, middle = np.zeros(nodes), np.zeros(nodes)
    link = np.zeros(nodes - 1)
    for b in range(count):
        x, c = state[b], capacity[b]
        link[:] = links[b]
        reading[b, 0] = x[readout]
        summed, before = power[b, 0], x[readout]
        for k in range(steps):
            link[joint] = contact[b, k]
            given = power[b, k]
            if limit > 0:
                error = setpoint - x[readout]
                grown = summed + integral * error * dt
                wanted = proportional * error + grown - derivative * (x[readout] - before) / dt
                given = min(max(wanted, 0.0), limit)
                if (wanted - given) * error <= 0:
                    summed = grown
                if k >= until[b]:
                    given = 0.0
                before = x[readout]
            _stage(c, link, x, heater, given, back, loss, ambient[b], dt, diagonal, first)
            for i in range(nodes):
                middle[i] = x[i] + dt * (1 - _GAMMA) * first[i]
            _stage(c, link, middle, heater, given, back, loss, ambient[b], dt, diagonal, second)
            for i in range(nodes):
                one = x[i] + dt * _GAMMA * first[i]
                two = middle[i] + dt * _GAMMA * second[i]
                x[i] += dt * ((1 - _GAMMA) * first[i] + _GAMMA * second[i])
                # temperatures of the two stages, whose differences over the contact carry the heat
                first[i], second[i] = one, two
            flow = (1 - _GAMMA) * (first[joint] - first[joint + 1]) + _GAMMA * (
                second[joint] - second[joint + 1]
            )
            heat[b, k] = dt * contact[b, k] * flow
            used[b, k] = given
            reading[b, k + 1] = x[readout]
    return reading, heat, used


@njit(cache=True, inner=True, error_model="numpy")
def _stage(capacity, link, x, heater, power, back, loss, ambient, dt, diagonal, rate):
    """Fills rate (N,) K/s with the solution of (C + gamma dt L) rate = power - L x."""
    nodes = len(capacity)
    step = _GAMMA * dt
    for i in range(nodes):
        flow, sum_of_links = 0.0, 0.0
        if i > 0:
            flow += link[i - 1] * (x[i - 1] - x[i])
            sum_of_links += link[i - 1]
        if i < nodes - 1:
            flow += link[i] * (x[i + 1] - x[i])
            sum_of_links += link[i]
        if i == back:
            flow += loss * (ambient - x[i])
            sum_of_links += loss
        if i == heater:
            flow += power
        diagonal[i] = capacity[i] + step * sum_of_links
        rate[i] = flow
    for i in range(1, nodes):
        factor = step * link[i - 1] / diagonal[i - 1]
        diagonal[i] -= factor * step * link[i - 1]
        rate[i] += factor * rate[i - 1]
    rate[nodes - 1] /= diagonal[nodes - 1]
    for i in range(nodes - 2, -1, -1):
        rate[i] = (rate[i] + step * link[i] * rate[i + 1]) / diagonal[i]
