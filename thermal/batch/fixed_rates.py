"""Heat of boxes and fingertips whose networks share their rates: what differs between rows is residues alone.

A contact's flow q is known to either body by how it has faded at each of the level's rates, y' = -rate y + q: the same
numbers whatever the body, its place and its size, so that a field stays where fingertips come, go, slide and change
objects. A body's temperature at its ports is the sum over the rates of (residues y). The step is that of
network/coupling.py; as a rate's states fade alike, its products with ports are taken once and not at each pole.

Beside its contacts a body follows its surroundings (a box the air, an element its thermostat): z' = rate (around - z),
and u z of it at the ports; by reciprocity u y is heat of the flows. A box's slowest state is its own and comes first.

B: rows, F: fingertips, M: places of a box, P: patterns of a contact, N = M P, K = RATES, E = POLES_KEPT: an element's
slow poles, Q: pole pairs, T: elements under different contacts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.lanes import LANES

from ..kernels import Resolution
from ..network import POLES, WEIGHTS

FIXED_LEVEL = Resolution(12, 3, slowest=3e-3)
"""Of all networks; slower ones than a touch lasts, since in sheets of poor conductors heat stays where it is. With
slower ones still, the others would be too far from each other for metals under a small, good contact."""
SHARED = FIXED_LEVEL.decay
"""1/s: the rates of all networks."""
PAIRS = len(POLES)
_POLES, _WEIGHTS = POLES[:, None], WEIGHTS[:, None]
FADING, SEEN, PUSHED = 1, 2, 2 + 2 * PAIRS
RATE_ROWS = 2 + 4 * PAIRS  # of a rate: itself, how it fades in a step, how it is seen and pushed at the poles
HELD = RATE_ROWS  # of the slowest state of a box: sqrt(J K) of heat in it
PORT, DROP, POLE_HEAT = RATE_ROWS, RATE_ROWS + 1, RATE_ROWS + 2  # of an element's pole
RATES, POLES_KEPT = len(SHARED), 8
"""Of a level, and at most of an element's slow poles: loops of a length that the compiler knows are faster, and what is
left over is zero. So are lanes (thermograsp/lanes.py), in which the step's poles and a level's rates are taken."""
BLOCKS = RATES // LANES
USED, AIRED, WHERE = 0, 1, 2  # of FixedTables.links; then a fingertip's place each, then its element


class FixedTables(NamedTuple):
    """Rows of boxes between fingertips, for steps of dt s.

    patterns, places: P and M. rates (14, K) and poles (17, E): rates 1/s, and what a step makes of them; of poles
    their ports sqrt(K/J), drop and heat too. tips (T, P P + 2 P + 2, K): residues K/J, drop and heat rows, and what
    follows the thermostat of either. slow (B, 15 + N): of a box's slowest state the same, its heat, and its ports.
    body (B, N N + N + 1, K): residues of the places under fingertips by those of all, heat rows u, heat of what follows
    the air J/K. gram (B, F P, F P, 2, LANES): real and imaginary K/J of all that is in touch at the poles. links
    (B, 2 + 2 F): places used, whether the air takes any heat, each fingertip's place (-1 for none) and element. seen
    (K, 2, LANES): real and imaginary parts of how rates are seen at the poles, as in `rates`.
    """

    dt: float
    patterns: int
    places: int
    rates: np.ndarray
    poles: np.ndarray
    tips: np.ndarray
    slow: np.ndarray
    body: np.ndarray
    gram: np.ndarray
    links: np.ndarray
    seen: np.ndarray

    @property
    def states(self) -> int:
        """Of a row."""
        count, tips = self.rates.shape[1], (self.links.shape[1] - WHERE) // 2
        return 1 + count * (1 + self.places * self.patterns) + tips * self.of_tip

    @property
    def of_tip(self) -> int:
        """States of a fingertip; they come last, one fingertip after the other."""
        return self.poles.shape[1] + self.rates.shape[1] * (1 + self.patterns)


def no_fixed_tables(dt: float) -> FixedTables:
    """Of no rows."""
    return FixedTables(
        dt,
        1,
        1,
        np.zeros((RATE_ROWS, RATES)),
        np.zeros((RATE_ROWS + 3, POLES_KEPT)),
        np.zeros((1, 5, RATES)),
        np.zeros((0, HELD + 2)),
        np.zeros((0, 3, RATES)),
        np.zeros((0, 1, 1, 2, LANES)),
        np.zeros((0, WHERE + 2), int),
        np.zeros((RATES, 2, LANES)),
    )


def rate_table(rates: np.ndarray, dt: float) -> np.ndarray:
    """(14, n) of rates (n,) 1/s: themselves, what of a state is left after a step, how it is seen at the poles, and
    what flows at the poles push it by."""
    scale = 1 / (_POLES + dt * rates)
    weighted = -2 * dt * (_WEIGHTS * scale)
    left = 1 - rates * weighted.real.sum(axis=0)
    return np.concatenate((rates[None], left[None], scale.real, scale.imag, weighted.real, -weighted.imag))
