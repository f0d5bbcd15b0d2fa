"""A visitor's session, without the web: what it computes, how time passes in it, and what it refuses."""

import json
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from thermograsp.agents.recording import record
from thermograsp.columns import csv_text
from thermograsp.envs import GraspBatch, GraspTask
from thermograsp.errors import InvalidValueError
from thermograsp.studio.control.choices import (
    RANGES,
    SPEEDS,
    Choices,
    Controls,
    Stock,
)
from thermograsp.studio.session.log import Log
from thermograsp.studio.session.session import MOST_STEPS, Session
from thermograsp.studio.sources.source import grasp_of

TURN = 1 / 30  # s


def turn(session: Session, seconds: float = TURN) -> list[dict[str, Any]]:
    session.advance(seconds)
    messages = session.messages()
    json.dumps(messages, allow_nan=False)
    return messages


def of_kind(messages: list[dict[str, Any]], kind: str) -> list[dict[str, Any]]:
    return [message for message in messages if message["kind"] == kind]


@pytest.fixture
def session() -> Iterator[Session]:
    """Set up, at its beginning, paused."""
    with closing(paused()) as made:
        yield made


@pytest.fixture(scope="module")
def refusing() -> Iterator[Session]:
    """One for all that is refused, which changes nothing."""
    with closing(paused()) as made:
        yield made


def paused() -> Session:
    made = Session()
    made.handle({"do": "control", "playing": False})
    turn(made)
    turn(made)
    return made


def play(session: Session, seconds: float) -> list[dict[str, Any]]:
    session.handle({"do": "control", "playing": True})
    messages = []
    for _ in range(round(seconds / TURN)):
        messages += turn(session)
    return messages


def learnt(session: Session) -> None:
    """Waits for the library of curves."""
    for feeling in session._feelings:
        feeling._making.result(timeout=300)


def test_it_computes_what_the_command_grasp_computes(session: Session) -> None:
    for name, text in (("materials", ["glass", "cotton"]), ("seed", 3)):
        session.handle({"do": "choose", name: text})
    turn(session)
    turn(session)
    play(session, 2.0)
    session.handle({"do": "csv"})
    files = of_kind(turn(session, 0.0), "csv")
    steps = round(session.time / 0.02)
    assert [file["name"] for file in files] == ["glass_T.csv", "cotton_T.csv"]
    for file, material in zip(files, ("glass", "cotton"), strict=True):
        batch = GraspBatch(1, task=GraspTask(seconds=60.0), material=material)
        (expected,) = record(batch, [3], steps * batch.dt)
        assert file["text"] == csv_text(expected.columns)


def test_frames_carry_every_sample_once(session: Session) -> None:
    messages = play(session, 1.5)
    time = [t for frame in of_kind(messages, "frame") for t in frame["curves"].get("time", [])]
    np.testing.assert_allclose(time, 0.01 * (1 + np.arange(len(time))), rtol=0, atol=1e-6)
    assert len(time) == round(100 * session.time)
    for frame in of_kind(messages, "frame"):
        for row in frame["curves"].get("rows", []):
            assert [len(curve) for curve in row] == [len(frame["curves"]["time"])] * 6


@pytest.mark.parametrize("speed", SPEEDS)
def test_time_passes_as_fast_as_asked(session: Session, speed: float) -> None:
    session.handle({"do": "control", "speed": speed})
    play(session, 1.0)
    assert session.time == pytest.approx(speed, abs=0.021)


def test_a_pause_and_single_steps(session: Session) -> None:
    for _ in range(10):
        turn(session)
    assert session.time == 0.0
    for k in range(1, 4):
        session.handle({"do": "step"})
        turn(session)
        turn(session)
        assert session.time == pytest.approx(k * 0.02)


