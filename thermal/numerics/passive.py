"""A conducting body as a passive thermal network: few decaying states between heat-flow ports."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from thermograsp.errors import InvalidValueError

from .reduction import hankel_values, truncate


@dataclass(frozen=True, slots=True)
class ThermalNetwork:
    """x' = -rates x + ports q, T = ports^T x + direct q, y = outputs x.

    rates: (K,) 1/s, >= 0. ports: (K, P) sqrt(K/J), heat flow q (P,) W in, temperature T (P,) K out, both over the same
    pattern. direct: (P, P) K/W, symmetric and non-negative; none where it is empty. outputs: name -> (K,), rows on the
    state (a temperature drop, stored heat). Non-negative rates and equal in and out make any network of this form
    passive.
    Raises InvalidValueError for shapes that do not fit, negative rates or a direct term that creates heat.
    """

    rates: np.ndarray
    ports: np.ndarray
    direct: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    outputs: Mapping[str, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        rates = np.asarray(self.rates, float)
        ports = np.asarray(self.ports, float)
        direct = np.asarray(self.direct, float)
        if rates.ndim != 1 or ports.ndim != 2 or ports.shape[0] != rates.size:
            raise InvalidValueError(
                f"rates (K,) and ports (K, P) do not fit: got {rates.shape} and {ports.shape}"
            )
        given = direct.size > 0
        if not given:
            direct = np.zeros((ports.shape[1],) * 2)
        if direct.shape != (ports.shape[1],) * 2:
            raise InvalidValueError(f"direct must be (P, P) = {(ports.shape[1],) * 2}, got {direct.shape}")
        if not math.isfinite(rates.sum() + ports.sum() + (direct.sum() if given else 0.0)):
            raise InvalidValueError("rates, ports and direct must be finite")
        if rates.size and rates.min() < 0:
            raise InvalidValueError(f"rates must be >= 0 for a passive network, got {rates.min():g} 1/s")
        if given and not _passive(direct):
            raise InvalidValueError("direct must be symmetric and non-negative for a passive network")
        outputs = {name: np.asarray(row, float) for name, row in self.outputs.items()}
        for name, row in outputs.items():
            if row.shape != rates.shape:
                raise InvalidValueError(f"output {name!r} must be (K,) = {rates.shape}, got {row.shape}")
        for name, value in (("rates", rates), ("ports", ports), ("direct", direct)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "outputs", outputs)

    @classmethod
    def of_rates(
        cls, rates: np.ndarray, ports: np.ndarray, outputs: Mapping[str, np.ndarray]
    ) -> ThermalNetwork:
        """One without a direct term, of rates that are known to be passive and arrays that fit: only what is not
        finite is looked for. For callers who make thousands."""
        if not math.isfinite(np.vdot(ports, ports)):
            raise InvalidValueError("ports must be finite")
        made = object.__new__(cls)
        for name, value in (("rates", rates), ("ports", ports), ("outputs", outputs)):
            object.__setattr__(made, name, value)
        object.__setattr__(made, "direct", np.zeros((ports.shape[1],) * 2))
        return made

    @property
    def order(self) -> int:
        """Number of states."""
        return self.rates.size

    def impedance(self, s: np.ndarray | complex) -> np.ndarray:
        """Temperature per heat flow (..., P, P) K/W at s (...) 1/s, real or complex."""
        s = np.asarray(s)
        weights = 1 / (s[..., None] + self.rates)
        return np.einsum("kp,...k,kr->...pr", self.ports, weights, self.ports) + self.direct

    def step_response(self, t: np.ndarray) -> np.ndarray:
        """Temperatures (n, P, P) K/W at t (n,) s after a unit heat flow is switched on at each port, P last."""
        t = np.asarray(t, float)
        # -expm1(-rate t) / rate, and t itself where the rate is 0
        product = np.outer(t, self.rates)
        grown = t[:, None] * np.where(product > 1e-12, -np.expm1(-product) / np.maximum(product, 1e-300), 1.0)
        return np.einsum("kp,nk,kr->npr", self.ports, grown, self.ports) + np.where(
            t[:, None, None] >= 0, self.direct, 0.0
        )

    def projected(self, basis: np.ndarray) -> ThermalNetwork:
        """The network on the span of orthonormal columns (K, R): passive like the original (congruence)."""
        rates, rotation = np.linalg.eigh((basis.T * self.rates) @ basis)
        turned = basis @ rotation
        rows = {name: turned.T @ row for name, row in self.outputs.items()}
        return ThermalNetwork(np.maximum(rates, 0.0), turned.T @ self.ports, self.direct, rows)

    def reduced(self, *, order: int | None = None, tolerance: float | None = None) -> ThermalNetwork:
        """The network with `order` states, or with the fewest whose impedance is within `tolerance` K/W at every
        frequency. States of rate 0 (an adiabatic body's mean temperature) are kept and count.

        Raises InvalidValueError when neither or both are given, or they are out of range."""
        if (order is None) == (tolerance is None):
            raise InvalidValueError("give either order or tolerance")
        still = self.rates <= 1e-12 * self.rates.max(initial=0.0)
        moving = ~still
        values, _ = hankel_values(self.rates[moving], self.ports[moving])
        if tolerance is not None:
            if not tolerance > 0:
                raise InvalidValueError(f"tolerance must be > 0 K/W, got {tolerance!r}")
            tails = 2 * np.append(np.cumsum(values[::-1])[::-1], 0.0)
            kept = int(np.argmax(tails <= tolerance))
        else:
            assert order is not None
            kept = order - int(still.sum())
            if not 0 <= kept <= moving.sum():
                raise InvalidValueError(
                    f"order must be {int(still.sum())} .. {self.order} for this network, got {order}"
                )
        rates, ports, outputs, _ = truncate(
            self.rates[moving], self.ports[moving], {n: r[moving] for n, r in self.outputs.items()}, kept
        )
        return ThermalNetwork(
            np.concatenate((self.rates[still], rates)),
            np.concatenate((self.ports[still], ports)),
            self.direct,
            {n: np.concatenate((self.outputs[n][still], outputs[n])) for n in self.outputs},
        )


def _passive(direct: np.ndarray) -> bool:
    """Whether it is symmetric and nowhere negative."""
    least = np.linalg.eigvalsh(direct).min() if direct.any() else 0.0
    return np.allclose(direct, direct.T) and least >= -1e-12 * np.abs(direct).max(initial=0.0)
