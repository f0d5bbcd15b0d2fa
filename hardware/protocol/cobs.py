"""Consistent overhead byte stuffing: bytes without zeros, so that a zero can end a frame.

S. Cheshire & M. Baker, "Consistent Overhead Byte Stuffing", IEEE/ACM Transactions on Networking 7(2), 159-172 (1999),
for blocks of at most 253 bytes: these need exactly one byte more, and a zero costs one step of a chain.
"""

from __future__ import annotations

LONGEST = 253


def encode(block: bytes) -> bytes:
    """The block, at most LONGEST bytes, as one byte more without a zero among them: each zero, and the byte put in
    front, gives way to the distance to the next one or to the end."""
    stuffed = bytearray(b"\0")
    stuffed += block
    here = 0
    while (following := stuffed.find(0, here + 1)) >= 0:
        stuffed[here] = following - here
        here = following
    stuffed[here] = len(stuffed) - here
    return bytes(stuffed)


def decode(stuffed: bytes) -> bytes | None:
    """The block whose encoding this is, None where there is none. stuffed: without a zero."""
    block = bytearray(stuffed)
    end = len(block)
    here = 0
    while here < end:
        step = block[here]
        block[here] = 0
        here += step
    return bytes(block[1:]) if here == end and end else None
