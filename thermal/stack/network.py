"""A stack as a passive thermal network of few states, for simulations that step many fingertips."""

from __future__ import annotations

from thermograsp.errors import positive

from ..numerics import ThermalNetwork
from .cells import stack_chain
from .design import HeatedStack


def stack_network(stack: HeatedStack, area: float, *, order: int | None = None) -> ThermalNetwork:
    """Ports: heat into the face and into the heater's place, W over `area` m2. Output "reading": K at the readout.

    order: states to keep, the most important ones (Hankel); None for all of the chain's. Surroundings are at 0.
    """
    positive("area (m2)", area)
    chain = stack_chain(stack)
    rates, turn, root = chain.modes(area)
    if not chain.loss:
        rates[0] = 0.0  # the mean temperature of an adiabatic stack, up to round-off
    rows = turn.T * root
    network = ThermalNetwork(
        rates,
        rows[:, [chain.face, chain.heater]],
        outputs={"reading": rows[:, chain.readout]},
    )
    return network if order is None else network.reduced(order=order)
