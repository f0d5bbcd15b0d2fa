"""Fields that closed contacts join, ready to step: flat pools of numbers that compiled code reads.

Contacts join fields into groups: a tip and the object it is on, and whatever else touches that object. Each group steps
for itself. What a group's step needs depends on its contacts and on the objects' networks alone, so that the same
numbers serve every world and every time that it comes again.

Contacts are pairs (tip, target); targets are the objects, then the tips. Fields are numbered likewise. A pad around a
tip's element is a contact of the same field by other ports, those of its rings in place of patterns: behind the tips,
pads are numbered as tips are, and no target.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from thermograsp.lanes import LANES

from ...thermal.kernels import Tip
from .places import BodyField
from .step import PACE, gram, lanes, pace

Pair = tuple[int, int]


def groups(pairs: Sequence[Pair], objects: int, owners: Sequence[int]) -> list[tuple[Pair, ...]]:
    """The pairs in sets that share no field, each in its own order. owners: the tip of each tip and pad."""
    rest, found = list(pairs), []
    while rest:
        reached, members = {objects + owners[rest[0][0]], rest[0][1]}, []
        while True:
            more = [pair for pair in rest if objects + owners[pair[0]] in reached or pair[1] in reached]
            if not more:
                break
            members += more
            rest = [pair for pair in rest if pair not in more]
            for tip, target in more:
                reached |= {objects + owners[tip], target}
        found.append(tuple(sorted(members)))
    return found


class SystemPool:
    """Systems of groups, each made once. faces: (n, patterns) ports of each tip for another that touches it. pads: tip
    and ports (n, RINGS) of each pad. owners: the tip of each tip and pad. starts: where each one's integers begin
    (step.py), and ports, grams and paces: what these refer to. most: contacts of the largest. rates: of the field that
    has most."""

    def __init__(
        self,
        tips: Sequence[Tip],
        faces: Sequence[np.ndarray],
        objects: int,
        patterns: int,
        dt: float,
        pads: Sequence[tuple[int, np.ndarray]] = (),
    ) -> None:
        self._tips, self._faces, self._objects = tuple(tips), tuple(faces), objects
        rings = [_in_place(ports, patterns) for _, ports in pads]
        self._touched_ports = [*(tip.side.ports for tip in tips), *rings]
        self.owners = (*range(len(tips)), *(tip for tip, _ in pads))
        self._patterns, self._dt = patterns, dt
        self._known: dict[tuple[object, ...], int] = {}
        self._rates: dict[tuple[float, ...], int] = {}
        self.starts, self.integers = np.zeros(0, np.int64), np.zeros(0, np.int64)
        self.ports, self.grams, self.paces = np.zeros(0), np.zeros(0), np.zeros((0, PACE))
        self.most = self.rates = self._paced = 0
        self._used = (0, 0, 0, 0)  # of the first four, what is behind it is room

    def __len__(self) -> int:
        return self._used[0]

    def number(self, pairs: tuple[Pair, ...], fields: dict[int, BodyField], current: dict[Pair, int]) -> int:
        """Of the group's system. fields: of its objects. current: each pair's place among its object's."""
        key = (
            pairs,
            tuple(fields.items()),
            tuple(current.get((self.owners[pair[0]], pair[1]), -1) for pair in pairs),
        )
        if key not in self._known:
            self._known[key] = self._make(pairs, fields, current)
        return self._known[key]

    def _make(self, pairs: tuple[Pair, ...], fields: dict[int, BodyField], current: dict[Pair, int]) -> int:
        objects, patterns, of_contact = self._objects, self._patterns, lanes(self._patterns)
        tips = list(dict.fromkeys(tip for pair in pairs for tip in self._tips_of(pair)))
        self.most = max(self.most, len(pairs))
        m, members = patterns * len(pairs), [*fields, *(objects + tip for tip in tips)]
        integers, blocks = [n for pair in pairs for n in pair], []
        heard = np.zeros((m, m, 2, LANES))
        for member in members:
            rates = fields[member].rates if member < objects else self._tips[member - objects].side.rates
            seen = {}  # its ports, by contact
            for number, (tip, target) in enumerate(pairs):
                if member == objects + self.owners[tip]:
                    seen[number] = -self._touched_ports[tip]
                elif member == target and target < objects:
                    place = current[self.owners[tip], target]
                    if tip < len(self._tips):
                        seen[number] = fields[target].port(place, patterns)
                    else:
                        seen[number] = _in_place(fields[target].in_rings(place), patterns)
                elif member == target:
                    seen[number] = self._faces[target - objects]
            padded = np.zeros((len(rates), len(seen), of_contact * LANES))
            for place, port in enumerate(seen.values()):
                padded[:, place, :patterns] = port
            ports = padded[:, :, :patterns].reshape(len(rates), len(seen) * patterns)
            columns = np.array([number * patterns + n for number in seen for n in range(patterns)])
            heard[columns[:, None], columns] += gram(rates, ports, self._dt)
            blocks.append(padded.ravel())
            # the first state of an object is its mean temperature's, whatever the others' rates
            starts = [0, *(np.flatnonzero(np.diff(rates)) + 1).tolist(), len(rates)]
            if member < objects and starts[1] > 1:
                starts.insert(1, 1)
            spans = [(start, end) for start, end in pairwise(starts) if end > start]
            touched = [number * of_contact + n for number in seen for n in range(of_contact)]
            integers += [member, len(touched), len(spans), len(rates), *touched]
            integers += [self._pace(tuple(rates[[start for start, _ in spans]].tolist()))]
            integers += [end - start for start, end in spans]
            self.rates = max(self.rates, len(spans))
        count, *used = self._used
        whole = np.array([len(pairs), len(members), *used[1:], *integers], np.int64)
        self.starts = _written(self.starts, count, np.array(used[:1]))
        self.integers = _written(self.integers, used[0], whole)
        flat = np.concatenate(blocks)
        self.ports = _written(self.ports, used[1], flat)
        self.grams = _written(self.grams, used[2], heard.ravel())
        self._used = count + 1, used[0] + len(whole), used[1] + len(flat), used[2] + heard.size
        return count

    def _pace(self, rates: tuple[float, ...]) -> int:
        """The row of the first of a field's rates."""
        if rates not in self._rates:
            first = self._paced
            rows = np.array([pace(rate, self._dt) for rate in rates]).reshape(-1, PACE)
            self.paces = _written(self.paces, first, rows)
            self._rates[rates], self._paced = first, first + len(rates)
        return self._rates[rates]

    def _tips_of(self, pair: Pair) -> list[int]:
        tip, target = self.owners[pair[0]], pair[1]
        return [tip] if target < self._objects else [tip, target - self._objects]


def _in_place(rings: np.ndarray, patterns: int) -> np.ndarray:
    """(n, patterns) of a contact by ports (n, RINGS), of which there are no more."""
    return np.pad(rings, ((0, 0), (0, patterns - rings.shape[1])))


def _written(pool: np.ndarray, first: int, values: np.ndarray) -> np.ndarray:
    """The pool, or one twice as long, with the values from there on."""
    if first + len(values) > len(pool):
        grown = np.zeros((2 * (first + len(values)), *pool.shape[1:]), pool.dtype)
        grown[:first] = pool[:first]
        pool = grown
    pool[first : first + len(values)] = values
    return pool
