"""Where a narrow contact lies: how much nearer to an end of a face than the middle, which is where heat is hemmed in.

Under a strip as broad as p on a wide body heat goes to both sides; where the body ends beside it, to one. The image of
the strip behind that end stands for the end: its temperature falls with the logarithm of the distance 2 m of the
strip's middle from its image (Carslaw & Jaeger, section 10.10), from that of a strip at the end, m = p/2, to that of
one in the middle of the face of a sensor. Shares are 0 there and 1 at the end, along one axis each; 1 too of what is as
long as the face. That is the sensor's whole face, however little of it a narrow pad bears: what such a pad touches lies
in the middle of it, with room on both sides."""

from __future__ import annotations

import math
from types import ModuleType

from thermograsp.compiled import njit

from ..numerics import Array, namespace_of

NARROW = 1 - 1e-9
"""Of the sensor's width: contacts narrower than that have heat to spread."""


@njit(cache=True, borrows=True, error_model="numpy")
def patch_offset(offset, length, width):
    """Share by which a contact of that length m lies at an end of the sensor's face, its middle offset m from the
    face's. Both ends count: their images follow one another at the sensor's width m."""
    if not 0.0 < length < width * NARROW:
        return 1.0
    near = math.log(math.sin(math.pi * length / (2 * width)))
    if near == 0.0:  # as long as the face, as far as numbers tell
        return 1.0
    aside = math.cos(math.pi * min(abs(offset), (width - length) / 2) / width)
    return min(math.log(aside) / near, 1.0)


@njit(cache=True, borrows=True, error_model="numpy")
def offset_of_share(share, length, width):
    """m from the face's middle of a contact's, of which patch_offset tells that share; 0 of what is as long as the
    face."""
    if not 0.0 < length < width * NARROW:
        return 0.0
    near = math.log(math.sin(math.pi * length / (2 * width)))
    aside = math.acos(math.exp(min(max(share, 0.0), 1.0) * near)) * width / math.pi
    return min(aside, (width - length) / 2)


@njit(cache=True, borrows=True, error_model="numpy")
def patch_ends(middle, pad, length, side, width):
    """Share by which a contact of that length m lies at an end of what is touched, which is side m long: middle and pad
    (m) are the contact's middle and the pad's from its own. What the whole face of a pad there meets is 0."""
    if not 0.0 < length < width * NARROW:
        return 1.0
    whole = max(side / 2 - abs(pad), min(side, width) / 2)
    near = max(side / 2 - abs(middle), length / 2)
    return min(max(math.log(whole / near) / math.log(width / length), 0.0), 1.0)


def array_patch_offset(offset: Array, length: Array, width: Array) -> Array:
    """patch_offset as a pure function of arrays: NumPy, PyTorch, JAX."""
    xp = namespace_of(length)
    narrow, short = _narrow(xp, length, width)
    near = xp.log(xp.sin(math.pi * short / (2 * width)))
    aside = xp.cos(math.pi * xp.minimum(abs(offset), (width - short) / 2) / width)
    share = xp.log(aside) / xp.where(near < 0, near, -1.0 + 0.0 * near)
    return xp.where(narrow & (near < 0), share.clip(None, 1.0), 1.0 + 0.0 * length)


def array_offset_of_share(share: Array, length: Array, width: Array) -> Array:
    """offset_of_share as a pure function of arrays."""
    xp = namespace_of(length)
    narrow, short = _narrow(xp, length, width)
    near = xp.log(xp.sin(math.pi * short / (2 * width)))
    held = share.clip(0.0, 1.0)
    # the arc's cosine has no slope where there is nothing aside
    some = held * near < 0
    aside = xp.arccos(xp.exp(xp.where(some, held * near, near - 1.0))) * width / math.pi
    return xp.where(narrow & some, xp.minimum(aside, (width - short) / 2), 0.0 * length)


def array_patch_ends(middle: Array, pad: Array, length: Array, side: Array, width: Array) -> Array:
    """patch_ends as a pure function of arrays."""
    xp = namespace_of(length)
    narrow, short = _narrow(xp, length, width)
    whole = xp.maximum(side / 2 - abs(pad), xp.minimum(side, width + 0.0 * side) / 2)
    near = xp.maximum(side / 2 - abs(middle), short / 2)
    # what is not narrow may have no room at all
    share = xp.log(xp.where(narrow, whole / near, 1.0 + 0.0 * near)) / xp.log(width / short)
    return xp.where(narrow, share.clip(0.0, 1.0), 1.0 + 0.0 * length)


def _narrow(xp: ModuleType, length: Array, width: Array) -> tuple[Array, Array]:
    """Which contacts are narrow, and their lengths m; of others one that is."""
    narrow = (length > 0) & (length < width * NARROW)
    return narrow, xp.where(narrow, length, width / 2 + 0.0 * length)
