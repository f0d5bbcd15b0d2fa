"""Contacts of pads with elements that are glued on objects: what a pad that meets an element's place touches is the
element.

W: worlds, F: fingertips, E: elements, S = F + E: sensors, O: objects.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermograsp.compiled import njit

from ...thermal import CONTACT_LAW, flat_law
from ...thermal.contact import conductance, contact, element_joint
from ..scene import PadPlace
from .columns import COLUMNS, CONDUCTANCE, FORCE, NORMAL, PLACE
from .laws import SQUARE
from .round_pads import CURVES, WIDE, bends, round_contact

BOND = 1e7
"""W/(m2 K) of the glue, a thousand times what a contact conducts: as good as perfect."""
_FACING = 0.6  # least cosine between the way that a pad looks and the way into the object


class GluedContacts:
    """Of fingertips on `objects` objects, some of which carry elements."""

    def __init__(
        self, fingertips: Sequence[PadPlace], elements: Sequence[PadPlace], objects: int, worlds: int
    ) -> None:
        tips, sensors = len(fingertips), len(fingertips) + len(elements)
        self.laws = np.zeros((tips, len(elements)), CONTACT_LAW)
        """Of each fingertip on each element."""
        self.small = np.zeros(len(elements))
        """m K/W, of contacts narrower than an element, by the inverse of their side."""
        self._places = np.zeros((len(elements), 14))
        self._bends, self._curves = bends(fingertips), np.zeros((len(elements), CURVES))
        for e, element in enumerate(elements):
            width = element.stack.width
            self.small[e] = SQUARE / element.stack.layers[0].conductivity
            self._curves[e] = (0.0, 0.0, width / 2, width / 2, 0.0, WIDE, WIDE)
            self._places[e] = (element.glued, width, *element.position, *element.axes.ravel())
            for f, tip in enumerate(fingertips):
                metal = tip.bare and tip.skin is None
                faces = element_joint() if metal else element_joint(tip.face)
                self.laws[f, e] = flat_law(tip.silicone, faces, (width, width), (1, 2))
        self._redirected = np.zeros((worlds, sensors, objects + sensors, COLUMNS))

    def redirected(self, touches: np.ndarray, substeps: int) -> np.ndarray:
        """(W, S, O + S, COLUMNS) of all sensors, from the fingertips' (W, F, O + F, COLUMNS), sums over so many
        substeps: what a pad met of an object where an element lies it met of the element, and every element is on its
        object. A pad's conductance on an element is that of its mean force, where its last substep found it; on several
        elements it presses alike."""
        _redirect(
            touches,
            substeps,
            self._places,
            self.laws,
            self.small,
            self._bends,
            self._curves,
            self._redirected,
        )
        return self._redirected


@njit(cache=True, error_model="numpy")
def _redirect(touches, substeps, places, laws, small, bend, curve, redirected):
    worlds, tips, targets = touches.shape[:3]
    place, sides = np.zeros(3), np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    for w in range(worlds):
        for f in range(tips):
            for t in range(targets):
                redirected[w, f, t] = touches[w, f, t]
            for e in range(len(places)):
                redirected[w, f, targets + e, CONDUCTANCE] = 0.0
                o, meeting = int(places[e, 0]), 0
                if not _meets(touches[w, f, o], places[e], laws[f, e], place):
                    continue
                # the element stands out: a pad that reaches it at all is on it, and not on the object beside it
                redirected[w, f, o, CONDUCTANCE] = 0.0
                for other in range(len(places)):
                    if places[other, 0] == o:
                        meeting += _meets(touches[w, f, o], places[other], laws[f, other], place)
                _meets(touches[w, f, o], places[e], laws[f, e], place)
                law, width = laws[f, e], places[e, 1]
                pressed = touches[w, f, o, FORCE] / substeps / meeting
                if bend[f, 0] + bend[f, 1] > 0:
                    area, force, _, _, _, _ = round_contact(bend[f], curve[e], sides, pressed, 0.0, 0.0)
                else:
                    area, force = contact(law, pressed, place)
                if area > 0 and force > 0:
                    side = min(np.sqrt(area), width)
                    series = 1 / (conductance(law, force / area) * area) + small[e] * (1 / side - 1 / width)
                    redirected[w, f, targets + e, CONDUCTANCE] = substeps / series
        for e in range(len(places)):
            bond = redirected[w, tips + e, int(places[e, 0])]
            bond[CONDUCTANCE] = substeps * BOND * places[e, 1] * places[e, 1]
            for i in range(3):
                bond[PLACE + i], bond[NORMAL + i] = places[e, 2 + i], places[e, 5 + 3 * i]


@njit(cache=True, error_model="numpy", inline="always")
def _meets(touch, element, law, place):
    """Whether a pad that touches the object is on the element; place: where from its middle, along its y and z."""
    if touch[FORCE] <= 0:
        return False
    facing = 0.0
    for k in range(3):
        place[k] = 0.0
        facing += touch[NORMAL + k] * element[5 + 3 * k]
        for i in range(3):
            place[k] += element[5 + 3 * i + k] * (touch[PLACE + i] - element[2 + i])
    half = law.half_pad + element[1] / 2
    return facing >= _FACING and abs(place[1]) < half and abs(place[2]) < half
