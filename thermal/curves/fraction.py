"""What heat flows through a contact of any conductance, once its two sides are known at complex s.

With Z the impedance of both sides between the patterns of the patch, u the first of them, the uniform one, and R the
contact's resistance, the flow is (Z + R)^-1 u. Lanczos' recursion from u, in the bilinear product of complex symmetric
matrices, makes Z tridiagonal once for all R; a flow is then a continued fraction of a few numbers.

S: samples of s, P: patterns, R: resistances.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_ENDED = 1e-20  # square of what is left, relative to the coefficient's, below which no pattern is left that u leads to


@dataclass(frozen=True, slots=True)
class Fraction:
    """a: (P, S), b: (P - 1, S): diagonal of the tridiagonal matrix and squares beside it, K/W and its square. read: (P,
    S) K/W, an output of the flow in the basis of the recursion."""

    a: np.ndarray
    b: np.ndarray
    read: np.ndarray

    def __call__(self, resistance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(heat flow W, output K), (R, S) each, per kelvin across contacts of resistances (R,) K/W."""
        diagonal = self.a[:, None] + resistance[:, None]
        for k in range(len(self.b) - 1, -1, -1):
            diagonal[k] -= self.b[k] / diagonal[k + 1]
        part = 1 / diagonal[0]
        flow, output = part, self.read[0] * part
        for k, root in enumerate(np.sqrt(self.b), 1):
            part = -root / diagonal[k] * part
            output = output + self.read[k] * part
        return flow, output


def fraction(impedance: np.ndarray, read: np.ndarray) -> Fraction:
    """Of symmetric complex matrices (S, P, P) K/W and of an output (S, P) K/W of the flows."""
    count = impedance.shape[1]
    vector = np.zeros(impedance.shape[:2], complex)
    vector[:, 0] = 1.0
    before, root = np.zeros_like(vector), np.zeros(len(vector), complex)
    a, b, rows = [], [], []
    for _ in range(count):
        residual = (impedance @ vector[..., None])[..., 0] - root[:, None] * before
        a.append(np.sum(vector * residual, axis=1))
        rows.append(np.sum(vector * read, axis=1))
        residual = residual - a[-1][:, None] * vector
        square = np.sum(residual**2, axis=1)
        ended = np.abs(square) <= _ENDED * np.abs(a[-1]) ** 2
        square = np.where(ended, 0.0, square)
        root = np.sqrt(square)
        before, vector = vector, np.where(ended[:, None], 0.0, residual / np.where(ended, 1.0, root)[:, None])
        b.append(square)
    return Fraction(np.array(a), np.array(b[:-1]), np.array(rows))
