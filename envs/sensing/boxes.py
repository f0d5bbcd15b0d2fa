"""Boxes under fingertips: their networks from heat kernels, made as they are touched, and what goes on in them.

An object that is touched anywhere remembers MOST_PLACES places, those under fingertips among them; what flowed
elsewhere counts as if through the nearest of them, or is in its mean. Any other has one on each face, in the middle.

B: rows, F: fingertips, S: substeps.
"""

from __future__ import annotations

import math
from bisect import bisect
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...thermal import Material, SensorStack
from ...thermal.batch import (
    FIXED_LEVEL,
    HELD,
    POLE_HEAT,
    RATES,
    SHARED,
    WHERE,
    FixedTables,
    TipRows,
    fixed_heat,
    fixed_tables,
    fixed_tip_heat,
    fixed_tip_rows,
    fixed_warmth,
    no_fixed_tables,
    set_body,
    set_gram,
    tip_residues,
)
from ...thermal.kernels import (
    GRAM,
    THIN,
    Footprint,
    Patches,
    Spot,
    Tip,
    TouchedBox,
    UnderTips,
    tip,
    tips_at,
    touched_box,
    under_many,
)
from ..bodies import ObjectSpec
from ..footprint import GraspBody
from .places import BOX_ROW, MOST_PLACES, NEAR, Place, Rectangle, Touched, opposite, place_of, strayed

_ANYWHERE_SHARE = 3.2e-3
"""Error of the drop of a touch at rest anywhere on a box, as a share of the difference: 99 % of 1,000 drawn touches are
within it, and the worst is twice as much (docs/objects.md). While a fingertip slides it is up to four times as much."""
_MIDDLES_SHARE = 3e-3
"""Largest error of the drop where fingertips are in the middle of the faces of a box that is LEAST_SIDE thick and CLEAR
sensors wide, as a share of the difference: 1.9e-3 of 300 drawn boxes of any material, beside networks of one touch,
whose own is thermal/network/boxes.py's SHARE."""
_CLEAR, _LEAST_SIDE = 1.2, 0.01  # m
_SOON = 1.0  # s, how warm a place will be then decides whether it is remembered
_GAPS, _STEPS = (0.45, 0.67, 1.1), (0.0, 1 / 18, 1 / 9, 2 / 9)
_DEPTHS, _OFFS = (1.0, 2.0), (0.0, 1 / 18, 2 / 9)
"""Of the sensor's width: from a contact to its face's end; how far apart the places are which stand for those that are
so far from it; and those of the two fingertips beside each other. What flows under a fingertip at such a place differs
by .15 % at most, of any material, and half as much as a rule."""
_KEPT = 1024  # networks of what is under fingertips


