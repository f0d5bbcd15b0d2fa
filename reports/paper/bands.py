"""The experiment with conditions that the paper does not state drawn at random: the bands that they leave to figure 6.

Each draw is one rig: how rough the faces are, how hard they are pressed, how warm thermostat and objects were and how
much heat the air takes from the objects. All ten materials are measured on it, in both modes. A statement that holds on
nearly every rig is supported by the model; one that holds on some depends on what is not known.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from thermograsp.figures import readable
from thermograsp.reports.paper.sweeps import MATERIALS, MODES, Effort, Rig, Sweep, rough_conductances, sweep
from thermograsp.thermal.matter import Mode


@dataclass(frozen=True, slots=True)
class Unknown:
    """Lowest and highest value of what is not known. logarithmic: whether it is drawn evenly in its logarithm."""

    low: float
    high: float
    meaning: str
    logarithmic: bool = False


UNKNOWN: Mapping[str, Unknown] = {
    "roughness": Unknown(0.5e-6, 20e-6, "m rms of the faces, lapped to coarsely milled", True),
    "pressure": Unknown(2e3, 1e5, "Pa on the faces, 0.16 to 8 N on the element", True),
    "thermostat": Unknown(35.0, 37.0, "°C of the thermostat, stated as 36"),
    "room": Unknown(22.0, 26.0, "°C of room and objects, stated as 24"),
    "air": Unknown(2.0, 15.0, "W/(m2 K) from the objects' free faces to still or moving air"),
}
"""By the names of Rig's fields. The ranges are estimates of ours; the paper states none of them."""
SHARE = 0.9
"""Of the rigs that a band holds, the middle ones."""
RUNGS = {"O": "network:2/0/16", "T": "network:3/16/16"}
"""Networks that serve every rig, made once: within 0.003 K of those chosen for a tolerance of 0.002 K."""
_SEED = 0
_MOMENTS = (2.0, 8.0, 20.0)  # s, of the table
_FEWEST, _CLEAR = 4, 0.25  # rigs on either side, and how far from chance one unknown must part them


@dataclass(frozen=True, slots=True)
class Bands:
    """The experiment on drawn rigs. rigs: those drawn. sweeps: one for each rig, by mode."""

    rigs: tuple[Rig, ...]
    sweeps: tuple[Mapping[str, Sweep], ...]

    def band(self, mode: str) -> tuple[np.ndarray, np.ndarray]:
        """(low, high), each (10, n) K: drops between which SHARE of the rigs lie, at each moment by itself."""
        drops = np.array([by_mode[mode].drop for by_mode in self.sweeps])
        low, high = np.quantile(drops, ((1 - SHARE) / 2, (1 + SHARE) / 2), axis=0)
        return low, high

    def deciding(self, holds: np.ndarray) -> tuple[str, float, float] | None:
        """The unknown by whose ranks the rigs of a mask differ most from the others, with its median in both. None
        where one side has fewer than _FEWEST rigs, or where no unknown parts them clearly."""
        if min(holds.sum(), (~holds).sum()) < _FEWEST:
            return None
        values = {name: np.array([getattr(rig, name) for rig in self.rigs]) for name in UNKNOWN}
        above = {name: _share_above(each[holds], each[~holds]) for name, each in values.items()}
        name = max(above, key=lambda each: abs(above[each] - 0.5))
        if abs(above[name] - 0.5) < _CLEAR:
            return None
        return name, float(np.median(values[name][holds])), float(np.median(values[name][~holds]))

    def at(self, mode: str, moment: float) -> tuple[np.ndarray, np.ndarray]:
        """The band (10,) K at the sample nearest to a moment, s."""
        low, high = self.band(mode)
        nearest = int(np.argmin(np.abs(self.t - moment)))
        return low[:, nearest], high[:, nearest]

    def lines(self) -> list[str]:
        """Lines for people: what was drawn, and the bands at a few moments."""
        rows = [["K"], *([readable(name)] for name in MATERIALS)]
        for mode in MODES:
            for moment in _MOMENTS:
                rows[0].append(f"{mode} {moment:g} s")
                for row, low, high in zip(rows[1:], *self.at(mode, moment), strict=True):
                    row.append(f"{low:.2f}-{high:.2f}")
        return [
            f"What the paper does not say of its experiment (fig. 6), drawn for {len(self.rigs)} rigs:",
            *(f"  {name}: {each.low:g} to {each.high:g} {each.meaning}" for name, each in UNKNOWN.items()),
            "",
            f"Drops between which {100 * SHARE:.0f} % of the rigs lie, by mode and time:",
            *("".join([row[0].ljust(16), *(cell.rjust(12) for cell in row[1:])]) for row in rows),
        ]

    def document(self) -> dict[str, object]:
        """The same as numbers, for machines."""
        return {
            "rigs": len(self.rigs),
            "share": SHARE,
            "unknown": {name: asdict(each) for name, each in UNKNOWN.items()},
            "drop_K": [
                {"mode": mode, "t_s": moment, "material": name, "low": float(low), "high": float(high)}
                for mode in MODES
                for moment in _MOMENTS
                for name, low, high in zip(MATERIALS, *self.at(mode, moment), strict=True)
            ],
        }

    @property
    def t(self) -> np.ndarray:
        """(n,) s."""
        return self.sweeps[0]["T"].t


def draw_rigs(count: int) -> tuple[Rig, ...]:
    """So many rigs, by a Latin hypercube over UNKNOWN; the same ones at every call."""
    rng = np.random.default_rng(_SEED)
    drawn = {}
    for name, each in UNKNOWN.items():
        share = (rng.permutation(count) + rng.uniform(size=count)) / count
        low, high = (np.log(x) if each.logarithmic else x for x in (each.low, each.high))
        values = low + share * (high - low)
        drawn[name] = np.exp(values) if each.logarithmic else values
    return tuple(Rig(**{name: float(values[k]) for name, values in drawn.items()}) for k in range(count))


def draw_bands(rigs: Sequence[Rig], mode: Mode, effort: Effort) -> tuple[Sweep, ...]:
    """The experiment on each rig in one mode."""
    return tuple(
        sweep(mode, rough_conductances(mode, rig), effort, rig=rig, rung=RUNGS[mode]) for rig in rigs
    )


def _share_above(first: np.ndarray, second: np.ndarray) -> float:
    """Of all pairs, those in which first is the larger one: 0.5 by chance."""
    return float((first[:, None] > second[None]).mean())
