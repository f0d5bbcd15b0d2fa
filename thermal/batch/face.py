"""Temperature over a sensor's face: what the network's mean leaves out, from where the contact is.

A network knows the heat flow through a contact and the face's mean temperature over it. How the temperature differs
over the face follows from where the face is touched: element and object are taken as rods of the face's own section
with adiabatic sides, whose lateral eigenfunctions are cosines (Carslaw & Jaeger, Conduction of Heat in Solids, 2nd ed.,
section 5.6). Each cosine but the uniform one has an impedance of its own on either side (impedance.stack_impedance),
reduced to ORDER decaying states, and the flux q of each cell of the face is that of the conductance h there,

    q = h (c + T_face - T_object),  mean of q = the network's,

c, the mean difference, being what makes the flow the network's. The object's heat spreads beyond the face in the
network's flow only, not in this pattern.

N: cells along a side of the face, P: cosines along a side, K: states of a cosine.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import positive

from ..matter import Layer, SensorStack
from ..network import SHIFTS
from ..numerics import Sampled, interpolate, truncate
from ..plates import Far, stack_impedance

CELLS = 18  # along the face: half a millimetre of 9
COSINES = 18  # along the face
ORDER = 5  # states of a cosine on either side
_TINY = 1e-30
_STILL = 1e-9  # of the fastest rate
_ITERATIONS = 60
_RESIDUAL = 1e-6  # of the flux


class FaceField(NamedTuple):
    """The two sides of a face for steps of one length: first the element, then the object. waves: (P, N) means over the
    cells of the cosines, of mean square 1. decay, gain: (2, P, P, K) of the states over a step, and their K per W/m2 of
    flux during it. at_once: (2, P, P) K m2/W, what the flux of a step has done at its end. self_impedance: K m2/W, of a
    cell's flux on its own temperature, both sides together, the mean over the cells."""

    waves: np.ndarray
    decay: np.ndarray
    gain: np.ndarray
    at_once: np.ndarray
    self_impedance: float


class FaceState(NamedTuple):
    """The state of one face's heat. fields: (2, P, P, K) K, of the cosines' states. surface: (P, P) K, of the face's
    cosines. contact: (N, N) shares of the cells that touch, or touched last."""

    fields: np.ndarray
    surface: np.ndarray
    contact: np.ndarray


def face_field(stack: SensorStack, behind: Layer, dt: float) -> FaceField:
    """stack: the element, on its thermostat. behind: the object, its far face adiabatic. dt: s. Raises
    InvalidValueError for a step that is none."""
    positive("dt (s)", dt)
    element = stack.layers[::-1]
    sides = [_sides(element, "isothermal", stack.width), _sides((behind,), "adiabatic", stack.width)]
    rates, weights, direct = (np.stack(parts) for parts in zip(*sides, strict=True))
    decay = np.exp(-rates * dt)
    gain = weights * -np.expm1(-rates * dt) / np.where(rates > 0, rates, 1.0)
    at_once = gain.sum(axis=-1) + direct
    waves = cosine_means(CELLS)
    squares = waves**2
    self_impedance = float((squares.T @ at_once.sum(axis=0) @ squares).mean()) / CELLS**2
    return FaceField(waves, decay, gain, at_once, self_impedance)


def face_state() -> FaceState:
    """The state of a face that is as warm as its thermostat everywhere."""
    return FaceState(
        np.zeros((2, COSINES, COSINES, ORDER)), np.zeros((COSINES, COSINES)), np.ones((CELLS, CELLS))
    )


@lru_cache(maxsize=16)
def cosine_means(parts: int) -> np.ndarray:
    """(P, parts): means of the cosines, of mean square 1 over the face, over so many equal parts of a side."""
    order = np.arange(COSINES)[:, None]
    middles = (np.arange(parts) + 0.5) / parts
    means = np.sqrt(2.0) * np.cos(np.pi * order * middles) * np.sinc(order / (2 * parts))
    means[0] = 1.0
    means.flags.writeable = False
    return means


