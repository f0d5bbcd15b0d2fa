"""The serial plant: a real gripper with real fingertips behind the interface of the simulated one.

F = 2 fingertips, S: voltage samples of a control step. There is one environment.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, closing, suppress
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import numpy as np

from thermograsp.errors import InvalidValueError, positive, within
from thermograsp.plant import MAX_OPENING, Command, Reading

from ..drivers import Axis, Fingertips, Gripper, GripperStatus, open_gripper
from ..errors import (
    DeviceError,
    LinkLostError,
    NoAnswerError,
    SensorFaultError,
    StaleSensorError,
    StoppedError,
)
from ..protocol import Flag, Samples
from .arm import Arm
from .asked import Asked
from .config import PaceCounts, SerialConfig
from .limited_axis import LimitedAxis
from .pacing import Pace, RealTime

UNKNOWN = ("material", "temperature_drop", "contact_area", "conductance", "rung")
_STATUS_LEAD = 0.008  # s before the end of a step when the gripper is asked, whose answer takes 4 to 7 ms
OVERRUN = 1e-3  # s by which a step's end must be missed to count; the next step then begins as late
_STOPPED = "fingers and arm were stopped where they are; reset the environment to go on"
_TOLERATED = Flag.SATURATED_LEFT | Flag.SATURATED_RIGHT  # the observation saturates as well
_WARMING = Flag.OFF_SETPOINT_LEFT | Flag.OFF_SETPOINT_RIGHT | _TOLERATED
_SETTLING = 0.2  # s between looks at a thermostat that warms up


class SerialPlant:
    """A plant (thermograsp.plant.Plant) of real fingertips, a real gripper and maybe axes of its arm, which it owns and
    closes.

    A step sends the command, waits for the step's end, and reads. The voltages are the oldest samples not yet read, so
    that they are at most a step and a sample old. What goes wrong in a step or a reset stops the arm, opens the
    gripper and ends the episode: a step's reading has the last values and says why in error. What is held then falls
    from where the lift is. lift: the arm's axis that raises the gripper; it does not leave 0 .. its travel, nor 0 ..
    MAX_HEIGHT. Without one the height is 0 and lift_rate does nothing. lateral: the axis that moves it along the table,
    across the fingers' motion, position 0 in the middle between two objects and positions above 0 on object 1's side;
    it does not leave +- its travel, nor +- LATERAL_REACH. Without one readings have no lateral place and lateral_rate
    does nothing. goals: what Sort-v0 can ask for; see Asked. A gripper of a shorter stroke opens as far as it can.
    truth has `unknown`, names that only a simulation knows or that need such an axis, and `late`, s by which the step's
    end was missed. On close the fingers stay as they are, and the arm stops.
    """

    num_envs = 1

    def __init__(
        self,
        fingertips: Fingertips,
        gripper: Gripper,
        config: SerialConfig | None = None,
        pace: Pace | None = None,
        widest: float | None = None,
        lift: Axis | None = None,
        lateral: Axis | None = None,
        goals: Sequence[str] = (),
    ) -> None:
        self.config = config or SerialConfig()
        self.dt, self.sample_rate = self.config.dt, float(self.config.rate)
        self.counts = PaceCounts()
        self._tips, self._gripper, self._pace = fingertips, gripper, pace or RealTime()
        if widest is None:  # a gripper's class from before there was a stroke may lack it
            stroke = positive("the gripper's stroke (m)", getattr(gripper, "stroke", MAX_OPENING))
            widest = min(stroke, MAX_OPENING)
        self._widest = widest
        self._arm, self._asked = Arm(lift, lateral), Asked(goals)
        self._unknown = (*UNKNOWN, *self._arm.unknown)
        self._queue: deque[tuple[np.ndarray, np.ndarray, np.ndarray]] = deque()
        self._held = (np.zeros(2), np.zeros((2, 3)), np.full(2, np.nan))
        self._opening = 0.0
        self._end = 0.0
        self._trouble = "reset the environment first"
        self._fed = 0.0
        self._armed = False
        self._holding = False  # it was to let go, and has not been told yet
        self._stopped = False  # since the last reset
        self._guarding = threading.Lock()
        self._closing = threading.Event()
        self._closed = False
        self._guard: threading.Thread | None = None
        if self.config.watchdog and isinstance(self._pace, RealTime):
            self._guard = threading.Thread(target=self._watch, name="gripper watchdog", daemon=True)
            self._guard.start()

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Stops the arm, lowers it, opens the gripper, takes it to the middle, and waits for all that and for the
        thermostats. Nothing is drawn: the objects are what lies there. options: see Asked. Raises DeviceError and its
        kinds, InvalidValueError and UnknownNameError for options."""
        del rows, rngs
        self._asked.begin(options)
        try:
            self._prepare()
        except StoppedError as error:
            self._end_episode(str(error))
            raise
        except BaseException as error:
            self._let_go(f"the reset failed: {error}")
            raise
        return self._still()

    def _prepare(self) -> None:
        self._armed = self._holding = self._stopped = False
        with self._guarding:
            self._arm.halt()  # it may be going on at the last step's rates
        self._await(self._heated, self.config.open_within, "the fingertips to answer")
        lowered, centred = self._returned(self._arm.lift), self._returned(self._arm.lateral)
        self._await(lowered, self.config.lower_within, "the lift to go down")
        self._require_unstopped()
        self._gripper.activate()
        self._require_unstopped()
        self._gripper.move(self._widest, 0.0, self.config.speed)
        self._await(lambda: not self._gripper.status().moving, self.config.open_within, "the gripper to open")
        self._await(centred, self.config.centre_within, "the lateral axis to come to its middle")
        self._await(self._settled, self.config.settle_within, "the thermostats to reach their setpoint")
        self._opening = self._gripper.status().opening
        self._take(self._tips.wait(1, self.config.open_within))
        self._held = (self._queue[-1][0], *self._held[1:])
        self._queue.clear()  # the episode's samples are those that follow
        with self._guarding:
            self._require_unstopped()
            self._trouble = ""
        self._end = self._pace.now()

    def step(self, command: Command) -> Reading:
        """One control step."""
        if self._trouble:
            return self._still()
        self._end += self.dt
        try:
            with self._guarding:
                self._require_unstopped()
                self._fed, self._armed = self._pace.now(), True
                self._require_unreleased()
                opening, force = float(command.opening[0]), float(command.force_limit[0])
                self._gripper.move(self._within(opening), force, self.config.speed)
                self._arm.move(command, self._pace.now(), self.dt)
            self._pace.until(self._end - _STATUS_LEAD)
            status = self._checked(self._gripper.status())
            self._arm.read(self._pace.now())
            self._pace.until(self._end)
            self._take(self._tips.take())
            voltage = self._oldest()
        except StoppedError as error:
            self._end_episode(str(error))
            return self._still()
        except DeviceError as error:
            self._let_go(str(error))
            return self._still()
        except Exception as error:
            self._let_go(f"{error!r}: the gripper let go; reset the environment")
            raise
        late = self._late()
        rate = (status.opening - self._opening) / self.dt
        self._opening = status.opening
        return self._reading(voltage, rate, late)

    def stop(self) -> None:
        """Stops arm and fingers where they are, from another thread, before what a step or a reset asks of them, and
        ends the episode: nothing moves them until the next reset. Raises what their own `stop` raises, after all have
        been told."""
        self._stopped = True
        try:
            self._stop_all()
        finally:
            with self._guarding:  # a step may have been about to move them
                self._end_episode(_STOPPED)
                self._stop_all()

    def quantised(self, command: Command) -> Command:
        """What the gripper makes of it, so that a simulation can do the same: opening and force in its steps, and no
        rate of an axis that the arm does not have."""
        wanted = self._within(command.opening)
        opening, force, _ = self._gripper.quantised(wanted, command.force_limit, self.config.speed)
        return self._arm.possible(command._replace(opening=opening, force_limit=force))

    def close(self) -> None:
        """Ends the watchdog, stops the arm and releases all lines. Does nothing the second time."""
        self._closing.set()
        if self._guard is not None:
            self._guard.join()
        if not self._closed:
            self._closed = True
            self._arm.close()
        self._tips.close()
        self._gripper.close()

    def _still(self) -> Reading:
        """The last values, once more."""
        return self._reading(np.tile(self._held[0], (self.config.samples, 1)), 0.0, 0.0)

    def _reading(self, voltage: np.ndarray, rate: float, late: float) -> Reading:
        _, force, thermostat = self._held
        unknown = np.empty(1, object)
        unknown[0] = self._unknown
        return Reading(
            opening=np.array([self._opening]),
            opening_rate=np.array([rate]),
            height=self._arm.height,
            force=force[None].copy(),
            voltage=voltage[None],
            thermostat=thermostat[None].copy(),
            truth={"unknown": unknown, "late": np.array([late]), **self._asked.truth},
            error=(self._trouble,),
            info_names=("unknown", "late", *self._asked.info_names),
            lateral=self._arm.place,
        )

    def _take(self, samples: Samples) -> None:
        samples.require_healthy(but=_TOLERATED)
        self._queue.extend(zip(samples.voltage, samples.force, samples.thermostat, strict=True))
        pressed = float(np.abs(samples.force[:, :, 0]).max(initial=0.0))
        if not pressed <= self.config.most_force:  # nor NaN
            raise SensorFaultError(
                f"a pad is pressed with {pressed:.1f} N, more than most_force, {self.config.most_force:g} N"
            )
        if samples.flags.size:
            self._held = (self._held[0], samples.force[-1], samples.thermostat[-1])

    def _oldest(self) -> np.ndarray:
        """(S, F) V; the queue is kept shorter than another step's."""
        wanted, rows = self.config.samples, []
        while len(self._queue) > 2 * wanted:
            self._queue.popleft()
            self.counts.skipped += 1
        for _ in range(wanted):
            if self._queue:
                self._held = (self._queue.popleft()[0], *self._held[1:])
            else:
                self.counts.repeated += 1
            rows.append(self._held[0])
        return np.array(rows)

    def _late(self) -> float:
        """s; a step that ends late is counted, and the next one has its full time."""
        late = max(0.0, self._pace.now() - self._end)
        self.counts.steps += 1
        self.counts.latest = max(self.counts.latest, late)
        if late > OVERRUN:
            self.counts.overruns += 1
            self._end += late
        return late

    def _checked(self, status: GripperStatus) -> GripperStatus:
        if status.fault or not status.active:
            raise DeviceError(f"gripper: {status.fault or 'not active any more; reset the environment'}")
        return status

    def _settled(self) -> bool:
        samples = self._tips.take()
        samples.require_healthy(but=_WARMING)
        return len(samples) > 0 and not int(samples.flags[-1]) & int(_WARMING & ~_TOLERATED)

    def _returned(self, axis: LimitedAxis) -> Callable[[], bool]:
        """What tells whether that axis is at its position 0, and sends it there."""

        def returned() -> bool:
            with self._guarding:
                self._require_unstopped()
                return axis.returned(self._pace.now(), _SETTLING)

        return returned

    def _heated(self) -> bool:
        try:
            self._tips.set_setpoint(self.config.setpoint, self.config.setpoint)
        except StoppedError as error:  # of the thermostats: not of the fingers
            raise DeviceError(f"fingertips: {error}") from error
        return True

    def _await(self, ready: Callable[[], bool], seconds: float, what: str) -> None:
        """Until it is ready, through a line that is being repaired."""
        deadline, why = self._pace.now() + seconds, ""
        while True:
            try:
                if ready():
                    return
                why = ""
            except (LinkLostError, StaleSensorError, NoAnswerError) as error:
                why = f" ({error})"
            if self._pace.now() > deadline:
                raise DeviceError(
                    f"waited {seconds:g} s in vain for {what}{why}; look at it, then reset again"
                )
            self._pace.until(self._pace.now() + _SETTLING)

    def _require_unstopped(self) -> None:
        if self._stopped:
            raise StoppedError(_STOPPED)

    def _require_unreleased(self) -> None:
        if self._trouble:
            raise DeviceError(self._trouble)

    def _within(self, opening: Any) -> Any:
        """m; a gripper of a shorter stroke than a command may ask for opens as far as it can. Raises InvalidValueError
        for what no command may ask for."""
        within("opening", opening, 0.0, MAX_OPENING, "m")
        return np.minimum(opening, self._widest)

    def _let_go(self, why: str) -> None:
        """Stops the arm and opens the gripper; where they do not hear, the watchdog tells them again and again. What
        was stopped stays as it is."""
        with self._guarding:
            if self._stopped:
                return self._end_episode(_STOPPED)
            self._trouble, self._armed, self._holding = why, False, True
            self._arm.halt()
            self._open()

    def _end_episode(self, why: str) -> None:
        """The fingers stay as they are, and the arm stops."""
        self._trouble, self._armed, self._holding = why, False, False
        self._arm.halt()

    def _stop_all(self) -> None:
        try:
            self._arm.stop()
        finally:
            self._gripper.stop()

    def _open(self) -> None:
        with suppress(Exception):  # of whatever kind: another package's gripper may raise anything
            with suppress(StoppedError):  # what stopped it goes first
                self._gripper.move(self._widest, 0.0, self.config.speed)
            self._holding = False

    def _watch(self) -> None:
        """The watchdog's thread."""
        while not self._closing.wait(self.config.watchdog / 4):
            silent = self._pace.now() - self._fed
            if self._armed and silent > self.config.watchdog:
                self._let_go(f"no step for {silent:.2f} s: the gripper let go; reset the environment")
            elif self._holding or not self._arm.heard:
                with self._guarding:
                    self._arm.halt(again=True)
                    if self._holding:
                        self._open()


