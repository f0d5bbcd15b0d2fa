"""The states that a contact excites: orthonormal bases on which its bodies' networks are reduced.

Heat flows into a body as its contact drives them, not as any pattern at any frequency. So the basis is made of the
body's own responses to the flows of coupled contacts, over the moments and conductances that occur, and of the
adjoint responses of its outputs, which make the error quadratic; singular vectors put them in order of weight (proper
orthogonal decomposition in the Laplace domain; Willcox & Peraire, AIAA J. 40, 2002). Projection on any of them stays
passive.

P: modes of one contact, K: states of a body, S: samples.
"""

from __future__ import annotations

import re
from dataclasses import astuple, dataclass
from typing import Literal

import numpy as np

from thermograsp.errors import InvalidValueError

from ..numerics import ThermalNetwork
from .coupling import POLES

MOMENTS = np.geomspace(1 / 150, 150, 25)  # 1/s
CONDUCTANCES = (1e2, 1e3, 1e4, 1e5, 1e7)  # W/(m2 K)


@dataclass(frozen=True, slots=True)
class Orders:
    """Size of a contact's networks: modes of the patch, states of the sensor (0 in O mode), of the even body and, with
    two fingertips, of the odd one."""

    modes: int
    sensor: int
    even: int
    odd: int | None = None

    def __str__(self) -> str:
        return "/".join(str(order) for order in astuple(self) if order is not None)

    @classmethod
    def parse(cls, text: str) -> Orders:
        """From "modes/sensor/object" (one fingertip) or "modes/sensor/even/odd", e.g. "2/10/12/12". Raises
        InvalidValueError."""
        if not re.fullmatch(r"\d+(/\d+){2,3}", text):
            raise InvalidValueError(
                f"orders must read modes/sensor/object or modes/sensor/even/odd, e.g. 2/10/12, got {text!r}"
            )
        return cls(*map(int, text.split("/")))

    @property
    def fingertips(self) -> Literal[1, 2]:
        """1, or 2 on opposite faces."""
        return 1 if self.odd is None else 2

    @property
    def states(self) -> int:
        """The number of states of the fingertips and the object."""
        return self.fingertips * self.sensor + self.even + (self.odd or 0)

    @property
    def multiply_adds(self) -> int:
        """Multiply-adds of one step as coupling.py takes it, real ones (a complex one is four)."""
        n, m = self.states, self.fingertips * self.modes
        return 2 * n * m + len(POLES) * 4 * (2 * n * m + m**3 // 3)


@dataclass(frozen=True, slots=True)
class StateBasis:
    """The states of a body that a contact excites. vectors: (K, R) orthonormal, the most excited first, after `still`
    states of rate 0. weights: (R,) their singular values relative to the whole contact's largest."""

    vectors: np.ndarray
    weights: np.ndarray
    still: int


def state_bases(networks: dict[str, ThermalNetwork], area: float) -> dict[str, StateBasis]:
    """A basis per body of a contact (names as in bodies.py). area: m2 of the contact."""
    z = {name: network.impedance(MOMENTS) for name, network in networks.items()}
    modes = z["even"].shape[1]
    uniform = np.eye(modes)[0]
    sensor = z.get("sensor", 0.0)
    flows: dict[str, list[np.ndarray]] = {name: [] for name in networks}
    for conductance in CONDUCTANCES:
        resistance = np.eye(modes) / (conductance * area)
        all_touch = np.linalg.solve(sensor + z["even"] + resistance, uniform)
        flows["even"].append(all_touch)
        alone = all_touch
        if "odd" in z:
            alone = np.linalg.solve(sensor + (z["even"] + z["odd"]) / 2 + resistance, uniform)
            flows["even"].append(alone)
            flows["odd"].append(alone)
        if "sensor" in z:
            flows["sensor"] += [all_touch, alone]
    bases = {name: excited_states(network, np.array(flows[name])) for name, network in networks.items()}
    return bases


def reduce(
    networks: dict[str, ThermalNetwork], bases: dict[str, StateBasis], orders: Orders
) -> dict[str, ThermalNetwork]:
    """The bodies' networks projected on the first states of their bases. Raises InvalidValueError for an order that a
    basis cannot fill."""
    reduced = {}
    for name, network in networks.items():
        order, basis = getattr(orders, name), bases[name]
        most = basis.vectors.shape[1]
        if not basis.still < order <= most:
            raise InvalidValueError(
                f"the {name} body's order must be {basis.still + 1} .. {most}, got {order}"
            )
        reduced[name] = network.projected(basis.vectors[:, :order])
    return reduced


def excited_states(network: ThermalNetwork, flows: np.ndarray) -> StateBasis:
    """flows: (cases, S, P)."""
    still = network.rates <= 1e-12 * network.rates.max()
    moving = ~still
    answer = np.sqrt(MOMENTS[:, None]) / (MOMENTS[:, None] + network.rates[moving])  # (S, K)
    excited = answer[None] * np.einsum("kp,csp->csk", network.ports[moving], flows)
    snapshots = [excited.reshape(-1, excited.shape[-1]) / np.sqrt(len(flows))]
    if "drop" in network.outputs:
        # Adjoint of the drop, brought to the weight of the flows.
        adjoint = answer * network.outputs["drop"][moving]
        snapshots.append(adjoint * np.linalg.norm(excited) / np.sqrt(len(flows)) / np.linalg.norm(adjoint))
    vectors, weights, _ = np.linalg.svd(np.concatenate(snapshots).T, full_matrices=False)
    kept = weights > 1e-9 * weights[0]
    count = int(still.sum())
    embedded = np.zeros((network.order, count + int(kept.sum())))
    embedded[still, :count] = np.eye(count)
    embedded[moving, count:] = vectors[:, kept]
    relative = np.concatenate((np.full(count, np.inf), weights[kept] / weights[0]))
    return StateBasis(embedded, relative, count)
