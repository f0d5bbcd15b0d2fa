"""What fingertips' electronics say of them, and the readings of which a ThermalTouch tells.

W: worlds, F: fingertips, E: glued elements, S = F + E: sensors, O: objects, T = O + F: targets of a contact.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from thermograsp.compiled import njit

from ..thermal.readout import measure_rows
from .contacts import COLUMNS, FORCE
from .pointers import chains, floats, table, words

SAMPLES = 16
"""Of the voltage that a reading holds."""
NOISE_BLOCK = 32
"""Samples for which noise is drawn at once."""


@dataclass(frozen=True)
class Layout:
    """What the numbers of a reading are: of each world (W, SIZE), the voltages of all sensors, their drops, the
    fingertips' forces and those beside, the objects' temperatures, and what each fingertip touches, -1 for nothing.
    names: of the objects, the fingertips, and "" for the last one. contents: numbers of the objects that have any,
    whose temperatures stand behind."""

    tips: int
    sensors: int
    objects: int
    names: tuple[str, ...]
    many: bool
    contents: tuple[int, ...] = ()

    @cached_property
    def starts(self) -> tuple[int, ...]:
        """Where drops, forces, forces beside, temperatures and touches begin, and how many numbers there are."""
        drops = self.sensors * SAMPLES
        forces = drops + self.sensors
        beside = forces + self.tips
        temperatures = beside + self.tips
        touching = temperatures + self.objects
        return drops, forces, beside, temperatures, touching, touching + self.tips


class TouchReading:
    """What the fingertips feel at `time` s. failed: whether the simulation broke down; its numbers are nan then. Two
    are equal where all that they tell is.

    Of many worlds, everything has a leading axis of worlds, and `touching` is a tuple of tuples."""

    __slots__ = ("_layout", "_numbers", "failed", "time")

    time: float | np.ndarray
    failed: bool | np.ndarray

    def __init__(
        self, time: float | np.ndarray, failed: bool | np.ndarray, numbers: np.ndarray, layout: Layout
    ) -> None:
        put = object.__setattr__
        put(self, "time", time)
        put(self, "failed", failed)
        put(self, "_numbers", numbers)
        put(self, "_layout", layout)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a TouchReading does not change: {name!r} cannot be set")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a TouchReading does not change: {name!r} cannot be deleted")

    def __reduce__(self) -> tuple[Any, ...]:
        return TouchReading, (self.time, self.failed, self._numbers, self._layout)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TouchReading):
            return NotImplemented
        pairs = (
            (self.time, other.time),
            (self.failed, other.failed),
            (self._numbers, other._numbers),
        )
        return self._layout == other._layout and all(np.array_equal(*pair, equal_nan=True) for pair in pairs)

    __hash__ = None  # pyright: ignore[reportAssignmentType]

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={getattr(self, name)!r}" for name in _SHOWN)
        return f"TouchReading({fields})"

    @property
    def voltage(self) -> np.ndarray:
        """(F, SAMPLES) V as the driver reports it, oldest first."""
        return self._volts(0, self._layout.tips)

    @property
    def element_voltage(self) -> np.ndarray:
        """(E, SAMPLES) V of the elements that are glued on objects, in the order of `ThermalTouch.elements`."""
        return self._volts(self._layout.tips, self._layout.sensors)

    @property
    def temperature_drop(self) -> np.ndarray:
        """(F,) K over the sensed layer."""
        first = self._layout.starts[0]
        return self._rows(first, first + self._layout.tips)

    @property
    def element_drop(self) -> np.ndarray:
        """(E,) K of the glued elements."""
        first, last = self._layout.starts[:2]
        return self._rows(first + self._layout.tips, last)

    @property
    def force(self) -> np.ndarray:
        """(F,) N normal on the pads, means over the last dt."""
        return self._rows(*self._layout.starts[1:3])

    @property
    def beside(self) -> np.ndarray:
        """(F,) N on the fingertips off their pads, means over the last dt."""
        return self._rows(*self._layout.starts[2:4])

    @property
    def object_temperature(self) -> Mapping[str, float | np.ndarray]:
        """°C by object, its mean."""
        found = self._rows(*self._layout.starts[3:5])
        columns = found.T if self._layout.many else found.tolist()
        return dict(zip(self._layout.names, columns, strict=False))

    @property
    def contents_temperature(self) -> Mapping[str, float | np.ndarray]:
        """°C of what is in an object, by object, of those that have contents."""
        names, inside = self._layout.names, self._layout.contents
        first = self._layout.starts[-1]
        found = self._rows(first, first + len(inside))
        columns = found.T if self._layout.many else found.tolist()
        return dict(zip([names[o] for o in inside], columns, strict=True))

    @property
    def touching(self) -> tuple[str, ...] | tuple[tuple[str, ...], ...]:
        """(F,) names of objects or other fingertips, the one that presses most where there are several, "" where
        none."""
        names = self._layout.names
        worlds = self._numbers[:, slice(*self._layout.starts[4:])].astype(int).tolist()
        found = tuple([tuple([names[t] for t in world]) for world in worlds])
        return found if self._layout.many else found[0]

    def _volts(self, first: int, last: int) -> np.ndarray:
        found = self._rows(first * SAMPLES, last * SAMPLES)
        return found.reshape(*found.shape[:-1], last - first, SAMPLES)

    def _rows(self, first: int, last: int) -> np.ndarray:
        found = self._numbers[:, first:last]
        return found if self._layout.many else found[0]


_SHOWN = (
    *("time", "voltage", "temperature_drop", "force", "beside", "touching", "object_temperature", "failed"),
    *("element_voltage", "element_drop", "contents_temperature"),
)


class Noise:
    """Standard normal numbers of each world's generator, S for each sample, in the order in which the generator would
    give them one by one; they are drawn for many samples at once. ahead: (W, NOISE_BLOCK, S). at: (W,) the next one."""

    def __init__(self, seeds: Sequence[int], sensors: int) -> None:
        self.ahead, self.at = np.zeros((len(seeds), NOISE_BLOCK, sensors)), np.zeros(len(seeds), np.int64)
        self._rngs = [np.random.default_rng(seed) for seed in seeds]
        self._before = [rng.bit_generator.state for rng in self._rngs]
        for w in range(len(seeds)):
            self.draw(w)

    def draw(self, w: int) -> None:
        """A world's next block."""
        rng = self._rngs[w]
        self._before[w] = rng.bit_generator.state
        rng.standard_normal(out=self.ahead[w])
        self.at[w] = 0

    def refill(self) -> None:
        """The next blocks of the worlds that have used up theirs."""
        for w in np.flatnonzero(self.at == NOISE_BLOCK).tolist():
            self.draw(w)

    def take(self, w: int, samples: int) -> np.ndarray:
        """(samples, S) of the next samples."""
        rng = self._now(w)
        found = rng.standard_normal((samples, self.ahead.shape[2]))
        self._rngs[w] = rng
        self.draw(w)
        return found

    def seed(self, w: int, seed: Any) -> None:
        """A world's generator starts anew."""
        self._rngs[w] = np.random.default_rng(seed)
        self.draw(w)

    def state(self, w: int) -> dict[str, Any]:
        """Of the generator, had it given no more than what was used."""
        return dict(self._now(w).bit_generator.state)

    def set_state(self, w: int, state: dict[str, Any]) -> None:
        """Puts a world's generator into such a state."""
        self._rngs[w].bit_generator.state = state
        self.draw(w)

    def _now(self, w: int) -> np.random.Generator:
        rng = np.random.default_rng(0)
        rng.bit_generator.state = self._before[w]
        rng.standard_normal((int(self.at[w]), self.ahead.shape[2]))
        return rng


