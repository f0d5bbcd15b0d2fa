"""Fields that closed contacts join, ready to step: flat pools of numbers that compiled code reads.

Contacts join fields into groups: a tip and the object it is on, and whatever else touches that object. Each group steps
for itself. What a group's step needs depends on its contacts and on the objects' networks alone, so that the same
numbers serve every world and every time that it comes again.

Contacts are pairs (tip, target); targets are the objects, then the tips. Fields are numbered likewise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...thermal.kernels import Tip
from ...thermal.network import propagator
from .fields import BodyField

STATES, PORTS, SHARED, ALONE, FIELDS, CONTACTS, FLOATS, GRAM = range(8)
"""Of a group's integers, the first: states, ports, states that all contacts see and those of each tip, how many fields
and contacts, and where its numbers begin. Behind them: fields and sizes in turn, then the contacts' pairs."""
HEADER = 8

Pair = tuple[int, int]


def groups(pairs: Sequence[Pair], objects: int) -> list[tuple[Pair, ...]]:
    """The pairs in sets that share no field, each in its own order."""
    rest, found = list(pairs), []
    while rest:
        reached, members = {objects + rest[0][0], rest[0][1]}, []
        while True:
            more = [pair for pair in rest if objects + pair[0] in reached or pair[1] in reached]
            if not more:
                break
            members += more
            rest = [pair for pair in rest if pair not in more]
            for tip, target in more:
                reached |= {objects + tip, target}
        found.append(tuple(sorted(members)))
    return found


class SystemPool:
    """Systems of groups, each made once. faces: (n, patterns) ports of each tip for another that touches it. starts:
    where each one's integers begin."""

    def __init__(
        self, tips: Sequence[Tip], faces: Sequence[np.ndarray], objects: int, patterns: int, dt: float
    ) -> None:
        self._tips, self._faces, self._objects = tuple(tips), tuple(faces), objects
        self._patterns, self._dt = patterns, dt
        self._known: dict[tuple[object, ...], int] = {}
        self.starts = np.zeros(0, np.int64)
        self.integers, self.numbers = np.zeros(0, np.int64), np.zeros(0)
        self.grams = np.zeros(0, np.complex128)
        self._used = (0, 0, 0, 0)  # of the four, what is behind it is room

    def __len__(self) -> int:
        return self._used[0]

    def number(self, pairs: tuple[Pair, ...], fields: dict[int, BodyField], current: dict[Pair, int]) -> int:
        """Of the group's system. fields: of its objects. current: each pair's place among its object's."""
        key = (pairs, tuple(fields.items()), tuple(current.get(pair, -1) for pair in pairs))
        if key not in self._known:
            self._known[key] = self._make(pairs, fields, current)
        return self._known[key]

    def _make(self, pairs: tuple[Pair, ...], fields: dict[int, BodyField], current: dict[Pair, int]) -> int:
        patterns = self._patterns
        tips = list(dict.fromkeys(tip for pair in pairs for tip in self._tips_of(pair)))
        members = [*fields, *(self._objects + tip for tip in tips)]
        rates = [fields[o].rates for o in fields] + [self._tips[tip].side.rates for tip in tips]
        sizes = [len(part) for part in rates]
        begin = dict(zip(members, np.cumsum([0, *sizes]).tolist(), strict=False))
        total = sum(sizes)
        ports, watched = np.zeros((total, patterns * len(pairs))), np.zeros(total)
        for number, pair in enumerate(pairs):
            part = slice(number * patterns, (number + 1) * patterns)
            tip, target = pair
            given = self._tips[tip].side.ports
            ports[begin[self._objects + tip] : begin[self._objects + tip] + len(given), part] = -given
            taking = (
                fields[target].port(current[pair], patterns)
                if target < self._objects
                else self._faces[target - self._objects]
            )
            ports[begin[target] : begin[target] + len(taking), part] = taking
        for o, field in fields.items():
            watched[begin[o] : begin[o] + len(field.loss)] = field.loss
        # each tip by itself on what all share, where that is so
        of_objects = sum(sizes[: len(fields)])
        on_objects = all(target < self._objects for _, target in pairs)
        separate = on_objects and len(tips) == len(pairs) and len(set(sizes[len(fields) :])) == 1
        shared, alone = (of_objects, sizes[-1]) if separate else (total, 0)
        steps = propagator(np.concatenate(rates), ports, self._dt)
        header = [total, ports.shape[1], shared, alone, len(members), len(pairs)]
        header += [*self._used[2:]]
        listed = [n for member in zip(members, sizes, strict=True) for n in member]
        flat = [header, listed, [n for pair in pairs for n in pair]]
        numbers = (
            steps.rates,
            watched,
            np.real(steps.scale).ravel(),
            np.imag(steps.scale).ravel(),
            steps.ports.T.ravel(),
        )
        count, integers, floats, grams = self._used
        self.starts = _written(self.starts, count, np.array([integers]))
        whole = np.concatenate(flat).astype(np.int64)
        self.integers = _written(self.integers, integers, whole)
        real = np.concatenate(numbers)
        self.numbers = _written(self.numbers, floats, real)
        self.grams = _written(self.grams, grams, steps.gram.ravel())
        self._used = count + 1, integers + len(whole), floats + len(real), grams + steps.gram.size
        return count

    def _tips_of(self, pair: Pair) -> list[int]:
        tip, target = pair
        return [tip] if target < self._objects else [tip, target - self._objects]


def _written(pool: np.ndarray, first: int, values: np.ndarray) -> np.ndarray:
    """The pool, or one twice as long, with the values from there on."""
    if first + len(values) > len(pool):
        grown = np.zeros(2 * (first + len(values)), pool.dtype)
        grown[:first] = pool[:first]
        pool = grown
    pool[first : first + len(values)] = values
    return pool