@lru_cache(maxsize=64)
def _sides(layers: tuple[Layer, ...], far: Far, width: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """rates (P, P, K) 1/s, weights (P, P, K) K m2/J and at once (P, P) K m2/W of a rod seen through its face; the
    uniform cosine is left out."""
    rates, weights = (np.zeros((COSINES, COSINES, ORDER)) for _ in range(2))
    direct = np.zeros((COSINES, COSINES))
    for p in range(1, COSINES):
        for q in range(p + 1):
            found = _reduced(layers, far, (np.pi / width) ** 2 * (p * p + q * q))
            rates[p, q], weights[p, q], direct[p, q] = rates[q, p], weights[q, p], direct[q, p] = found
    return rates, weights, direct


def _reduced(layers: tuple[Layer, ...], far: Far, kappa2: float) -> tuple[np.ndarray, np.ndarray, float]:
    """rates (K,), weights (K,) and what of the steady state these lack, of one cosine's impedance."""
    wave = np.array([kappa2])
    at = SHIFTS * (1 + 1j * _TINY)
    z = stack_impedance(layers, far, at[:, None], wave)[:, 0]
    slope = np.imag(z) / (_TINY * SHIFTS)
    rates, ports, _ = interpolate(SHIFTS, Sampled(np.real(z)[:, None, None], slope[:, None, None]), {})
    rates, ports, _, _ = truncate(rates, ports, {}, min(ORDER, len(rates)))
    lasting = rates > _STILL * rates.max()  # the others are rounding's: both bodies settle
    rates, weights = rates[lasting], ports[lasting, 0] ** 2
    steady = stack_impedance(layers, far, np.full((1, 1), 1e-12), wave)[0, 0]
    left = max(steady - float((weights / rates).sum()), 0.0)
    missing = ORDER - len(rates)
    return np.append(rates, np.ones(missing)), np.append(weights, np.zeros(missing)), left


@njit(cache=True, error_model="numpy")
def step_face(field, conductance, flux, fields, surface, contact):
    """One step of a face, in place in a FaceState's arrays. conductance: (N, N) W/(m2 K) of the cells, 0 where apart.
    flux: W/m2 out of the face, its mean over the face and the step."""
    waves, decay, gain, at_once, self_impedance = field
    cosines, cells = waves.shape
    through = np.zeros((cells, cells))
    difference = np.zeros((cosines, cosines))
    for p in range(cosines):
        for q in range(cosines):
            total = 0.0
            for k in range(fields.shape[3]):
                fields[0, p, q, k] *= decay[0, p, q, k]
                fields[1, p, q, k] *= decay[1, p, q, k]
                total += fields[0, p, q, k] - fields[1, p, q, k]
            difference[p, q] = total
    touching = 0
    for i in range(cells):
        for j in range(cells):
            touching += conductance[i, j] > 0.0
    if touching > 0:
        drive = np.zeros((cells, cells))
        _back(waves, waves, difference, drive)
        one, other = np.zeros((cells, cells)), np.zeros((cells, cells))
        _flux_of(conductance, waves, at_once, self_impedance, np.ones((cells, cells)), one)
        _flux_of(conductance, waves, at_once, self_impedance, drive, other)
        of_one, of_other = one.sum(), other.sum()
        share = (flux * cells * cells - of_other) / of_one
        for i in range(cells):
            for j in range(cells):
                through[i, j] = other[i, j] + share * one[i, j]
                contact[i, j] = 1.0 if conductance[i, j] > 0.0 else 0.0
    cosine_flux = np.zeros((cosines, cosines))
    _forth(waves, through, cosine_flux)
    for p in range(cosines):
        for q in range(cosines):
            total = 0.0
            lasting = 0.0
            for k in range(fields.shape[3]):
                fields[0, p, q, k] -= gain[0, p, q, k] * cosine_flux[p, q]
                fields[1, p, q, k] += gain[1, p, q, k] * cosine_flux[p, q]
                total += fields[0, p, q, k]
                lasting += gain[0, p, q, k]
            surface[p, q] = total - (at_once[0, p, q] - lasting) * cosine_flux[p, q]


@njit(cache=True, error_model="numpy")
def face_means(waves, surface, contact, rows, columns):
    """(n, m) K above the mean over the contact, of equal parts of the face. waves: FaceField's. surface and contact: a
    FaceState's. rows: (P, n) along the first axis and columns: (P, m) along the second, both of cosine_means."""
    cells = np.zeros(contact.shape)
    _back(waves, waves, surface, cells)
    total, touched = 0.0, 0.0
    for i in range(contact.shape[0]):
        for j in range(contact.shape[1]):
            total += contact[i, j] * cells[i, j]
            touched += contact[i, j]
    means = np.zeros((rows.shape[1], columns.shape[1]))
    _back(rows, columns, surface, means)
    return means - total / touched


@njit(cache=True, inner=True, error_model="numpy")
def _flux_of(conductance, waves, at_once, self_impedance, drive, flux):
    """Solves flux / conductance + (what flux does at once) = drive in the cells that touch, by conjugate gradients."""
    cells = len(drive)
    cosine_flux = np.zeros(at_once.shape[1:])
    warmed, residual, along = np.zeros_like(drive), np.zeros_like(drive), np.zeros_like(drive)
    flux[:] = 0.0
    size = 0.0
    for i in range(cells):
        for j in range(cells):
            if conductance[i, j] > 0.0:
                residual[i, j] = drive[i, j]
                along[i, j] = drive[i, j] / (1 / conductance[i, j] + self_impedance)
                size += residual[i, j] * along[i, j]
    first = size
    for _ in range(_ITERATIONS):
        if size <= _RESIDUAL**2 * first:
            break
        _forth(waves, along, cosine_flux)
        for p in range(len(cosine_flux)):
            for q in range(len(cosine_flux)):
                cosine_flux[p, q] *= at_once[0, p, q] + at_once[1, p, q]
        _back(waves, waves, cosine_flux, warmed)
        curvature = 0.0
        for i in range(cells):
            for j in range(cells):
                if conductance[i, j] > 0.0:
                    warmed[i, j] += along[i, j] / conductance[i, j]
                    curvature += along[i, j] * warmed[i, j]
        length = size / curvature
        before, size = size, 0.0
        for i in range(cells):
            for j in range(cells):
                if conductance[i, j] > 0.0:
                    flux[i, j] += length * along[i, j]
                    residual[i, j] -= length * warmed[i, j]
                    size += residual[i, j] ** 2 / (1 / conductance[i, j] + self_impedance)
        turn = size / before
        for i in range(cells):
            for j in range(cells):
                if conductance[i, j] > 0.0:
                    along[i, j] = (
                        residual[i, j] / (1 / conductance[i, j] + self_impedance) + turn * along[i, j]
                    )


@njit(cache=True, inner=True, error_model="numpy")
def _forth(waves, cells, cosines):
    """Writes the cosines' shares (P, P) of what is constant in each cell (N, N)."""
    count, parts = waves.shape
    half = np.zeros((count, parts))
    for p in range(count):
        for i in range(parts):
            weight = waves[p, i] / (parts * parts)
            for j in range(parts):
                half[p, j] += weight * cells[i, j]
    for p in range(count):
        for q in range(count):
            total = 0.0
            for j in range(parts):
                total += half[p, j] * waves[q, j]
            cosines[p, q] = total


@njit(cache=True, inner=True, error_model="numpy")
def _back(rows, columns, cosines, parts):
    """Writes the means over parts (n, m) of a sum of cosines (P, P), from those of the cosines along either axis."""
    count, across = columns.shape
    half = np.zeros((count, across))
    for p in range(count):
        for q in range(count):
            for j in range(across):
                half[p, j] += cosines[p, q] * columns[q, j]
    parts[:] = 0.0
    for p in range(count):
        for i in range(rows.shape[1]):
            for j in range(across):
                parts[i, j] += rows[p, i] * half[p, j]
