"""One visitor's session: a grasp, its clock and its controls. It knows nothing of the web; time is handed to it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from typing import Any

import numpy as np
from matplotlib.colors import to_hex

from thermograsp.columns import csv_text
from thermograsp.envs import objects
from thermograsp.envs.pictures import temperature_colour
from thermograsp.errors import InvalidValueError, ThermograspError, unknown_name
from thermograsp.studio.control import (
    RANGES,
    SPEEDS,
    Choices,
    Controls,
    Feeling,
    Stock,
    one_of,
)
from thermograsp.studio.session.log import LONGEST, Log
from thermograsp.studio.sources import grasp_of
from thermograsp.thermal import SEED_MATERIALS

MOST_STEPS = 25  # in one advance: a machine that is too slow falls behind instead of no longer answering
_CURVES = ("voltage_left_V", "voltage_right_V", "temperature_drop_left_K", "temperature_drop_right_K",
           "force_left_N", "force_right_N")  # fmt: skip
_TABLE = 64  # colours

Message = dict[str, Any]


class Session:
    """`handle` takes the visitor's messages, `advance` lets time pass, `messages` is what the page is to hear since the
    last call. make: builds the grasp. A choice takes effect in the second `advance` after it, so that the page can be
    told in between that this takes a moment."""

    def __init__(
        self,
        stock: Stock | None = None,
        choices: Choices | None = None,
        make: Callable[[Choices, Stock], Any] = grasp_of,
    ) -> None:
        self._stock = stock or Stock()
        self._make = make
        self.choices = choices or Choices()
        self.controls = Controls()
        self._grasp: Any = None
        self._wanted: Choices | None = self.choices
        self._announced = False
        self._owed = 0.0  # s of the grasp's time
        self._single = self._begin_again = self._download = False  # asked for, once however often
        self._feelings: list[Feeling] = []
        self._workers = ThreadPoolExecutor(1, "identification")
        self._log = Log(1)
        self._sent = 0
        self._waiting: list[Message] = [self._hello()]
        self._last_message = 0

    def handle(self, message: Mapping[str, Any]) -> None:
        """One message: {"do": what, ...}. What cannot be done is told to the page; nothing is raised for it."""
        content = dict(message)
        do, number = content.pop("do", None), content.pop("id", None)
        if isinstance(number, int):
            self._last_message = number
        try:
            if not isinstance(do, str) or do not in _ACTIONS:
                raise unknown_name("action", do, _ACTIONS)
            _ACTIONS[do](self, content)
        except ThermograspError as error:
            self._problem(error)

    def advance(self, seconds: float) -> None:
        """Lets `seconds` of the wall's time pass."""
        if self._wanted is not None:
            if self._announced:
                self._set_up(self._wanted)
            self._announced = not self._announced
            return
        grasp, controls = self._grasp, self.controls
        if grasp is None:
            return
        if self._begin_again:
            self._restart()
        self._owed += seconds * controls.speed if controls.playing else 0.0
        steps = min(math.floor(self._owed / grasp.dt + 1e-9), MOST_STEPS)
        if self._single:
            steps, self._single = 1, False
        if grasp.paced:
            steps = 1  # it waits for the wall's time itself
        try:
            for _ in range(steps):
                if not grasp.running:
                    break
                self._step()
        except ThermograspError as error:
            self.controls = controls.changed({"playing": False})
            self._problem(error)
        self._owed = min(max(self._owed - steps * grasp.dt, 0.0), grasp.dt)

    def messages(self) -> list[Message]:
        """What happened since the last call, a frame last."""
        if self._download:
            self._write_csv()
        try:
            for row, feeling in enumerate(self._feelings):
                found = feeling.look()
                if found is not None:
                    self._waiting.append({"kind": "posterior", "row": row, **found})
        except ThermograspError as error:
            self._feelings = []
            self._problem(error)
        waiting, self._waiting = self._waiting, []
        return [*waiting, self._frame()]

    def close(self) -> None:
        """Releases the grasp."""
        self._release()
        self._workers.shutdown(wait=False, cancel_futures=True)

    def _release(self) -> None:
        for feeling in self._feelings:
            feeling.close()
        self._feelings = []
        if self._grasp is not None:
            self._grasp.close()
            self._grasp = None

    @property
    def paced(self) -> bool:
        """Whether steps take as long as they last, so that they are to be taken whether or not somebody asks."""
        return self._grasp is not None and self._grasp.paced and self._grasp.running

    @property
    def preparing(self) -> bool:
        """Whether a choice is still to take effect."""
        return self._wanted is not None

    @property
    def time(self) -> float:
        """s of the grasp."""
        return 0.0 if self._grasp is None else self._grasp.time

    def _step(self) -> None:
        columns = self._grasp.step(self.controls)
        self._log.add(columns)
        for row, feeling in enumerate(self._feelings):
            feeling.add(columns, row)

    def _set_up(self, wanted: Choices) -> None:
        self._wanted = None
        if self._grasp is not None and self._grasp.paced:
            self._release()  # its ports are needed
        try:
            grasp = self._make(wanted, self._stock)
            try:
                feelings = [
                    Feeling(setup, self._stock.materials, wanted.materials, self._workers)
                    for setup in map(grasp.touch_setup, range(grasp.rows))
                ]
            except BaseException:
                grasp.close()
                raise
        except ThermograspError as error:
            self._problem(error)
            self._waiting.append(
                {"kind": "chosen", "seen": self._last_message, "choices": self.choices.message()}
            )
            return
        self._release()
        self._grasp, self._feelings, self.choices = grasp, feelings, wanted
        self._begin()
        self._waiting.append(self._scene())

    def _begin(self) -> None:
        self._begin_again = False
        self._log = Log(round(LONGEST / self._grasp.dt))
        self._sent, self._owed = 0, 0.0
        for feeling in self._feelings:
            feeling.reset()
        self._waiting.append({"kind": "begin"})

    def _choose(self, content: Mapping[str, Any]) -> None:
        self._wanted = (self._wanted or self.choices).changed(content, self._stock)

    def _control(self, content: Mapping[str, Any]) -> None:
        controls = self.controls.changed(content)
        one_of("driver", controls.driver, self._stock.drivers)
        if self.paced and not (controls.playing and controls.speed == 1.0):
            raise InvalidValueError("time on a real gripper cannot be stopped or slowed down")
        self.controls = controls

    def _again(self, content: Mapping[str, Any]) -> None:
        _nothing(content)
        self._begin_again = True

    def _restart(self) -> None:
        self._begin_again = False
        try:
            self._grasp.reset(self.choices.seed)
        except ThermograspError as error:
            self._problem(error)
        else:
            self._begin()

    def _one_step(self, content: Mapping[str, Any]) -> None:
        _nothing(content)
        self._control({"playing": False})
        self._single = True

    def _csv(self, content: Mapping[str, Any]) -> None:
        _nothing(content)
        self._download = True

    def _write_csv(self) -> None:
        self._download = False
        kept = self._log.since(0)
        if self._grasp is None or not kept:
            self._problem(InvalidValueError("there is nothing to download yet: let the grasp run first"))
            return
        for row, name in enumerate(self._grasp.names):
            text = csv_text({column: values[row] for column, values in kept.items()})
            self._waiting.append({"kind": "csv", "name": f"{name}_{self.choices.mode}.csv", "text": text})

    def _problem(self, error: Exception) -> None:
        self._waiting.append({"kind": "problem", "text": " ".join(str(error).split())})

    def _hello(self) -> Message:
        return {
            "kind": "hello",
            "materials": sorted(self._stock.materials),
            "seed": [name for name in SEED_MATERIALS if name in self._stock.materials],
            "shapes": self._stock.shapes,
            "everyday": list(objects()),
            "drivers": self._stock.drivers,
            "speeds": SPEEDS,
            "ranges": {name: asdict(one) for name, one in RANGES.items()},
            "choices": self.choices.message(),
            "fixed": self._stock.fixed,
            "table": [to_hex(colour) for colour in temperature_colour(np.linspace(0, 1, _TABLE), 0, 1)],
        }

    def _scene(self) -> Message:
        return {
            "kind": "scene",
            "seen": self._last_message,
            "shapes": self._grasp.shapes(),
            "rows": list(self._grasp.names),
            "choices": self.choices.message(),
            "colours": self._grasp.colours,
        }

    def _preparing(self) -> str:
        """What is to be there next; empty where that has come."""
        if self._wanted is None:
            return ""
        return "the grasp" if "material" in self._stock.fixed else " and ".join(self._wanted.names)

    def _frame(self) -> Message:
        frame: Message = {
            "kind": "frame",
            "seen": self._last_message,
            "busy": self._preparing(),
            "controls": self.controls.message(),
        }
        grasp = self._grasp
        if grasp is None:
            return frame
        new = self._log.since(self._sent)
        self._sent = self._log.steps
        curves = {}
        if new:
            curves = {
                "time": _short(new["time_s"][0]),
                "rows": [
                    [_short(new[name][row]) if name in new else None for name in _CURVES]
                    for row in range(grasp.rows)
                ],
            }
        return frame | {
            "time": round(self.time, 6),
            "curves": curves,
            "rows": [grasp.message(row) for row in range(grasp.rows)],
        }


def _nothing(content: Mapping[str, Any]) -> None:
    if content:
        raise unknown_name("field", next(iter(content)), ())


def _short(values: np.ndarray) -> list[float | None]:
    """Seven digits, more than a screen shows; None for what is not finite."""
    return [float(f"{value:.7g}") if math.isfinite(value) else None for value in values.tolist()]


_ACTIONS: Mapping[str, Callable[[Session, Mapping[str, Any]], None]] = {
    "choose": Session._choose,
    "control": Session._control,
    "again": Session._again,
    "step": Session._one_step,
    "csv": Session._csv,
}
