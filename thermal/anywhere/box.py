"""The heat kernel of patches on the box that stands for a body beneath a place, bent as the surface is, until heat has
gone far.

P: patches, M: patterns, T: times.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy.special import erf

from ..kernels import TIMES, Patches, Tip, basis_jumps, basis_terms, box_kernel
from ..meshes import Film
from ..unrolled import filmed
from .beneath import Beneath
from .ports import LEVEL

_STILL = 1e-12  # m2, diffusivity times time before which heat has gone nowhere
_PAIRS = 4096  # of places, a few kB each


def box_kernels(
    below: Sequence[Beneath],
    at: Sequence[slice],
    one: Tip,
    diffusivity: float,
    conductivity: float,
    film: Film | None,
) -> np.ndarray:
    """(T, F, F) 1/m3 at TIMES, of unit material: of patches by themselves and of those on the faces of one box; zero
    where no box stands for the body. at: of each patch its ports among F, all patterns or the even one. diffusivity:
    m2/s. conductivity: W/(m K)."""
    taus = diffusivity * TIMES
    kernel = np.zeros((len(taus), at[-1].stop, at[-1].stop))
    for n, each in enumerate(below):
        if not each.plain:
            continue
        bent = bent_room(each, taus)
        if each.wet and film is not None:
            through = film.conductance / film.area / conductivity
            round_ = each.depth * each.curvature.sum()
            through *= (1 - round_) / (1 - round_ / 2)  # what is wet of a round wall, by its middle
            bent = bent * filmed(taus, each.depth, through)[:, None, None]
        for m, other in enumerate(below):
            if (other.plain and m > n) or (
                seen_by_other := _seen_by_other(each, other, one, diffusivity)
            ) is None:
                continue
            pair = bent * seen_by_other[:, : at[n].stop - at[n].start, : at[m].stop - at[m].start]
            kernel[:, at[n], at[m]], kernel[:, at[m], at[n]] = pair, pair.transpose(0, 2, 1)
    return kernel


@lru_cache(maxsize=_PAIRS)
def _seen_by_other(each: Beneath, other: Beneath, one: Tip, diffusivity: float) -> np.ndarray | None:
    """(T, M, M) 1/m3 at TIMES of two patches on the box beneath the first, or of that one by itself; None where the
    second is not on it."""
    on = each.own
    if on is None or (far := each.on_box(other.placed)) is None:
        return None
    taus = diffusivity * TIMES
    if other is each:
        return box_beneath(each, [on], one, taus)
    return box_beneath(each, [on, far], one, taus, wanted=1, first=1)


def box_beneath(
    each: Beneath,
    others: Sequence[tuple[int, np.ndarray, np.ndarray]],
    one: Tip,
    taus: np.ndarray,
    *,
    wanted: int | None = None,
    first: int = 0,
    even: Sequence[bool] | None = None,
) -> np.ndarray:
    """(T, rows, columns) 1/m3 between N patches of the box beneath one of them: a face, middle and half widths of each.
    wanted, first: as in box_kernel, all of them without. even: (N,) of which patches the even pattern alone is told;
    None for none of them."""
    faces, middles, halves = zip(*others, strict=True)
    jumps = np.array([basis_jumps(one.basis)] * len(others))
    patches = Patches(np.array(faces), np.array(middles), np.array(halves))
    terms, wanted = basis_terms(LEVEL.patterns), len(others) if wanted is None else wanted
    kernel, _, port, _, _ = box_kernel(
        *(each.size, 1.0, 1.0, 0.0, patches, jumps, terms, wanted, taus, first), even=even
    )
    return kernel + np.outer(port[: kernel.shape[1]], port[len(port) - kernel.shape[2] :])


def bent_room(each: Beneath, taus: np.ndarray) -> np.ndarray:
    """(T, 1, 1) of a flat body's kernel, by the surface's curvature: heat has less room under a round one. Through a
    wall's thickness, no further."""
    first, second = each.curvature
    reach = np.minimum(np.sqrt(np.pi * taus), each.depth)
    bend = (first + second) / 2 * reach
    bend = bend + (0.75 * (first**2 + second**2) + 0.5 * first * second) / np.pi * reach**2
    # heat that is even seen along the normal is thinner where the surface is slanted
    level = 1 - (first**2 + second**2) * each.placed.half_width**2 / 6
    across = _across(taus - each.depth**2 / np.pi, 2 * each.placed.half_width)
    return (level * (1 + bend * across))[:, None, None]


def _across(taus: np.ndarray, width: float) -> np.ndarray:
    """(T,) how much less heat stays under a patch of that width, m, per how much wider it is, after taus m2 along a
    wall: 1 at first. A round wall has less room than a flat one as long as heat goes through it; it goes along as far
    as along a flat one, unrolled in its middle."""
    part = width / np.sqrt(4 * np.maximum(taus, _STILL))
    lost = -np.expm1(-(part**2)) / (part * np.sqrt(np.pi))
    return 1 - lost / (erf(part) - lost)
