"""What a session makes of frames, in any order and with any content: counts that add up, times that do not fall."""

from hypothesis import given
from hypothesis import strategies as st

from thermograsp.hardware.protocol.frame import Frame, encode_frame
from thermograsp.hardware.protocol.messages import (
    Acknowledgement,
    Calibration,
    Code,
    Result,
    Sample,
    encode_message,
)
from thermograsp.hardware.protocol.samples import samples_of
from thermograsp.hardware.protocol.session import Session

from .test_decoder import frames

SAMPLE = encode_message(Sample((1e-3, 2e-3), (36.0, 36.0), ((1, 0, 0), (2, 0, 0))))


def wire(sequence: int, device_us: int, flags: int = 0) -> bytes:
    return encode_frame(Frame(Code.SAMPLE, flags, sequence % 65536, device_us % 2**32, SAMPLE))


@given(st.lists(st.tuples(frames(), st.floats(0.0, 100.0))))
def test_any_frames_are_survived(given_frames: list[tuple[Frame, float]]) -> None:
    session, now = Session(), 0.0
    for frame, pause in given_frames:
        now += pause
        session.receive(encode_frame(frame), now)
    samples = samples_of(list(session.rows), Calibration())
    assert len(samples) == session.counts.samples
    assert (samples.time[1:] >= samples.time[:-1]).all()
    assert (samples.time <= samples.arrival).all()
    counts = session.counts
    sent = sum(frame.code == Code.SAMPLE for frame, _ in given_frames)
    assert counts.samples + counts.duplicates + counts.late >= sent
    assert counts.echoes == sum(frame.code >= 0x80 for frame, _ in given_frames)


@given(st.lists(st.sampled_from(["sent", "lost", "twice"]), min_size=1, max_size=200), st.integers(0, 2**32))
def test_losses_and_duplicates_are_counted_exactly(fates: list[str], begun_us: int) -> None:
    """From any start of the device's numbers and time, so through their wraps too; the first and last get through."""
    fates = ["sent", *fates, "sent"]
    session = Session()
    for k, fate in enumerate(fates):
        if fate != "lost":
            data = wire(begun_us + k, begun_us + 10_000 * k)
            session.receive(data * (1 + (fate == "twice")), 0.01 * k)
    assert session.counts.samples == len(fates) - fates.count("lost")
    assert session.counts.lost == sum(row.lost for row in session.rows) == fates.count("lost")
    assert session.counts.duplicates == fates.count("twice")
    assert session.counts.late == 0
    last, first = session.rows[-1], session.rows[0]
    assert abs(last.device_time - first.device_time - 0.01 * (len(fates) - 1)) < 1e-6


def test_an_older_frame_is_late_and_a_very_long_gap_is_not() -> None:
    session = Session()
    session.receive(wire(100, 1_000_000), 1.0)
    session.receive(wire(99, 990_000), 1.001)
    assert (session.counts.late, session.counts.samples) == (1, 1)
    session.receive(wire(100 + 40_000, 41_000_000), 41.0)  # more than half of the numbers are missing
    assert (session.counts.late, session.counts.samples, session.counts.lost) == (1, 2, 39_999)


def test_a_silence_longer_than_the_device_s_clock_goes_round() -> None:
    """Of the times that 32 bits may mean, the one that the host's clock expects."""
    session = Session()
    session.receive(wire(0, 5_000_000), 5.0)
    session.receive(wire(1, 5_000_000 + 10_000 * 1_000_000), 10_005.3)
    assert session.rows[-1].device_time == 10_005.0


def test_a_reboot_begins_at_zero() -> None:
    session = Session()
    session.receive(wire(500, 100_000_000), 100.0)
    session.receive(wire(0, 1_000, flags=0x80), 101.0)
    session.receive(wire(1, 11_000, flags=0x80), 101.01)
    assert (session.counts.late, session.counts.lost, session.unidentified) == (0, 0, True)
    assert [row.device_time for row in session.rows] == [100.0, 0.001, 0.011]
    assert [round(row.time, 3) for row in session.rows] == [100.0, 101.0, 101.01]


def test_what_comes_before_the_first_answer_on_an_opened_line_is_old() -> None:
    """Half a second of samples that waited somewhere, in a burst, then the answer and what is new."""
    session = Session()
    session.receive(wire(0, 1_000_000), 1.0)
    session.reopened()
    for k in range(50):
        session.receive(wire(100 + k, 2_000_000 + 10_000 * k), 3.0)
    answer = encode_message(Acknowledgement(7, Code.SET_RATE, Result.DONE))
    session.receive(encode_frame(Frame(Code.ACKNOWLEDGEMENT, 0, 150, 3_000_000, answer)), 3.001)
    assert len(session.rows) == 1, "an answer to another host's command"
    session.awaited[7] = None
    session.receive(encode_frame(Frame(Code.ACKNOWLEDGEMENT, 0, 151, 3_001_000, answer)), 3.002)
    session.receive(wire(152, 3_010_000), 3.011)
    assert [row.device_time for row in session.rows] == [1.0, 3.01]
    assert session.rows[-1].time == 3.01 and session.clock.drift == 0.0
