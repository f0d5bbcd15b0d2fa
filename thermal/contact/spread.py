"""How large a patch of even conductance stands for a curved body on a bare face.

Beside the contact gas conducts k/(d + r^2/(2 R)): as well as between lapped faces in the middle, and out at the face's
edge a hundredth of it. A network has one patch of one conductance. With g the conductance of the gas over the whole
face, W/K, and g' that of the same gas with 1/b = l (1/k + 1/k') of both bodies in series at each place, a patch of area

    A = g g'/(b (g - g'))

and evenly g/A loses as much to the bodies' resistance as the gas does: little where b is large, so that the patch is
wide under wood and narrow under copper. The contact itself is as large as it is, and the patch is the mean of both
areas, weighted by what they conduct. l is how deep heat has come into the body in a second, but 0.8 mm at most, since
it spreads sideways by then: a fit to finite volumes of the contact place by place (studies/curved_patch.py), balls of
5, 20 and 50 mm of five materials.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ..matter import Material
from .footprint import beside, solid_conduction, touched
from .rough_faces import LAPPED_ALUMINA, Surface

_DEEPEST, _SECONDS = 0.8e-3, 1.0  # m, s, see above
_MIDDLE = np.zeros(3)


def even_patch(law: np.void, body: Material, force: float, face: Surface = LAPPED_ALUMINA) -> float:
    """m2, of a bare_footprint of the body at a force N > 0 on the pad, over the face's middle."""
    return float(even_contact(law, beneath(body, face), force, _MIDDLE)[1])


def beneath(body: Material, face: Surface) -> float:
    """m2 K/W, the resistance of both bodies: what even_contact takes."""
    depth = min(float(np.sqrt(body.diffusivity * _SECONDS)), _DEEPEST)
    return depth * (1 / face.conductivity + 1 / body.conductivity)


@njit(cache=True, error_model="numpy")
def even_contact(law, resistance, force, place):
    """(W/K, m2 of the even patch) at a force N > 0 on the pad; see footprint's conduction."""
    area, load, square, hertz = touched(law, force, place)
    gas = beside(law, law.mean_gap, area, square, hertz, place)
    total = solid_conduction(law, area, load) + gas
    if gas <= 0.0:
        return total, area
    less = beside(law, law.mean_gap + law.gas * resistance, area, square, hertz, place)
    spread = max(4 * law.half_face * law.half_face - area, 0.0)
    if gas > less:
        spread = min(gas * less * resistance / (gas - less), spread)
    if law.constriction > 0.0:  # what would flow there without force is spread as wide
        gas += law.gas / law.mean_gap * area
    return total, area + spread * min(gas / total, 1.0)
