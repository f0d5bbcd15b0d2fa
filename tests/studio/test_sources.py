"""Grasps that are not simulated: recordings, and a gripper on serial ports."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp.columns import read_csv, write_csv
from thermograsp.envs import ObjectSpec
from thermograsp.envs.mechanics import build_scene
from thermograsp.envs.plant.simulated import simulated_plant
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    Fingertips,
    GripperModel,
    RobotiqGripper,
    VirtualLine,
)
from thermograsp.hardware.plant.pacing import VirtualTime
from thermograsp.hardware.plant.serial import SerialPlant
from thermograsp.studio.control.choices import Choices, Controls, Stock
from thermograsp.studio.session.session import Session
from thermograsp.studio.sources.played import PlayedGrasp
from thermograsp.studio.sources.shapes import shapes_of
from thermograsp.studio.sources.simulated import SimulatedGrasp
from thermograsp.twin.simulated_hand import SimulatedHand

TURN = 1 / 30  # s


def set_up(stock: Stock) -> Session:
    session = Session(stock)
    for _ in range(2):
        session.advance(TURN)
    return session


def messages(session: Session) -> list[dict[str, Any]]:
    sent = session.messages()
    json.dumps(sent, allow_nan=False)
    return sent


@pytest.fixture(scope="module")
def simulated() -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """1.5 s of a grasp of glass: its columns, and what the page is shown at the end."""
    grasp = SimulatedGrasp(Choices(), Stock())
    blocks = [grasp.step(Controls()) for _ in range(75)]
    columns = {name: np.concatenate([block[name][0] for block in blocks]) for name in blocks[0]}
    return columns, grasp.message(0)


@pytest.mark.slow
def test_a_recording_gives_all_its_samples(
    simulated: tuple[dict[str, np.ndarray], dict[str, Any]], tmp_path: Path
) -> None:
    columns, shown = simulated
    file = tmp_path / "glass.csv"
    write_csv(file, columns)
    session = set_up(Stock(recording=str(file)))
    found = []
    session._feelings[0]._making.result(timeout=300)
    for _ in range(round(2.0 / TURN)):
        session.advance(TURN)
        found += [message for message in messages(session) if message["kind"] == "posterior"]
    assert {name for name, _ in found[-1]["likely"][:2]} & {"glass", "ceramic"}
    session.handle({"do": "csv"})
    (message,) = [message for message in messages(session) if message["kind"] == "csv"]
    assert message["text"] == file.read_text(encoding="utf-8")
    (row,) = messages(session)[-1]["rows"]
    assert row["ending"] == "the recording’s end"
    assert row["celsius"]["object"] == pytest.approx(shown["celsius"]["object"], abs=1e-3)
    # The puppet stands as the simulated gripper did; only its pads are not turned by what they press on.
    np.testing.assert_allclose(np.array(row["poses"])[:, :3], np.array(shown["poses"])[:, :3], atol=1.2e-3)


def test_a_press_has_one_fingertip(tmp_path: Path) -> None:
    file = tmp_path / "press.csv"
    time = np.arange(0.0, 2.0, 0.02)
    write_csv(
        file, {"time_s": time, "voltage_V": 4e-3 * (1 - np.exp(-time / 0.3)), "temperature_drop_K": time}
    )
    session = set_up(Stock(recording=str(file)))
    for _ in range(70):
        session.advance(TURN)
    frame = messages(session)[-1]
    curves = frame["curves"]["rows"][0]
    assert curves[1] is None and curves[4] is None and len(curves[0]) == len(curves[2]) == len(time)
    assert frame["rows"][0]["opening"] == 0.085  # not known: open


def test_lost_samples_are_gaps(
    simulated: tuple[dict[str, np.ndarray], dict[str, Any]], tmp_path: Path
) -> None:
    file = tmp_path / "gaps.csv"
    columns = {name: values.copy() for name, values in simulated[0].items()}
    columns["voltage_left_V"][60:70] = np.nan
    write_csv(file, columns)
    grasp = PlayedGrasp(Choices(), Stock(recording=str(file)))
    voltages = np.concatenate([grasp.step(Controls())["voltage_left_V"][0] for _ in range(75)])
    assert np.isnan(voltages[60:70]).all() and np.isfinite(voltages[70:]).all()
    session = set_up(Stock(recording=str(file)))
    for _ in range(60):
        session.advance(TURN)
    assert messages(session)[-1]["curves"]["rows"][0][0][60:70] == [None] * 10


@pytest.mark.parametrize(
    "columns",
    [
        {"time_s": np.arange(3.0)},
        {"voltage_left_V": np.arange(3.0)},
        {"time_s": np.array([0.0, 1.0, 1.0]), "voltage_V": np.zeros(3)},
        {"time_s": np.array([0.0, 1.0, np.nan]), "voltage_V": np.zeros(3)},
        {"time_s": np.array([0.0, 1e9]), "voltage_V": np.zeros(2)},
    ],
)
def test_what_is_no_recording_is_refused(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    write_csv(tmp_path / "x.csv", columns)
    with pytest.raises(InvalidValueError, match="time_s|voltage_left_V"):
        PlayedGrasp(Choices(), Stock(recording=str(tmp_path / "x.csv")))


def test_a_real_gripper(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The real driver and client on emulated devices, in virtual time."""
    hand = SimulatedHand(
        simulated_plant("simulated", 1, material="glass"), model=GripperModel(activation_speed=1.0)
    )
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, setpoint=36.0)
    gripper = RobotiqGripper(lines[1].open, clock=lines[1].clock, sleep=lines[1].advance)
    plant = SerialPlant(tips, gripper, pace=VirtualTime(lines))
    monkeypatch.setattr("thermograsp.envs.gym.batch.plant_factory", lambda url: lambda url, num_envs: plant)
    session = set_up(Stock(plant="serial:emulated"))
    hello = messages(session)[0]
    assert hello["drivers"] == ("scripted", "sliders") and "play" in hello["fixed"]
    session.handle({"do": "control", "driver": "sliders", "opening": 0.0, "force": 20.0})
    for _ in range(150):  # a step each, whatever time has passed
        session.advance(0.0)
    sent = messages(session)
    frame = sent[-1]
    assert session.time == pytest.approx(3.0, abs=0.1)
    assert max(frame["curves"]["rows"][0][0]) > 2e-3
    assert frame["rows"][0]["state"] == "gripped"
    assert frame["rows"][0]["opening"] == pytest.approx(0.04, abs=1e-3)
    assert "object" not in {
        shape["part"] for message in sent if message["kind"] == "scene" for shape in message["shapes"]
    }
    for wrong in ({"playing": False}, {"speed": 0.5}, {"driver": "trained"}):
        session.handle({"do": "control", **wrong})
        assert any(message["kind"] == "problem" for message in messages(session))
    session.handle({"do": "csv"})
    (table,) = [message for message in messages(session) if message["kind"] == "csv"]
    (tmp_path / "real.csv").write_text(table["text"], encoding="utf-8")
    assert (np.diff(read_csv(tmp_path / "real.csv")["time_s"]) > 0).all()
    session.close()


def test_elements_are_known_by_what_the_scene_calls_them() -> None:
    """A cube whose name looks like an element's has the cube's temperature, one that is see-through is a pad."""
    plain = ObjectSpec(name="an_element_left", position=(0.0, 0.0))
    glued = ObjectSpec(name="pad_block", position=(0.1, 0.0), elements=(0.009, 0.001))
    shapes = shapes_of(build_scene((plain, glued)), ("an_element_left", "pad_block"))
    parts = [shape["part"] for shape in shapes]
    assert parts.count("an_element_left") == 1 and parts.count("pad_block") == 1
    assert {"pad_block_element_left", "pad_block_element_right"} <= set(parts)
    assert {shape["part"] for shape in shapes if shape["alpha"] < 1} == {"pad_left", "pad_right"}