class Electronics:
    """Signal chains of all sensors, and what a reading is made of. voltage: (W, S, SAMPLES) V; pressed: (W, F, T) N and
    off: (W, F) N, sums over the substeps of a reading. filtered and last: (W S, 1) V, the low-pass's output and its
    last input.

    touches, beside: a ContactReader's. sent: (W, S) what the chains take; drop: (W, S) K, warmth: (W, O) K above
    `ambient` °C and inner: (W, C) °C of the contents of C objects, of a JoinedHeat. These stay where they are.
    substeps: of a reading."""

    def __init__(
        self,
        chain_rows: np.ndarray,
        layout: Layout,
        noise: Noise,
        *,
        touches: np.ndarray,
        beside: np.ndarray,
        sent: np.ndarray,
        drop: np.ndarray,
        warmth: np.ndarray,
        inner: np.ndarray,
        substeps: int,
        ambient: float,
    ) -> None:
        self.noise, self._layout, self._chains = noise, layout, chain_rows
        self._sources, self._inner = (touches, beside, sent, drop, warmth), inner
        worlds, tips, targets = touches.shape[:3]
        rows = worlds * layout.sensors
        self.filtered, self.last = np.zeros((rows, 1)), np.zeros((rows, 1))
        self._drawn, self._sampled = np.zeros((rows, 1, 1)), np.zeros((rows, 1, 1))
        self.voltage = np.zeros((worlds, layout.sensors, SAMPLES))
        self.pressed, self.off = np.zeros((worlds, tips, targets)), np.zeros((worlds, tips))
        self._numbers = np.zeros((worlds, layout.starts[-1]))
        self._means = np.array([float(substeps), ambient])
        self._point()

    def __setstate__(self, state: dict[str, Any]) -> None:
        """A copy, whose arrays are elsewhere."""
        self.__dict__.update(state)
        self._point()

    def _point(self) -> None:
        """Says where all arrays are."""
        layout = self._layout
        arrays = (
            *(*self._sources, self.pressed, self.off, self._chains, self.filtered, self.last),
            *(self.noise.ahead, self.noise.at, self._drawn, self._sampled, self.voltage),
            *(self._numbers, self._means),
        )
        worlds, tips, targets = self.pressed.shape
        self._table = table(arrays, (worlds, tips, targets, layout.sensors, layout.objects))
        self._at = self._table.ctypes.data

    def rest(self, w: int, sent: np.ndarray) -> None:
        """A world's electronics as if at rest for as long as a reading reaches back. sent: (S,) what they take."""
        sensors = self._layout.sensors
        sensors_of = slice(w * sensors, (w + 1) * sensors)
        self.filtered[sensors_of], self.last[sensors_of] = sent[:, None], sent[:, None]
        volts = np.zeros((sensors, SAMPLES, 1))
        measure_rows(
            self._chains[sensors_of],
            self.filtered[sensors_of],
            self.last[sensors_of],
            np.zeros((sensors, 0, 1)),
            np.repeat(sent[:, None], SAMPLES, axis=1)[:, :, None],
            np.ascontiguousarray(self.noise.take(w, SAMPLES).T[:, :, None]),
            volts,
        )
        self.voltage[w] = volts[:, :, 0]

    def sample(self, due: bool) -> None:
        """The converter's next voltages; the contacts' sums of the sample start anew. due: whether it is a reading's
        last."""
        if close_sample(self._at, int(due)):
            self.noise.refill()

    @property
    def address(self) -> int:
        """Of what `close_sample` takes."""
        return self._at

    def start_anew(self, rows: Sequence[int]) -> None:
        """Those worlds' sums, and what a reading that is made now tells of them."""
        self.pressed[rows], self.off[rows] = 0.0, 0.0
        _, _, _, drop, warmth = self._sources
        drops, forces, _, temperatures, touching, _ = self._layout.starts
        for w in rows:
            numbers = self._numbers[w]
            numbers[:drops], numbers[drops:forces] = self.voltage[w].ravel(), drop[w]
            numbers[forces:temperatures], numbers[touching:] = 0.0, -1.0
            numbers[temperatures:touching] = self._means[1] + warmth[w]

    def reading(self, time: np.ndarray, broken: np.ndarray) -> TouchReading:
        """The last one. time: (W,) s."""
        layout, numbers = self._layout, self._numbers.copy()
        if self._inner.size:
            numbers = np.concatenate((numbers, self._inner), axis=1)
        if not layout.many:
            return TouchReading(time.item(), False, numbers, layout)
        if broken.any():
            numbers[broken, : layout.starts[4]] = np.nan
            numbers[broken, layout.starts[-1] :] = np.nan
        return TouchReading(time.copy(), broken.copy(), numbers, layout)


