"""What the assumed numbers of the preset `biotac_like` make of its reading: the table of docs/validation.md.

python studies/sensors/fingertip_ranges.py
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from thermograsp.thermal import material
from thermograsp.thermal.stack import (
    ConstantPower,
    HeatedStack,
    Sample,
    Touches,
    heated_stack,
    touch_curves,
)

TIMES = (2.0, 5.0, 10.0)  # s
FORCE = 2.0  # N
WARM, COLD = 35.0, 25.0  # °C
_T = np.arange(0.0, TIMES[-1] + 0.001, 0.02)

Change = Callable[[HeatedStack], HeatedStack]


def main() -> None:
    """Prints a row a case."""
    sensor = heated_stack("biotac_like")
    for name, change in cases().items():
        falls = [value for what in ("aluminium", "wood") for value in falls_of(change(sensor), what)]
        print(f"{name:24s}", " ".join(f"{value:6.2f}" for value in falls))


def cases() -> dict[str, Change]:
    """What is changed, by name: the ends of each assumed range."""
    found: dict[str, Change] = {"as it is": lambda sensor: sensor}
    for index, (name, ends) in enumerate(
        (("core", (0.5e-3, 2e-3)), ("fluid", (0.1e-3, 1.5e-3)), ("skin", (1e-3, 2.5e-3)))
    ):
        for end in ends:
            found[f"{name} {1e3 * end:g} mm"] = lambda sensor, i=index, d=end: _thick(sensor, i, d)
    for field, ends in (("capacity", (3e3, 30e3)), ("loss", (5.0, 40.0))):
        for end in ends:
            found[f"core's {field} {end:g}"] = lambda sensor, f=field, v=end: replace(
                sensor, backing=replace(sensor.backing, **{f: v})
            )
    for end in (200.0, 5000.0):
        found[f"contact {end:g}"] = lambda sensor, v=end: replace(
            sensor, contact=replace(sensor.contact, conductance=v)
        )
    return found


def falls_of(sensor: HeatedStack, name: str) -> list[float]:
    """K at TIMES, and the most K/s, of a touch of a thick block."""
    what, one = material(name), np.ones(1)
    kept = replace(sensor, law=ConstantPower(sensor.backing.loss * (WARM - COLD)))
    touches = Touches(_T, np.full((1, len(_T)), FORCE), WARM * one, 0 * one, COLD * one, COLD * one)
    sample = Sample(what.conductivity, what.volumetric_heat_capacity)
    fall = WARM - touch_curves(kept, [sample], touches).reading[0]
    return [*np.interp(TIMES, _T, fall), float(np.gradient(fall, _T).max())]


def _thick(sensor: HeatedStack, index: int, thickness: float) -> HeatedStack:
    layers = list(sensor.layers)
    layers[index] = replace(layers[index], thickness=thickness)
    return replace(sensor, layers=tuple(layers))


if __name__ == "__main__":
    main()