def test_a_machine_that_is_too_slow_falls_behind_and_goes_on(session: Session) -> None:
    session.handle({"do": "control", "playing": True, "speed": 4.0})
    turn(session, 100.0)
    assert session.time == pytest.approx(MOST_STEPS * 0.02)
    turn(session, 0.0)
    assert session.time == pytest.approx(MOST_STEPS * 0.02, abs=0.021)


def test_it_begins_again_with_the_same_bits(session: Session) -> None:
    def voltages() -> list[float]:
        return [
            v
            for frame in of_kind(play(session, 0.8), "frame")
            for v in frame["curves"].get("rows", [[[]]])[0][0]
        ]

    first = voltages()
    session.handle({"do": "again"})
    session.handle({"do": "control", "playing": False})
    assert of_kind(turn(session, 0.0), "begin")
    assert session.time == 0.0
    assert voltages() == first
    assert max(first) > 1e-3


def test_what_is_asked_for_many_times_at_once_is_done_once(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    play(session, 0.2)
    resets = []
    monkeypatch.setattr(session._grasp, "reset", resets.append)
    for _ in range(64):
        session.handle({"do": "csv"})
    assert len(of_kind(turn(session), "csv")) == 1
    for _ in range(64):
        session.handle({"do": "again"})
    turn(session)
    turn(session)
    assert len(resets) == 1


def test_a_grasp_that_cannot_be_told_of_is_closed() -> None:
    """A gripper's ports would stay taken else, and the next choice fail."""

    class Broken:
        rows, paced, closed = 1, True, False

        def touch_setup(self, row: int) -> None:
            raise InvalidValueError("no such touch")

        def close(self) -> None:
            Broken.closed = True

    session = Session(make=lambda choices, stock: Broken())
    messages = [*turn(session), *turn(session)]
    assert of_kind(messages, "problem")[0]["text"] == "no such touch"
    assert Broken.closed
    session.close()


def test_the_posterior_finds_out(session: Session) -> None:
    session.handle({"do": "choose", "materials": ["aluminium", "cotton"]})
    turn(session)
    turn(session)
    last = {}
    learnt(session)
    for found in of_kind(play(session, 3.0), "posterior"):
        assert sum(chance for _, chance in found["likely"]) <= 1.001
        last[found["row"]] = found
    metals = {"aluminium", "iron", "stainless_steel"}
    assert last[0]["likely"][0][0] in metals and last[1]["likely"][0][0] == "cotton"
    low, median, high = last[1]["effusivity"]
    assert low < median < high < last[0]["effusivity"][0]


def test_the_sliders_move_the_gripper(session: Session) -> None:
    session.handle({"do": "control", "driver": "sliders", "opening": 0.06, "height": 0.03})
    (frame,) = of_kind(play(session, 1.5)[-1:], "frame")
    assert frame["rows"][0]["opening"] == pytest.approx(0.06, abs=5e-4)
    assert frame["rows"][0]["height"] == pytest.approx(0.03, abs=5e-4)


@pytest.mark.parametrize("driver", ["feeling", "trained"])
def test_policies_lift_the_heavy_box(session: Session, driver: str) -> None:
    session.handle({"do": "choose", "shape": "heavy box", "materials": ["cheese"]})
    session.handle({"do": "control", "driver": driver})
    turn(session)
    turn(session)
    row = of_kind(play(session, 3.0)[-1:], "frame")[0]["rows"][0]
    assert "mm up" in row["state"] and not row["ending"]


def test_a_looser_tolerance_takes_a_cheaper_rung(session: Session) -> None:
    costs = []
    for tolerance in (0.02, 0.5):
        session.handle({"do": "choose", "tolerance": tolerance})
        turn(session)
        messages = turn(session)
        costs.append(of_kind(messages, "frame")[0]["rows"][0]["cost"])
        assert costs[-1]["rung"].startswith("network:")
    assert costs[1]["multiply_adds"] < costs[0]["multiply_adds"] and costs[1]["states"] < costs[0]["states"]


def test_it_is_told_that_a_choice_takes_a_moment(session: Session) -> None:
    session.handle({"do": "choose", "materials": ["wood"]})
    (frame,) = of_kind(turn(session), "frame")
    assert frame["busy"] == "wood"
    messages = turn(session)
    assert of_kind(messages, "scene")[0]["rows"] == ["wood"] and messages[-1]["busy"] == ""


def test_a_grasp_is_shown_when_its_first_step_has_been_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """The page would stand still else, and the library of curves keep the compiler busy meanwhile."""
    done = []
    step, submit = GraspBatch.step, ThreadPoolExecutor.submit

    def stepped(self: GraspBatch, action: np.ndarray) -> Any:
        done.append("step")
        return step(self, action)

    def submitted(self: ThreadPoolExecutor, *work: Any) -> Any:
        done.append("curves")
        return submit(self, *work)

    monkeypatch.setattr(GraspBatch, "step", stepped)
    monkeypatch.setattr(ThreadPoolExecutor, "submit", submitted)
    session = Session()
    turn(session)
    assert session.preparing and not done
    messages = turn(session)
    assert done == ["step", "curves"] and of_kind(messages, "scene") and session.time == 0.0
    assert of_kind(messages, "frame")[0]["curves"] == {}
    session.close()


def test_a_choice_that_cannot_be_had_leaves_what_was() -> None:
    def make(choices: Choices, stock: Stock) -> Any:
        if choices.tolerance < 0.02:
            raise InvalidValueError("no network keeps that tolerance")
        return grasp_of(choices, stock)

    session = Session(make=make)
    for _ in range(2):
        turn(session)
    session.handle({"do": "choose", "tolerance": 0.01})
    turn(session)
    messages = turn(session)
    assert of_kind(messages, "problem")[0]["text"] == "no network keeps that tolerance"
    assert of_kind(messages, "chosen")[0]["choices"] == session.choices.message() == Choices().message()
    play(session, 0.5)
    assert session.time == pytest.approx(0.5, abs=0.021)
    session.close()


JUNK = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)
FIELDS = st.sampled_from([*Choices().message(), *Controls().message(), "id", "do", "x"])


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    do=st.sampled_from(["choose", "control", "again", "step", "csv", "hello", None]) | JUNK,
    content=st.dictionaries(FIELDS, JUNK, max_size=3),
)
def test_no_message_breaks_it(session: Session, do: Any, content: dict[str, Any]) -> None:
    session.handle({**content, "do": do})
    stock = Stock()
    for chosen in (session.choices, session._wanted or session.choices):
        assert Choices().changed(chosen.message(), stock) == chosen  # only what may be
    assert Controls().changed(session.controls.message()) == session.controls
    session._wanted = None  # a scene takes longer than a fuzzer has
    turn(session, 0.0)


@pytest.mark.parametrize("name", [*RANGES])
@pytest.mark.parametrize("off", [-1e-6, 1e-6, float("nan"), float("inf"), True, "1", None])
def test_numbers_outside_their_range_are_refused(refusing: Session, name: str, off: Any) -> None:
    allowed = RANGES[name]
    value = off
    if isinstance(off, float) and np.isfinite(off):
        value = (allowed.low if off < 0 else allowed.high) + off
    before = refusing.choices, refusing.controls
    refusing.handle({"do": "choose" if name in Choices().message() else "control", name: value})
    (problem,) = of_kind(turn(refusing, 0.0), "problem")
    assert name in problem["text"]
    assert (refusing.choices, refusing.controls) == before


def test_the_log_keeps_the_newest() -> None:
    log = Log(3)
    for k in range(5):
        log.add({"time_s": np.array([[k, k + 0.5]]), "x": np.array([[0.0, k]])})
    kept = log.since(0)
    np.testing.assert_array_equal(kept["time_s"], [[2, 2.5, 3, 3.5, 4, 4.5]])
    np.testing.assert_array_equal(log.since(4)["x"], [[0, 4]])
    assert log.since(5) == {}
