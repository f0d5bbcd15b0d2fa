"""A gripper on a pseudo-terminal, in real time: other people's clients drive it, and ours survives what a line does."""

import json
import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from thermograsp.cli import main
from thermograsp.errors import ThermograspError
from thermograsp.hardware import (
    Contact,
    EmulatedGripper,
    Fault,
    GripperFaultError,
    GripperModel,
    LineFaults,
    LinkLostError,
    ModbusSettings,
    NoAnswerError,
    PortBusyError,
    PortMissingError,
    PtyDevice,
    RobotiqGripper,
    SerialPort,
    SpringFingers,
    StoppedError,
    open_gripper,
)
from thermograsp.hardware.emulators.planned_gripper_faults import plan_gripper_fault

from .serving import PATIENCE, nothing_left, plugged_elsewhere

pytest.importorskip("serial")
pytest.importorskip("pymodbus")


@pytest.fixture(autouse=True)
def no_leak() -> Iterator[None]:
    with nothing_left():
        yield


@contextmanager
def serving(folder: Path, width: float | None = 0.03) -> Iterator[PtyDevice[EmulatedGripper]]:
    """Quick at activation, so that nobody waits."""
    device = EmulatedGripper(GripperModel(activation_speed=2.0), SpringFingers(0.085, width))
    with PtyDevice(device, folder / "gripper") as served:
        yield served


def in_time(act: Callable[[], object]) -> float:
    begun = time.monotonic()
    act()
    return time.monotonic() - begun


