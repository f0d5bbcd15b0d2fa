"""What an emulated pair of fingertips feels: untouched, a press, a recording, or a function of time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thermograsp.errors import InvalidValueError, positive

from ..protocol import Pair, Samples, Triple

if TYPE_CHECKING:
    from ...thermal import Mode

_NO_FORCE = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass(frozen=True, slots=True)
class Feel:
    """What both fingertips feel at one moment, left and right. voltage: V at each Peltier element. heat: W drawn from
    each thermostat. force: N on each pad, normal and two tangential. thermostat: °C of the plates, None if the device's
    own heaters determine them."""

    voltage: Pair = (0.0, 0.0)
    heat: Pair = (0.0, 0.0)
    force: tuple[Triple, Triple] = _NO_FORCE
    thermostat: Pair | None = None


Source = Callable[[float], Feel]
"""Of the time since the emulator's start, s."""


def untouched(time: float) -> Feel:
    """A source that touches nothing."""
    del time
    return Feel()


def press_source(
    material: str,
    *,
    mode: Mode = "T",
    conductance: float = 1e4,
    force: float = 10.0,
    touch: float = 1.0,
    hold: float = 6.0,
    apart: float = 3.0,
    dt: float = 0.01,
    **keywords: Any,
) -> Source:
    """A source in which both fingertips press an object again and again, as thermal.press computes it, each time a
    fresh one.

    conductance: W/(m2 K) while they touch. force: N while they touch. touch, hold, apart: s before the contact, in it,
    and after it, of one period. dt: s between points of the curve, joined by lines. keywords: thermal.press's. The heat
    drawn from the thermostat is taken as what leaves through the opening contact. Raises as thermal.press does.
    """
    from ...thermal import press

    for name, value in (("touch", touch), ("hold", hold), ("apart", apart)):
        positive(f"{name} (s)", value)

    def contact(time: float) -> float:
        return conductance if touch <= time < touch + hold else 0.0

    period = touch + hold + apart
    curve = press(
        material, mode=mode, conductance=contact, opposite=contact, seconds=period, dt=dt, **keywords
    )

    def feel(time: float) -> Feel:
        now = time % period
        volts = float(np.interp(now, curve.t, curve.voltage))
        watts = float(np.interp(now, curve.t, curve.heat_flow))
        newtons = (force if contact(now) else 0.0, 0.0, 0.0)
        return Feel((volts, volts), (watts, watts), (newtons, newtons))

    return feel


def samples_source(samples: Samples) -> Source:
    """A source that repeats recorded samples in a loop, each until the next one is due. Raises InvalidValueError for
    fewer than two."""
    if len(samples) < 2:
        raise InvalidValueError(f"{len(samples)} samples are too few to feel again; record for longer")
    times = samples.time - samples.time[0]
    period = times[-1] + (times[-1] - times[0]) / (len(times) - 1)
    rows = [
        Feel(voltage=(v[0], v[1]), force=(tuple(f[0]), tuple(f[1])), thermostat=(t[0], t[1]))  # pyright: ignore[reportArgumentType]
        for v, t, f in zip(
            samples.voltage.tolist(), samples.thermostat.tolist(), samples.force.tolist(), strict=True
        )
    ]

    def feel(time: float) -> Feel:
        return rows[int(np.searchsorted(times, time % period + 1e-9, side="right")) - 1]

    return feel