class BoxHeat:
    """The boxes among `rows` rows. dt: s of a heat sample. tolerance: K."""

    def __init__(self, rows: int, tolerance: float, dt: float) -> None:
        self._tolerance, self._dt = tolerance, dt
        self._tips = 0
        self._stack: SensorStack | None = None
        self._whole: Tip | None = None
        self._bodies: dict[int, tuple[GraspBody, float]] = {}
        self._touched: dict[int, Touched] = {}
        self._prints: dict[int, tuple[_Print, ...]] = {}
        self._rows = np.zeros(rows, BOX_ROW)
        self._strayed = np.zeros((2 * rows, 2), np.int64)
        self._left = np.exp(-_SOON * SHARED)
        self.tables: FixedTables = no_fixed_tables(dt)

    @property
    def rung(self) -> str:
        """The model's name."""
        level = FIXED_LEVEL
        return f"kernels:{level.rates}x{level.patterns}"

    def serves(self, body: GraspBody, difference: float) -> bool:
        """Whether it keeps the tolerance for that object, that is up to difference K from a sensor."""
        if body.mode == "O" or self._stack not in (None, body.stack):
            return False
        if body.anywhere:
            return served_anywhere(body.spec, self._tolerance, difference)
        return body.any_size and served_in_the_middle(body.spec, body.stack, self._tolerance, difference)

    def start(self, row: int, body: GraspBody, film: float) -> None:
        """The row's object is this one, touched nowhere yet, in air of W/(m2 K), its state zeros."""
        if self._stack is None:
            self._stack, self._tips = body.stack, body.fingertips
            level = FIXED_LEVEL
            self._whole = tip(body.stack, _whole(body.stack), level)
            self.tables = fixed_tables(
                len(self._rows), self._tips, MOST_PLACES, level.patterns, self._whole.side, self._dt
            )
        self._bodies[row] = body, film
        self._touched[row] = Touched((), (-1,) * self._tips)
        self._prints.pop(row, None)
        record = self._rows[row]
        record["size"], record["face"], record["boxed"] = body.spec.size, -1, 1
        record["normal"] = 3 - int(body.law["across"].sum())
        record["middled"] = not body.anywhere
        self.tables.links[row] = 0
        self.tables.links[row, WHERE : WHERE + self._tips] = -1

    def stop(self, row: int) -> None:
        """The row holds no box."""
        self._rows["boxed"][row] = 0
        self._bodies.pop(row, None)
        self._touched.pop(row, None)
        self._prints.pop(row, None)

    def wait(self, rows: Sequence[int], state: np.ndarray) -> None:
        """The rows' networks are made before anything touches them, with places in the middle of their faces. state:
        (B, n)."""
        middles = np.zeros((len(self._rows), 2, 3))
        for row in rows:
            middles[row] = self._middles(row)
        self.settle([(row, range(self._tips)) for row in rows], middles, state)

    def strayed(self, force: np.ndarray, place: np.ndarray, samples: int) -> list[tuple[int, int, list[int]]]:
        """(sample, row, fingertips) of those that begin to press in that one of a step's samples where they have no
        place. force: (B, S, F) N. place: (B, F, 3) m, in the objects' frames."""
        if self._stack is None:
            return []
        count = strayed(self._rows, force, place, self._tips, self._stack.width, self._strayed)
        begun_at: dict[tuple[int, int], list[int]] = {}
        for row, fingertip in self._strayed[:count].tolist():
            begun = int((force[row, :, fingertip] > 0).argmax())
            begun_at.setdefault((begun * samples // force.shape[1], row), []).append(fingertip)
        return [(sample, row, fingertips) for (sample, row), fingertips in begun_at.items()]

    def settle(
        self, strayed: Sequence[tuple[int, Sequence[int]]], middles: np.ndarray, state: np.ndarray
    ) -> None:
        """Those fingertips of each row, and those without a place that are about to touch, are at their middles of
        (B, F, 3) m from now on. The heat of the objects and of fingertips in the state (B, n) stays to round-off."""
        tables, moved, before = self.tables, {}, {}
        for row, fingertips in strayed:
            row_state = state[row]
            if row_state.any():  # or nothing has flowed yet, and there is nothing to keep
                before[row] = (
                    fixed_heat(tables, row, row_state),
                    self._touched[row],
                    self._prints.get(row, ()),
                )
            touched = self._moved(row, fingertips, middles[row], row_state)
            if touched.places:
                moved[row] = touched
        self.set_touched(moved)
        for row, (heat, last, prints) in before.items():
            if row in moved:
                self._keep(row, heat, last, prints, state[row])

    def _keep(
        self, row: int, heat: float, last: Touched, prints: tuple[_Print, ...], state: np.ndarray
    ) -> None:
        """Puts the row's state (n,), of the places and prints before, on those of now. heat: J, the box's."""
        self._turn(row, last, prints, state)
        for f, (number, now) in enumerate(zip(last.contacts, self._touched[row].contacts, strict=True)):
            worn = prints[number].tip if number >= 0 else self._whole
            if now >= 0 and worn is not self._prints[row][now].tip:
                heats = (
                    fixed_tip_heat(self.tables, _element(one)) for one in (worn, self._prints[row][now].tip)
                )
                self._keep_heat(state[self.fingertip(f)], *heats)
        state[0] += (heat - fixed_heat(self.tables, row, state)) / self.tables.slow[row, HELD]

    def _moved(self, row: int, fingertips: Sequence[int], middles: np.ndarray, state: np.ndarray) -> Touched:
        """Where the row's box is touched with these fingertips at their middles of (F, 3) m; the field of a place that
        is given up, in the row's state (n,), goes to its heir."""
        touched, (body, _) = self._touched[row], self._bodies[row]
        size, width, normal = body.spec.size, body.stack.width, int(self._rows["normal"][row])
        # one that is further off will hardly find the box where it is: the first to touch pushes it
        reach = size[normal] / 2 + NEAR * width
        if not body.anywhere:
            middles, reach = self._middles(row), math.inf
        new = [
            f
            for f in range(self._tips)
            if touched.contacts[f] < 0 and f not in fingertips and abs(middles[f][normal]) <= reach
        ]
        for f in (*fingertips, *new):
            place = place_of(size, normal, width, middles[f].tolist())
            if place is not None:
                count = len(touched.places)
                warmth = fixed_warmth(self.tables, row, state, self._left)[:count] if count else ()
                touched, given_up = touched.moved(f, place, warmth, size, width)
                if given_up is not None:
                    gone, heir = given_up
                    field = state[self._field(gone)].copy()
                    state[self._field(gone)] = 0.0
                    if heir >= 0:
                        state[self._field(heir)] += field
        return touched

    def shift(self, rows: np.ndarray, state: np.ndarray, change: np.ndarray) -> None:
        """The thermostats moved by change (B, F) K: the fields above them in rows (n,) of state (B, n) are lower."""
        lasting, count = self.tables.poles.shape[1], self.tables.rates.shape[1]
        for f in range(self._tips):
            first, by = self.fingertip(f).start, change[rows, f : f + 1]
            state[rows, first : first + lasting] -= by * self.tables.poles[POLE_HEAT]
            state[rows, first + lasting : first + lasting + count] -= by

    def fingertip(self, number: int) -> slice:
        """Where a fingertip's own states are in a row's."""
        of_tip = self.tables.of_tip
        first = self.tables.states - (self._tips - number) * of_tip
        return slice(first, first + of_tip)

    def tip_rows(self, row: int, fingertip: int) -> TipRows:
        """What a fingertip's states tell."""
        return fixed_tip_rows(self.tables, self._element(row, fingertip))

    def carry(self, source: int, target: int, fingertip: int, state: np.ndarray) -> None:
        """The fingertip's field in state (B, n) goes from one row to another, with all its heat."""
        tip_states = self.fingertip(fingertip)
        state[target, tip_states] = state[source, tip_states]
        elements = (self._element(row, fingertip) for row in (source, target))
        self._keep_heat(
            state[target, tip_states],
            *(fixed_tip_heat(self.tables, self.tables.tips[each]) for each in elements),
        )

    def touched(self, row: int) -> Touched:
        """For set_touched."""
        return self._touched[row]

    def set_touched(self, touched: Mapping[int, Touched]) -> None:
        """The rows' networks are those of these places; their states are left alone."""
        # one kind of thing after the other for all rows, which the processor does in less time
        changed = [row for row, now in touched.items() if now != self._touched[row]]
        self._press({row: self._pressed(row, touched[row]) for row in changed})
        under = _UNDER.of([self._asked(row, touched[row]) for row in changed])
        for row, known in zip(changed, under, strict=True):
            self._set_box(row, touched[row], known)
        for row, now in touched.items():
            self._set_contacts(row, now)
            set_gram(self.tables, row)

    def _middles(self, row: int) -> np.ndarray:
        """(F, 3) m of the faces that the fingers close on."""
        middles = np.zeros((2, 3))
        middles[:, self._rows["normal"][row]] = -1.0, 1.0
        return middles

    def _element(self, row: int, fingertip: int) -> int:
        return int(self.tables.links[row, WHERE + self._tips + fingertip])

    def _field(self, place: int) -> slice:
        """Where what has flowed through a place is in a row's state."""
        each = self.tables.patterns * self.tables.rates.shape[1]
        first = 1 + self.tables.rates.shape[1] + place * each
        return slice(first, first + each)

    def _turn(self, row: int, last: Touched, prints: tuple[_Print, ...], state: np.ndarray) -> None:
        """Puts the fields of places whose patterns of flow are others now, since a fingertip has come or gone behind
        them, on these; the even one is the same. last, prints: the places before, and what was pressed on them."""
        now, level = self._touched[row], FIXED_LEVEL
        for number, (before, after) in enumerate(zip(prints, self._prints[row], strict=False)):
            if last.places[number] != now.places[number] or before.tip is after.tip:
                continue
            turn, fields = after.tip.basis.T @ GRAM @ before.tip.basis, [state[self._field(number)]]
            for f in range(self._tips):
                if last.contacts[f] == now.contacts[f] == number:
                    fields.append(state[self.fingertip(f)][self.tables.poles.shape[1] + RATES :])
            for field in fields:
                each = field.reshape(level.patterns, -1)
                each[:] = turn @ each

    def _keep_heat(self, state: np.ndarray, before: np.ndarray, after: np.ndarray) -> None:
        """Puts the heat that a fingertip's states (n,) have by one row and not by the other into its slowest."""
        state[0] += ((before - after) * state).sum() / after[0]

    def _press(self, pressed: Mapping[int, Sequence[_Pressed]]) -> None:
        """Makes the rows' prints, and the elements that are not known."""
        if self._stack is None:  # no row has held a box
            return
        new = [(each.spot, each.foot.covered) for row in pressed.values() for each in row if each.spot]
        made = iter(tips_at(self._stack, new, FIXED_LEVEL))
        for row, places in pressed.items():
            self._prints[row] = tuple(
                _Print(each.place, each.behind, each.foot, each.tip or next(made)) for each in places
            )

    def _pressed(self, row: int, touched: Touched) -> list[_Pressed]:
        """What is pressed on each of the places; the elements that it knows already are the same."""
        (body, _), known = self._bodies[row], self._prints.get(row, ())
        size, width, shared, found = body.spec.size, body.stack.width, not body.anywhere, []
        for number, place in enumerate(touched.places):
            # what touches the far side of a thick box shapes no pattern
            thin = size[place.face // 2] < THIN * width and not shared
            behind = opposite(place, touched.places, width) if thin else None
            foot, spot, worn = _footprint(place, size, width), None, self._whole if shared else None
            if number < len(known) and known[number].place == place and known[number].behind == behind:
                worn = known[number].tip
            if worn is None:
                spot = _spot(body.material, size, place, behind, foot, width)
            found.append(_Pressed(place, behind, foot, worn, spot))
        return found

    def _asked(self, row: int, touched: Touched) -> _Asked:
        """What has to be known of what is under the row's fingertips."""
        (body, film), under = self._bodies[row], touched.numbers()[: touched.pressed]
        size = body.spec.size
        placed = _stand_ins(self._prints[row], under, size, body.stack.width)
        return body.material, size, film, placed

    def _set_box(self, row: int, touched: Touched, under: UnderTips) -> None:
        """The row's box is touched there. under: what is under its fingertips."""
        (body, film), numbers = self._bodies[row], touched.numbers()
        material, size, prints = body.material, body.spec.size, self._prints[row]
        count, found = touched.pressed, under.bare
        if len(numbers) > count:
            feet = [(prints[number].place.face, prints[number].foot) for number in numbers]
            patches = Patches(
                np.array([face for face, _ in feet]),
                np.array([foot.centre for _, foot in feet]),
                np.array([foot.half for _, foot in feet]),
            )
            tips = tuple(prints[number].tip for number in numbers)
            found = touched_box(TouchedBox(material, size, film, patches, tips, count), FIXED_LEVEL, under)
        set_body(self.tables, row, found, numbers)

    def _set_contacts(self, row: int, touched: Touched) -> None:
        """The row's fingertips are on those places."""
        tables, (body, _) = self.tables, self._bodies[row]
        for f, number in enumerate(touched.contacts):
            if number >= 0:
                element = 1 + row * self._tips + f if body.anywhere else 0
                if element:
                    tables.tips[element] = _element(self._prints[row][number].tip)
                tables.links[row, WHERE + f], tables.links[row, WHERE + self._tips + f] = number, element
                place = touched.places[number]
                self._rows["face"][row, f], self._rows["pad"][row, f] = place.face, place.middle
        self._touched[row] = touched


def served_anywhere(spec: ObjectSpec, tolerance: float, difference: float) -> bool:
    """Whether heat kernels keep the tolerance K of that object, wherever it is touched.

    difference: K between a sensor and the object or the air, at most."""
    return _plain(spec) and _ANYWHERE_SHARE * difference <= tolerance


def served_in_the_middle(spec: ObjectSpec, stack: SensorStack, tolerance: float, difference: float) -> bool:
    """Whether they keep it where a sensor, difference K warmer or cooler at most, is in the middle of a face."""
    roomy = min(spec.size) >= max(_LEAST_SIDE, _CLEAR * stack.width)
    return _plain(spec) and roomy and _MIDDLES_SHARE * difference <= tolerance


def _plain(spec: ObjectSpec) -> bool:
    return spec.shape == "box" and not spec.parts and spec.reservoir is None


def _whole(stack: SensorStack) -> Rectangle:
    return (0.0, stack.width), (0.0, stack.width)


class _Print(NamedTuple):
    """A sensor pressed on a box: its place, the one behind that shapes its patterns of flow, what it covers there, and
    the element on these patterns. Equal ones are as alike as their boxes."""

    place: Place
    behind: Place | None
    foot: Footprint
    tip: Tip


class _Pressed(NamedTuple):
    """A print whose element may not be known: then spot is that of its patterns of flow."""

    place: Place
    behind: Place | None
    foot: Footprint
    tip: Tip | None
    spot: Spot | None


def _spot(
    material: Material,
    size: tuple[float, float, float],
    place: Place,
    behind: Place | None,
    foot: Footprint,
    width: float,
) -> Spot:
    """One of few: a later touch nearly as far from the ends shares its element with this one."""
    spot = Spot(
        material.conductivity,
        material.volumetric_heat_capacity,
        place.sides(size),
        size[place.face // 2],
        foot,
        None if behind is None else _footprint(behind, size, width),
    )
    return spot.alike(width)


def _footprint(place: Place, size: tuple[float, float, float], width: float) -> Footprint:
    (x, y), covered = place.middle, place.covered(size, width)
    (x0, x1), (y0, y1) = covered
    centre = x + (x0 + x1 - width) / 2, y + (y0 + y1 - width) / 2
    return Footprint(covered, centre, ((x1 - x0) / 2, (y1 - y0) / 2))


@lru_cache(maxsize=1024)
def _element(one: Tip) -> np.ndarray:
    return tip_residues(one.side)


_Placed = tuple[int, tuple[float, float], tuple[float, float], Tip]
"""A sensor's patch as in Patches, and the element on it."""


_Asked = tuple[Material, tuple[float, float, float], float, tuple[_Placed, ...]]
"""A box in air of W/(m2 K), and what is under fingertips on it."""


class _Under:
    """What is under fingertips on boxes: of those last asked for, `most`, it is kept."""

    def __init__(self, most: int) -> None:
        self.most = most
        self._kept: OrderedDict[_Asked, UnderTips] = OrderedDict()

    def __len__(self) -> int:
        return len(self._kept)

    def of(self, asked: Sequence[_Asked]) -> list[UnderTips]:
        """What is under each. Those not known are made all at once, which takes less time than one after the other."""
        new = [each for each in dict.fromkeys(asked) if each not in self._kept]
        made = under_many([_box(*each) for each in new], FIXED_LEVEL)
        self._kept.update(zip(new, made, strict=True))
        found = [self._kept[each] for each in asked]
        for each in asked:
            self._kept.move_to_end(each)
        while len(self._kept) > self.most:
            self._kept.popitem(last=False)
        return found

    def cache_clear(self) -> None:
        """Forgets all."""
        self._kept.clear()


_UNDER = _Under(_KEPT)


def _box(
    material: Material, size: tuple[float, float, float], film: float, placed: tuple[_Placed, ...]
) -> TouchedBox:
    face, centre, half, tips = zip(*placed, strict=True)
    patches = Patches(np.array(face), np.array(centre), np.array(half))
    return TouchedBox(material, size, film, patches, tips, len(tips))


def _stand_ins(
    prints: Sequence[_Print], numbers: Sequence[int], size: tuple[float, float, float], width: float
) -> tuple[_Placed, ...]:
    """Few places that serve for those of fingertips: further from the face's ends by less than they tell, and in a
    thick box over each other nearly as these."""
    feet = [prints[number].foot for number in numbers]
    face = prints[numbers[0]].place.face
    depth, axes = size[face // 2], []
    for axis, side in enumerate(prints[numbers[0]].place.sides(size)):
        middles, gap = [foot.centre[axis] for foot in feet], side
        for foot, middle in zip(feet, middles, strict=True):
            gap = min(gap, min(middle, side - middle) - foot.half[axis])
        step = width * _STEPS[bisect(_GAPS, gap / width)]
        if step > 0:
            first = middles[0]
            begun = side / 2 + step * round((first - side / 2) / step)
            fine = width * _OFFS[bisect(_DEPTHS, depth / width)]
            if fine > 0:
                middles = [begun + fine * round((middle - first) / fine) for middle in middles]
            else:
                middles = [begun + (middle - first) for middle in middles]
        axes.append([round(middle, 9) for middle in middles])
    return tuple(
        (prints[number].place.face, centre, foot.half, prints[number].tip)
        for number, foot, centre in zip(numbers, feet, zip(*axes, strict=True), strict=True)
    )
