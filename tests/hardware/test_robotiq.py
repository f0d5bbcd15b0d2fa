"""The client on an emulated gripper in virtual time: every command, every fault, and what it never does."""

import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.hardware import (
    INSTANT,
    CommandRefusedError,
    Contact,
    EmulatedGripper,
    Fault,
    Gripper,
    GripperFaultError,
    GripperModel,
    GripperTimeoutError,
    LineFaults,
    LinkLostError,
    ModbusSettings,
    NoAnswerError,
    RobotiqGripper,
    RobotiqUnits,
    SpringFingers,
    VirtualLine,
    open_gripper,
)

pytest.importorskip("pymodbus")
STEP = 0.085 / 227  # m a count


def on(device: EmulatedGripper, **keywords: object) -> tuple[RobotiqGripper, VirtualLine]:
    line = VirtualLine(device)
    return RobotiqGripper(line.open, clock=line.clock, sleep=line.advance, **keywords), line  # pyright: ignore[reportArgumentType]


def active(width: float | None = None, **keywords: object) -> tuple[RobotiqGripper, VirtualLine]:
    gripper, line = on(EmulatedGripper(fingers=SpringFingers(0.085, width)), **keywords)
    gripper.activate()
    return gripper, line


def test_it_is_a_gripper() -> None:
    gripper: Gripper = active()[0]
    assert gripper.status().active


def test_activation_travels_and_takes_its_time() -> None:
    gripper, line = on(EmulatedGripper())
    assert not gripper.status().active
    begun = line.clock()
    gripper.activate()
    assert line.clock() - begun == pytest.approx(2 * 0.085 / 0.1, abs=0.05)
    status = gripper.status()
    assert status.active and not status.moving and status.fault == ""
    assert status.opening == pytest.approx(0.085)
    before = line.clock()
    gripper.activate()  # it is: nothing moves
    assert line.clock() - before < 0.05


@pytest.mark.parametrize("speed", [0.02, 0.1, 0.15])
def test_a_free_move_takes_distance_over_speed(speed: float) -> None:
    gripper, line = active()
    begun = line.clock()
    assert gripper.move(0.0425, 40.0, speed).moving
    status = gripper.wait()
    assert line.clock() - begun == pytest.approx(0.0425 / speed, abs=0.03)
    assert (status.contact, status.moving) == (Contact.NONE, False)
    assert status.opening == pytest.approx(0.0425, abs=STEP)
    assert status.target == status.opening


def test_a_grasp_stops_at_the_object_and_a_release_leaves_it() -> None:
    gripper, _ = active(width=0.03)
    gripper.move(0.0, 40.0, 0.1)
    status = gripper.wait()
    assert status.contact is Contact.CLOSING
    assert status.opening == pytest.approx(0.03 - 40 / 1e5, abs=STEP)
    assert status.target == 0.0
    gripper.move(0.085, 40.0, 0.1)
    assert gripper.wait().contact is Contact.NONE


def test_a_lost_object_shows() -> None:
    gripper, line = active(width=0.03)
    gripper.move(0.0, 40.0, 0.1)
    gripper.wait()
    line.device.fingers.width = None
    assert gripper.wait().opening == 0.0


def test_stop_stops_and_move_goes_on() -> None:
    gripper, line = active()
    gripper.move(0.0, 40.0, 0.1)
    line.advance(0.2)
    gripper.stop()
    line.advance(0.01)
    where = gripper.status()
    line.advance(0.5)
    assert gripper.status().opening == where.opening > 0.05
    assert not gripper.status().moving
    gripper.move(0.0, 40.0, 0.1)
    assert gripper.wait().opening == 0.0


def test_a_move_sets_it_going_again_after_somebody_stopped_it() -> None:
    gripper, line = active()
    gripper.move(0.06, 40.0, 0.1)
    line.device._write(0x03E8, [0x0100])
    line.advance(0.1)
    gripper.move(0.02, 40.0, 0.1)
    assert gripper.wait().opening == pytest.approx(0.02, abs=STEP)


def test_a_move_whose_answer_was_lost_is_made_up_for() -> None:
    """It may have arrived or not; the next one does not take it for granted."""
    for device_heard in (True, False):
        gripper, line = active()
        if device_heard:
            line.device.line = LineFaults(drop_answer=1.0)
        else:
            line.device.stall_until = line.clock() + 1.0
        with pytest.raises(NoAnswerError):
            gripper.move(0.06, 40.0, 0.1)
        line.device.line = LineFaults()
        line.advance(1.0)
        gripper.wait()
        gripper.move(0.02, 40.0, 0.1)
        assert gripper.wait().opening == pytest.approx(0.02, abs=STEP)