_SIMULATED = {
    "taxels": "they are simulated, since a real fingertip has one load cell and no map of pressure",
    "face_temperature": "it is simulated, since a real fingertip has one heat flux sensor and no map of temperature",
}


def without_maps(config: Mapping[str, Any]) -> dict[str, Any]:
    """An environment's keywords for a plant with real fingertips or their twins. Raises InvalidValueError where they
    ask for a map over the pad or the sensor's face."""
    for name, what in _SIMULATED.items():
        if config.get(name) is not None:
            raise InvalidValueError(f"{name}: {what}; leave {name} out")
    return {name: value for name, value in config.items() if name not in _SIMULATED}


def serial_plant(
    url: str,
    num_envs: int,
    lift: Axis | None = None,
    lateral: Axis | None = None,
    goals: Sequence[str] = (),
    **config: Any,
) -> SerialPlant:
    """The plant of "serial:///dev/ttyACM0?gripper=robotiq:///dev/ttyUSB0": the fingertips' port, and the gripper's URL
    as open_gripper takes it. lift, lateral, goals: see SerialPlant. config: SerialConfig's. Raises InvalidValueError
    for anything else, and DeviceError."""
    parts = urlsplit(url)
    options = dict(parse_qsl(parts.query))
    gripper_url = options.pop("gripper", "")
    if parts.netloc or not parts.path or options or not gripper_url:
        raise InvalidValueError(
            f"plant {url!r}: give serial://PORT?gripper=URL, such as robotiq:///dev/ttyUSB0"
        )
    if num_envs != 1:
        raise InvalidValueError(f"a serial plant is one gripper, so num_envs must be 1, got {num_envs}")
    try:
        settings = SerialConfig(**without_maps(config))
    except TypeError as error:
        names = ", ".join((*SerialConfig.__slots__, "lift", "lateral"))
        raise InvalidValueError(f"a serial plant takes {names}: {error}") from error
    with ExitStack() as opened:  # what is open when something is refused is closed again
        gripper = opened.enter_context(closing(open_gripper(gripper_url)))
        tips = opened.enter_context(
            closing(Fingertips(parts.path, rate=settings.rate, setpoint=settings.setpoint))
        )
        plant = SerialPlant(tips, gripper, settings, lift=lift, lateral=lateral, goals=goals)
        opened.pop_all()
    return plant