@njit(cache=True, borrows=True, error_model="numpy")
def close_sample(entries_at, due):
    """Adds a sample's forces to those of the reading and starts their sums anew; the converter's next voltages. due: 1
    makes the reading too. entries_at: the address of Electronics' table. Returns 1 where noise has run out, else 0."""
    entries = words(entries_at, 22)
    worlds, tips, targets, sensors, objects = entries[17], entries[18], entries[19], entries[20], entries[21]
    rows = worlds * sensors
    touches = floats(entries[0], (worlds, tips, targets, COLUMNS))
    beside = floats(entries[1], (worlds, tips))
    sent, drop = floats(entries[2], (rows, 1, 1)), floats(entries[3], (worlds, sensors))
    warmth = floats(entries[4], (worlds, objects))
    pressed, off = (
        floats(entries[5], (worlds, tips, targets)),
        floats(entries[6], (worlds, tips)),
    )
    filtered, last = floats(entries[8], (rows, 1)), floats(entries[9], (rows, 1))
    ahead, at = (
        floats(entries[10], (worlds, NOISE_BLOCK, sensors)),
        words(entries[11], worlds),
    )
    drawn, sampled = floats(entries[12], (rows, 1, 1)), floats(entries[13], (rows, 1, 1))
    voltage = floats(entries[14], (worlds, sensors, SAMPLES))
    means = floats(entries[16], 2)
    spent = 0
    for w in range(worlds):
        for f in range(tips):
            off[w, f] += beside[w, f]
            beside[w, f] = 0.0
            for t in range(targets):
                if touches[w, f, t, FORCE] == 0.0:
                    continue  # nothing has been added
                pressed[w, f, t] += touches[w, f, t, FORCE]
                for k in range(COLUMNS):
                    touches[w, f, t, k] = 0.0
        for s in range(sensors):
            drawn[w * sensors + s, 0, 0] = ahead[w, at[w], s]
        at[w] += 1
        if at[w] == NOISE_BLOCK:
            spent = 1
    chain = chains(entries[7], rows)
    # voltages under way: none
    measure_rows(chain, filtered, last, floats(entries[8], (rows, 0, 1)), sent, drawn, sampled)
    for w in range(worlds):
        for s in range(sensors):
            for k in range(SAMPLES - 1):
                voltage[w, s, k] = voltage[w, s, k + 1]
            voltage[w, s, SAMPLES - 1] = sampled[w * sensors + s, 0, 0]
    if due == 1:
        size = sensors * (SAMPLES + 1) + 3 * tips + objects
        _tell(voltage, drop, warmth, pressed, off, means, floats(entries[15], (worlds, size)))
    return spent


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _tell(voltage, drop, warmth, pressed, off, means, numbers):
    """Fills the numbers of a reading (Layout) and starts the sums anew. Fingertips on one another are noted with the
    first of the two."""
    worlds, tips, targets = pressed.shape
    sensors, objects = voltage.shape[1], warmth.shape[1]
    drops = sensors * SAMPLES
    forces = drops + sensors
    for w in range(worlds):
        for s in range(sensors):
            for k in range(SAMPLES):
                numbers[w, s * SAMPLES + k] = voltage[w, s, k]
            numbers[w, drops + s] = drop[w, s]
        for f in range(tips):
            force, most, largest = 0.0, -1, 0.0
            for t in range(targets):
                pair_force = pressed[w, f, t]
                if t >= objects:
                    pair_force += pressed[w, t - objects, objects + f]
                force += pair_force / means[0]
                if pair_force > largest:
                    largest, most = pair_force, t
            numbers[w, forces + f] = force
            numbers[w, forces + tips + f] = off[w, f] / means[0]
            numbers[w, forces + 2 * tips + objects + f] = most
        for o in range(objects):
            numbers[w, forces + 2 * tips + o] = means[1] + warmth[w, o]
        for f in range(tips):
            off[w, f] = 0.0
            for t in range(targets):
                pressed[w, f, t] = 0.0