def test_a_move_every_20_ms() -> None:
    """The last of many targets is where it goes; each is read back at once."""
    gripper, line = active()
    for step in range(50):
        begun = line.clock()
        status = gripper.move(0.08 - 0.001 * step, 30.0, 0.15)
        assert status.fault == ""
        assert line.clock() - begun < (0.012 if step else 0.016)  # the first one asks how it is
        line.advance(max(0.0, 0.02 - (line.clock() - begun)))
        line.read(0.0)  # the host's clock goes on with it
    assert gripper.wait().opening == pytest.approx(0.031, abs=STEP)


def test_without_line_time_a_command_takes_none() -> None:
    model = GripperModel(pacing=INSTANT, tick=0.02)
    gripper, line = on(EmulatedGripper(model), settings=ModbusSettings(spacing=0.0, rest=0.0))
    assert line.clock() == 0.0
    gripper.state()
    assert line.clock() == 0.0
    line.advance(0.05)
    gripper.state()
    assert line.clock() == 0.05


def test_counts_are_measured() -> None:
    model = GripperModel(units=RobotiqUnits(open_count=13, closed_count=226))
    gripper, _ = on(EmulatedGripper(model))
    gripper.activate()
    assert gripper.measure_counts() == gripper.units == model.units
    gripper.move(0.0425, 40.0, 0.1)
    assert gripper.wait().opening == pytest.approx(0.0425, abs=0.085 / 213)


def test_a_move_before_activation_is_told_and_nothing_moves() -> None:
    gripper, line = on(EmulatedGripper(fingers=SpringFingers(0.05)))
    with pytest.raises(GripperFaultError, match="call activate"):
        gripper.move(0.0, 40.0, 0.1)
    line.advance(1.0)
    assert line.device.fingers.opening == 0.05


@pytest.mark.parametrize("act", ["move", "stop", "status"])
def test_after_a_loss_of_power_nothing_moves_on_its_own(act: str) -> None:
    gripper, line = active(width=0.03)
    gripper.move(0.0, 40.0, 0.1)
    held = gripper.wait().opening
    line.device.power_cycle()
    if act == "move":
        with pytest.raises(GripperFaultError, match="activate"):
            gripper.move(0.0, 40.0, 0.1)
    else:
        assert not getattr(gripper, act)().active
    line.advance(3.0)
    assert gripper.status().opening == held
    gripper.activate()
    gripper.move(0.0, 40.0, 0.1)
    assert gripper.wait().contact is Contact.CLOSING


@pytest.mark.parametrize(
    "fault", [fault for fault in Fault if fault not in (Fault.NONE, Fault.NO_COMMUNICATION)]
)
def test_every_fault_is_told_and_cleared(fault: Fault) -> None:
    gripper, line = active()
    gripper.move(0.04, 40.0, 0.1)
    line.device.fail(fault)
    assert f"gFLT {fault:#x}" in gripper.status().fault
    with pytest.raises(GripperFaultError, match=f"gFLT {fault:#x}"):
        gripper.move(0.0, 40.0, 0.1)
    gripper.clear_faults()
    gripper.move(0.03, 40.0, 0.1)
    assert gripper.wait().opening == pytest.approx(0.03, abs=STEP)


@pytest.mark.parametrize("fault", [Fault.UNDERVOLTAGE, Fault.INTERNAL, Fault.OVERCURRENT])
def test_a_major_fault_stops_the_fingers(fault: Fault) -> None:
    gripper, line = active()
    gripper.move(0.0, 40.0, 0.1)
    line.advance(0.1)
    line.device.fail(fault)
    where = line.device.fingers.opening
    with pytest.raises(GripperFaultError):
        gripper.wait()
    line.advance(1.0)
    assert line.device.fingers.opening == pytest.approx(where, abs=1e-3)
    assert not gripper.status().active


def test_a_fault_that_stays_is_told_by_what_it_is() -> None:
    gripper, line = active()
    line.device.lasting = Fault.UNDERVOLTAGE
    line.advance(0.01)
    with pytest.raises(GripperFaultError, match="check the 24 V"):
        gripper.clear_faults()


def test_a_fault_during_activation_ends_the_wait() -> None:
    gripper, line = on(EmulatedGripper())
    line.device.lasting = Fault.NONE
    begun = line.clock()

    class Jammed(SpringFingers):
        def move(self, target: float, force: float, speed: float, seconds: float) -> None:
            line.device.fail(Fault.ACTIVATION)

    line.device.fingers = Jammed(0.05)
    with pytest.raises(GripperFaultError, match="free them"):
        gripper.activate()
    assert line.clock() - begun < 1.0