def works(gripper: RobotiqGripper) -> bool:
    """Within the patience."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        try:
            gripper.status()
            return True
        except (LinkLostError, PortMissingError, NoAnswerError):
            time.sleep(0.01)
    return False


def test_pyrobotiqgripper_activates_moves_grasps_and_sees_a_fault(tmp_path: Path) -> None:
    """A client by other authors (Castets, from the package index), with their own reading of the manual."""
    other = pytest.importorskip("pyrobotiqgripper")
    with serving(tmp_path) as served:
        gripper = other.RobotiqGripper(com_port=served.path)
        try:
            assert not gripper.isActivated()
            gripper.activate()
            assert gripper.isActivated() and gripper.isStarted()
            gripper.open()
            assert gripper.position() <= 3
            gripper.move(100)
            assert (gripper.position(), gripper.objectDetection()) == (100, other.GOBJ_AT_POSITION)
            gripper.close(force=0)  # 20 N on 100 N/mm
            assert gripper.objectDetection() == other.GOBJ_DETECTED_WHILE_CLOSING
            assert gripper.position() == round(230 - 227 * 0.0298 / 0.085)
            gripper.stop()
            with served.paused():
                served.device.fail(Fault.OVERCURRENT)
            with pytest.raises(other.GripperFaultError):
                gripper.readStatus()
            gripper.activate()
            gripper.move(50)
            assert gripper.position() == 50
        finally:
            gripper.disconnect()


def test_pymodbus_own_client(tmp_path: Path) -> None:
    """Each function code that the manual lists, by a master that is not ours."""
    from pymodbus.client import ModbusSerialClient

    with serving(tmp_path) as served:
        client = ModbusSerialClient(served.path, baudrate=115200, timeout=0.3, retries=2)
        try:
            assert client.connect()
            assert client.read_holding_registers(2000, count=3, device_id=9).registers[0] == 0
            assert not client.write_register(1000, 0x0100, device_id=9).isError()
            time.sleep(0.3)
            assert client.read_input_registers(2000, count=1, device_id=9).registers == [0x3100]
            assert not client.write_registers(1000, [0x0900, 60, 0xFF20], device_id=9).isError()
            time.sleep(0.6)
            both = client.readwrite_registers(
                read_address=2000, read_count=3, write_address=1001, values=[60], device_id=9
            )
            assert both.registers == [0xF900, 60, 60 << 8]
        finally:
            client.close()


def test_ours_in_real_time(tmp_path: Path) -> None:
    with serving(tmp_path) as served, open_gripper(f"robotiq://{served.path}") as gripper:
        gripper.activate()
        gripper.move(0.0, 40.0, 0.15)
        assert isinstance(gripper, RobotiqGripper)
        status = gripper.wait()
        assert status.contact is Contact.CLOSING
        assert status.opening == pytest.approx(0.0296, abs=0.0005)


def test_a_thread_may_stop_what_another_waits_for(tmp_path: Path) -> None:
    with serving(tmp_path, width=None) as served, RobotiqGripper(served.path) as gripper:
        gripper.activate()
        gripper.move(0.0, 20.0, 0.02)
        stopping = threading.Timer(0.2, gripper.stop)
        stopping.start()
        assert in_time(gripper.wait) < PATIENCE
        stopping.join()
        assert gripper.status().opening > 0.07


class Listened:
    """A transport that notes which thread writes."""

    def __init__(self, path: str, writers: list[str]) -> None:
        self._port, self._writers = SerialPort(path, 115_200), writers
        self.read, self.close = self._port.read, self._port.close

    def write(self, data: bytes) -> None:
        self._writers.append(threading.current_thread().name)
        self._port.write(data)


def test_a_stop_waits_for_one_transaction_of_others_at_most(tmp_path: Path) -> None:
    """However many threads ask again and again."""
    writers: list[str] = []
    with serving(tmp_path, width=None) as served:
        with RobotiqGripper(lambda: Listened(served.path, writers)) as gripper:
            gripper.activate()
            gripper.move(0.0, 20.0, 0.02)
            ended = threading.Event()

            def poll() -> None:
                while not ended.is_set():
                    gripper.status()

            threads = [threading.Thread(target=poll, name="poll") for _ in range(4)]
            for thread in threads:
                thread.start()
            time.sleep(0.1)
            for _ in range(10):
                before = len(writers)
                gripper.stop()
                main_at = writers.index("MainThread", before)
                assert main_at - before <= 1
                assert (
                    "MainThread" in writers[main_at + 1 : main_at + 3]
                )  # one of the others' at most between its two
            ended.set()
            for thread in threads:
                thread.join()
            assert gripper.status().opening > 0.07


def test_a_stop_ends_what_is_being_tried(tmp_path: Path) -> None:
    """A move on its way through a line that gives no answers is not sent again after a stop."""
    writers: list[str] = []
    settings = ModbusSettings(tries=12)
    with serving(tmp_path, width=None) as served:
        with RobotiqGripper(lambda: Listened(served.path, writers), settings=settings) as gripper:
            gripper.activate()
            gripper.move(0.085, 20.0, 0.02)
            with served.paused():
                served.device.line = LineFaults(drop_answer=1.0)
            raised: list[Exception] = []

            def move() -> None:
                try:
                    gripper.move(0.0, 20.0, 0.02)
                except Exception as error:  # noqa: BLE001
                    raised.append(error)

            moving = threading.Thread(target=move, name="move")
            moving.start()
            while "move" not in writers:
                time.sleep(0.001)
            before = len(writers)
            with pytest.raises(NoAnswerError):
                gripper.stop()
            moving.join()
            assert writers[before:].count("move") <= 1
            assert isinstance(raised[0], StoppedError)


def test_a_stop_breaks_an_activation_off(tmp_path: Path) -> None:
    device = EmulatedGripper(GripperModel(activation_speed=0.02), SpringFingers(0.085))
    with PtyDevice(device, tmp_path / "gripper") as served, RobotiqGripper(served.path) as gripper:
        stopping = threading.Timer(0.3, gripper.stop)
        stopping.start()
        with pytest.raises(StoppedError, match="stopped meanwhile"):
            gripper.activate()
        stopping.join()
        status = gripper.status()
        assert not status.moving and not status.active and 0.06 < status.opening < 0.085
        time.sleep(0.1)
        assert gripper.status().opening == status.opening


def test_port_missing(tmp_path: Path) -> None:
    with pytest.raises(PortMissingError, match="plug the device in"):
        RobotiqGripper(str(tmp_path / "nothing"))


def test_port_busy(tmp_path: Path) -> None:
    with serving(tmp_path) as served, RobotiqGripper(served.path), pytest.raises(PortBusyError):
        RobotiqGripper(served.path)


def test_nobody_there(tmp_path: Path) -> None:
    with serving(tmp_path) as served:
        with served.paused():
            served.device.stall_until = float("inf")

        def opening() -> None:
            with pytest.raises(NoAnswerError, match="is it powered"):
                RobotiqGripper(served.path)

        assert in_time(opening) < PATIENCE


def test_something_else_there(tmp_path: Path) -> None:
    class Chatter(EmulatedGripper):
        def receive(self, data: bytes) -> None:
            self._serial.send(b"$GPGGA,092750.000,5321.6802,N,00630.3372,W*76\r\n", self._now)

    with PtyDevice(Chatter(), tmp_path / "gripper") as served:

        def opening() -> None:
            with pytest.raises(NoAnswerError, match="bytes and no answer"):
                RobotiqGripper(served.path)

        assert in_time(opening) < PATIENCE


def test_unplugged_and_back_under_another_number(tmp_path: Path) -> None:
    with serving(tmp_path) as served, RobotiqGripper(served.path) as gripper:
        gripper.activate()
        gripper.move(0.04, 40.0, 0.15)
        before = os.readlink(served.path)
        served.unplug()
        assert in_time(lambda: pytest.raises((LinkLostError, PortMissingError), gripper.status)) < PATIENCE
        with pytest.raises(PortMissingError):
            gripper.move(0.03, 40.0, 0.1)
        with plugged_elsewhere(served, before):
            assert works(gripper)
            gripper.move(0.05, 40.0, 0.15)
            assert gripper.wait().opening == pytest.approx(0.05, abs=0.0005)


def test_back_without_its_activation(tmp_path: Path) -> None:
    with serving(tmp_path) as served, RobotiqGripper(served.path) as gripper:
        gripper.activate()
        gripper.move(0.04, 40.0, 0.15)
        served.unplug()
        with served.paused():
            served.device.power_cycle()
        served.plug()
        assert works(gripper)
        with pytest.raises(GripperFaultError, match="activate"):
            gripper.move(0.03, 40.0, 0.15)


def test_a_hang_is_told_and_passes(tmp_path: Path) -> None:
    with serving(tmp_path) as served, RobotiqGripper(served.path) as gripper:
        with served.paused():
            served.device.stall_until = served.now + 0.6
        assert in_time(lambda: pytest.raises(NoAnswerError, gripper.status)) < PATIENCE
        assert works(gripper)


@pytest.mark.parametrize("fault", ["corrupt", "drop_byte", "truncate", "merge", "garbage", "duplicate"])
def test_a_bad_line(tmp_path: Path, fault: str) -> None:
    """What is said is right, or a NoAnswerError in time."""
    settings = ModbusSettings(answer_within=0.03, tries=6)
    with serving(tmp_path) as served, RobotiqGripper(served.path, settings=settings) as gripper:
        gripper.activate()
        with served.paused():
            served.device.line = LineFaults(**{fault: 0.3})
        for _ in range(10):
            try:
                assert gripper.status().opening == pytest.approx(0.085)
            except NoAnswerError:
                pass
        with served.paused():
            served.device.line = LineFaults()
        assert works(gripper)


def test_a_port_that_takes_no_bytes() -> None:
    """Nobody reads at the other end: told in time."""
    ends = os.openpty()
    try:
        begun = time.monotonic()
        with pytest.raises(NoAnswerError):
            RobotiqGripper(os.ttyname(ends[1]))
        assert time.monotonic() - begun < PATIENCE
    finally:
        for end in ends:
            os.close(end)


def test_the_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    link = tmp_path / "gripper"
    url = f"robotiq://{link}"
    serve = ["device", "emulate-gripper", "--width", "0.03", "--link", str(link), "--seconds", "3.5"]
    statuses = []
    serving = threading.Thread(
        target=lambda: statuses.append(main([*serve, "--fault", "overheated@2.8", "--json"]))
    )
    serving.start()
    deadline = time.monotonic() + 10
    while not link.is_symlink() and time.monotonic() < deadline:
        time.sleep(0.01)
    time.sleep(0.05)
    assert json.loads(capsys.readouterr().out)["url"] == url
    assert main(["device", "gripper", url, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["active"] is False
    assert main(["device", "gripper", url, "--activate", "--opening", "0", "--speed", "0.15"]) == 0
    assert "active, stopped while closing" in capsys.readouterr().out
    while time.monotonic() < deadline and main(["device", "gripper", url]) == 0:
        time.sleep(0.05)
    assert "let it cool" in capsys.readouterr().out
    serving.join()
    assert statuses == [0]


@pytest.mark.parametrize(
    ("text", "message"), [("overcurent", "overcurrent"), ("corrupt=2", "chance"), ("stall", "number")]
)
def test_a_fault_that_cannot_be_planned(text: str, message: str) -> None:
    with pytest.raises(ThermograspError, match=message):
        plan_gripper_fault(EmulatedGripper(), text)


def test_planned_faults_happen() -> None:
    device = EmulatedGripper()
    for text in ("corrupt=0.5@1", "exception=4@2", "overcurrent@3", "power_cycle@4"):
        plan_gripper_fault(device, text)
    device._write(0x03E8, [0x0100])
    seen = []
    for now in (0.5, 1.5, 2.5, 3.5, 4.5):
        device.advance(now)
        seen.append((device.line.corrupt, device.exception, device.state.fault, device.state.activated))
    assert seen == [
        (0, 0, 0, True),
        (0.5, 0, 9, True),
        (0.5, 4, 9, True),
        (0.5, 4, 14, True),
        (0.5, 4, 0, False),
    ]
