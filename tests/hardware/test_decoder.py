"""COBS, frames and the decoder: round trips, corrupted and random bytes, pieces of any size."""

import random
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermograsp.hardware.protocol import cobs
from thermograsp.hardware.protocol.decoder import Decoder
from thermograsp.hardware.protocol.frame import LONGEST, Frame, encode_frame
from thermograsp.hardware.protocol.messages import LENGTHS

from .tiers import size


def frames() -> st.SearchStrategy[Frame]:
    def of(code: int) -> st.SearchStrategy[Frame]:
        payload = st.binary(min_size=LENGTHS[code], max_size=LENGTHS[code])
        return st.builds(
            Frame,
            st.just(code),
            st.integers(0, 255),
            st.integers(0, 65535),
            st.integers(0, 2**32 - 1),
            payload,
        )

    return st.sampled_from(sorted(LENGTHS)).flatmap(of)


def textbook_encode(block: bytes) -> bytes:
    """COBS of a block without a run of 254 bytes that are not zero, as its paper words it."""
    return b"".join(bytes([len(run) + 1]) + run for run in block.split(b"\0"))


@given(st.binary(max_size=cobs.LONGEST))
def test_cobs_is_the_textbook_s_and_comes_back(block: bytes) -> None:
    stuffed = cobs.encode(block)
    assert stuffed == textbook_encode(block)
    assert 0 not in stuffed and len(stuffed) == len(block) + 1
    assert cobs.decode(stuffed) == block


@pytest.mark.parametrize(
    ("block", "stuffed"),
    [
        ("", "01"),
        ("00", "0101"),
        ("00 00", "010101"),
        ("11 22 00 33", "0311220233"),
        ("11 22 33 44", "0511223344"),
        ("11 00 00 00", "0211010101"),
    ],
)
def test_cobs_examples_of_the_paper_s_kind(block: str, stuffed: str) -> None:
    assert cobs.encode(bytes.fromhex(block)).hex() == stuffed
    assert cobs.decode(bytes.fromhex(stuffed)) == bytes.fromhex(block)


@pytest.mark.parametrize("bad", ["", "02", "0311", "ff11", "0103"])
def test_what_is_no_cobs_is_seen(bad: str) -> None:
    assert cobs.decode(bytes.fromhex(bad)) is None


def test_every_message_fits_the_longest_frame() -> None:
    assert max(LENGTHS.values()) + 12 <= LONGEST <= cobs.LONGEST


@given(st.lists(frames(), max_size=8), st.data())
def test_frames_come_back_whatever_the_pieces(sent: list[Frame], data: st.DataObject) -> None:
    wire = b"".join(encode_frame(frame) for frame in sent)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(wire)), max_size=12)))
    decoder, got = Decoder(), []
    for start, end in zip([0, *cuts], [*cuts, len(wire)], strict=True):
        got += decoder.feed(wire[start:end])
    assert got == sent
    assert decoder.counts.rejected == 0


@given(frames(), st.binary(max_size=300), frames())
def test_garbage_between_frames_costs_none(first: Frame, garbage: bytes, second: Frame) -> None:
    got = Decoder().feed(encode_frame(first) + garbage + encode_frame(second))
    assert (got[0], got[-1]) == (first, second)


@settings(max_examples=300)
@given(st.lists(st.binary(max_size=400), max_size=20))
def test_any_bytes_are_survived(pieces: list[bytes]) -> None:
    decoder = Decoder()
    for piece in pieces:
        decoder.feed(piece)
    frame = Frame(0x83, 0, 7, 0, b"\x64\x00")
    assert decoder.feed(encode_frame(frame))[-1] == frame


def flip(rng: random.Random, wire: bytearray) -> None:
    for _ in range(rng.randint(1, 3)):
        wire[rng.randrange(1, len(wire) - 1)] ^= 1 << rng.randrange(8)


def replace(rng: random.Random, wire: bytearray) -> None:
    wire[rng.randrange(1, len(wire) - 1)] = rng.randrange(256)


def burst(rng: random.Random, wire: bytearray) -> None:
    start = rng.randrange(1, len(wire) - 4)
    wire[start : start + 3] = rng.randbytes(3)


def drop(rng: random.Random, wire: bytearray) -> None:
    del wire[rng.randrange(1, len(wire) - 1)]


def insert(rng: random.Random, wire: bytearray) -> None:
    wire.insert(rng.randrange(1, len(wire) - 1), rng.randrange(256))


def truncate(rng: random.Random, wire: bytearray) -> None:
    del wire[rng.randrange(1, len(wire) - 1) :]


def swap(rng: random.Random, wire: bytearray) -> None:
    place = rng.randrange(1, len(wire) - 2)
    wire[place], wire[place + 1] = wire[place + 1], wire[place]


CORRUPTIONS: tuple[Callable[[random.Random, bytearray], None], ...] = (
    flip, replace, burst, drop, insert, truncate, swap,
)  # fmt: skip


def test_no_corrupted_frame_is_accepted() -> None:
    """What is accepted is what was sent: a corruption that changes nothing, such as a byte replaced by itself."""
    rng = random.Random(7)
    decoder, corrupted, wrong, clean_lost = Decoder(), 0, 0, 0
    codes = sorted(LENGTHS)
    while corrupted < size(20_000, 1_000_000):
        code = rng.choice(codes)
        frame = Frame(
            code, rng.randrange(256), rng.randrange(65536), rng.randrange(2**32), rng.randbytes(LENGTHS[code])
        )
        wire = encode_frame(frame)
        broken = bytearray(wire)
        rng.choice(CORRUPTIONS)(rng, broken)
        if broken == wire:
            continue
        corrupted += 1
        wrong += any(got != frame for got in decoder.feed(bytes(broken)))
        clean_lost += decoder.feed(wire)[-1:] != [frame]  # the next one must not suffer
    assert (wrong, clean_lost) == (0, 0)
    assert decoder.counts.accepted < corrupted * 1.001


def test_random_bytes_are_survived_and_the_next_frame_is_read() -> None:
    rng = random.Random(8)
    decoder, frame = Decoder(), Frame(0x07, 0, 1, 2, b"\1\2\3\4")
    for _ in range(size(20, 1000)):
        assert decoder.feed(rng.randbytes(10_000)) == []
        assert decoder.feed(encode_frame(frame)) == [frame]


def test_a_line_without_zeros_does_not_fill_the_memory() -> None:
    decoder = Decoder()
    for _ in range(100):
        decoder.feed(b"\x55" * 1000)
    assert len(decoder._pending) <= LONGEST + 1
    assert decoder.counts.misfits == 1
    frame = Frame(0x82, 0, 1, 0, b"\3")
    assert decoder.feed(encode_frame(frame)) == [frame]


@pytest.mark.parametrize(
    ("wire", "what"),
    [
        (encode_frame(Frame(0x42, 0, 0, 0, b"??")), "unknown"),
        (encode_frame(Frame(0x82, 0, 0, 0, b"??")), "length"),
        (b"\0\x09abc\0", "misfits"),
        (b"\0" + b"\x30" + b"a" * 30 + b"\0", "stuffing"),
        (b"\0" + b"\x1f" + b"a" * 30 + b"\0", "checksum"),
    ],
)
def test_what_is_wrong_is_counted(wire: bytes, what: str) -> None:
    decoder = Decoder()
    assert decoder.feed(wire) == []
    assert getattr(decoder.counts, what) == decoder.counts.rejected == 1