def test_fingers_that_never_arrive() -> None:
    class Slow(SpringFingers):
        def move(self, target: float, force: float, speed: float, seconds: float) -> None:
            super().move(target, force, 1e-6, seconds)

    gripper, line = active()
    line.device.fingers = Slow(0.05)
    gripper.move(0.0, 40.0, 0.1)
    with pytest.raises(GripperTimeoutError, match="end of its motion"):
        gripper.wait(0.5)


def test_an_automatic_release_runs_to_its_end() -> None:
    gripper, line = active(width=0.03)
    gripper.move(0.0, 40.0, 0.1)
    gripper.wait()
    line.device._write(0x03E8, [0x3900])  # rATR and rARD: open
    line.advance(0.1)
    assert line.device.state.fault == Fault.RELEASE_RUNNING
    line.advance(5.0)
    assert line.device.state.fault == Fault.RELEASED
    assert line.device.fingers.opening == pytest.approx(0.085, abs=1e-4)
    assert "released" in gripper.status().fault


def test_a_second_of_silence_is_told_once_and_does_not_stop_it() -> None:
    gripper, line = active()
    gripper.move(0.04, 40.0, 0.1)
    line.advance(1.5)
    assert "heard nothing for 1 s" in gripper.status().fault
    assert gripper.status().fault == ""
    line.advance(1.5)
    assert gripper.move(0.02, 40.0, 0.1).fault != ""  # told, not raised: it has passed
    assert gripper.wait().opening == pytest.approx(0.02, abs=STEP)


@pytest.mark.parametrize("fault", ["corrupt", "drop_byte", "truncate", "drop_frame", "duplicate", "garbage"])
def test_commands_through_a_bad_line(fault: str) -> None:
    """Three of ten answers spoiled: every command is carried out, none tells a wrong state."""
    gripper, line = active(settings=ModbusSettings(tries=8))
    line.device.line = LineFaults(**{fault: 0.3})
    for target in (0.02, 0.07, 0.01, 0.085, 0.04):
        gripper.move(target, 30.0, 0.15)
        status = gripper.wait()
        assert status.opening == pytest.approx(target, abs=STEP)
        assert line.device.fingers.opening == pytest.approx(target, abs=STEP)


def test_late_answers_do_not_pass_for_an_arrival() -> None:
    gripper, line = active()
    line.device.line = LineFaults(answer_delay=0.075)
    for target in (0.02, 0.07, 0.01):
        gripper.move(target, 30.0, 0.15)
        gripper.wait()
        assert line.device.fingers.opening == pytest.approx(target, abs=STEP)


def test_silence_is_told_within_a_second() -> None:
    gripper, line = active()
    line.device.line = LineFaults(drop_answer=1.0)
    begun = line.clock()
    with pytest.raises(NoAnswerError, match="no answer in 5 tries.*powered"):
        gripper.move(0.0, 40.0, 0.1)
    assert line.clock() - begun < 1.0
    line.device.line = LineFaults(corrupt=1.0)
    with pytest.raises(NoAnswerError, match="bytes and no answer among them"):
        gripper.status()


def test_another_slave_is_not_found() -> None:
    with pytest.raises(NoAnswerError, match="at 10 as its address"):
        on(EmulatedGripper(), slave=10)


def test_an_exception_response_is_a_refusal() -> None:
    gripper, line = active()
    line.device.exception = 2
    with pytest.raises(CommandRefusedError, match="Modbus exception 2"):
        gripper.status()


def test_what_it_cannot_do_is_refused_before_it_is_sent() -> None:
    gripper, _ = active()
    for opening, force, speed in ((0.09, 30, 0.1), (-0.01, 30, 0.1), (0.05, 300, 0.1), (0.05, 30, 1.0)):
        with pytest.raises(InvalidValueError):
            gripper.move(opening, force, speed)


def test_closed_it_stays_closed() -> None:
    gripper, _ = active()
    gripper.close()
    gripper.close()
    with pytest.raises(LinkLostError, match="closed"):
        gripper.status()


@pytest.mark.parametrize(
    "url", ["robotiq:", "robotiq://host/dev/x", "robotiq:///dev/x?slave=0", "robotiq:///dev/x?id=3"]
)
def test_urls_that_name_none(url: str) -> None:
    with pytest.raises(InvalidValueError, match="slave=N"):
        open_gripper(url)


def test_an_unknown_scheme() -> None:
    with pytest.raises(UnknownNameError, match="robotiq"):
        open_gripper("robotic:///dev/ttyUSB0")
