"""Heat of a pair of fingertips in every world of a simulation, advanced in place on its device.

B: worlds, F: fingertips (1 or 2), O: objects, V: materials, S: samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Material, SignalChain, array_fingertips
from thermograsp.thermal.numerics import as_like
from thermograsp.touch.scene import BodyShape, PadPlace

Tensor = Any
_SAME = 1e-9  # m, by which sides of a box may differ and count as equal


class PairHeat:
    """The state of all worlds, of fixed size, and its steps of dt s. Everything is written in place.

    kinds: the objects once for each number that a world's material may be. One or two fingertips are on the object that
    they press hardest, two on opposite faces of its box. An object that they leave is at its first temperature when
    they come back; they keep their own warmth. like: a tensor (B,) whose dtype and device are taken.
    Raises InvalidValueError for fingertips that cannot be, and boxes narrower than the sensor.
    """

    def __init__(
        self,
        pads: Sequence[PadPlace],
        kinds: Sequence[Sequence[BodyShape]],
        *,
        dt: float,
        samples: int,
        tolerance: float,
        ambient: float,
        air: float,
        chain: SignalChain,
        like: Tensor,
    ) -> None:
        _refuse(pads)
        numbers: dict[tuple[Material, tuple[int, ...]], int] = {}
        of: list[Material] = []
        sizes: list[tuple[float, float, float]] = []
        lookup = np.zeros((len(kinds[0]), len(kinds), 3))
        for v, shapes in enumerate(kinds):
            for o, shape in enumerate(shapes):
                for axis, thickness in enumerate(shape.size.tolist()):
                    width, depth = sorted(np.delete(shape.size, axis).tolist())
                    key = shape.material, tuple(round(side / _SAME) for side in (width, depth, thickness))
                    if key not in numbers:
                        numbers[key] = len(of)
                        of.append(shape.material)
                        sizes.append((width, depth, thickness))
                    lookup[o, v, axis] = numbers[key]
        self._tips = array_fingertips(
            of,
            dt=dt,
            like=like,
            object_size=sizes,
            fingertips=2 if len(pads) == 2 else 1,
            sensor=pads[0].stack,
            chain=chain,
            tolerance=tolerance,
            air=air,
            sensor_temperature=pads[0].temperature,
            object_temperature=ambient,
        )
        self._chain = chain
        self._numbers = as_like(lookup, like).long()
        self._axes = as_like(np.array([shape.axes for shape in kinds[0]]), like)
        self._state = self._tips.start(len(like))
        self.drop = 0.0 * self._state.difference
        """(B, F) K over the sensed layers."""
        _, resting, _ = self._tips.step(self._state, self.drop, self._state.which)
        self._resting = float(resting[0, 0])
        self.voltage = (0.0 * self.drop[..., None]).repeat(1, 1, samples) + self._resting
        """(B, F, S) V as the driver reports it, oldest first."""
        self.touching = 0 * self._state.which - 1
        """(B,) the object, -1 for none."""
        self._rows = (0 * self.touching + 1).cumsum(0) - 1

    def advance(
        self,
        conductance: Tensor,
        force: Tensor,
        material: Tensor,
        object_turn: Tensor,
        normal: Tensor,
        noise: Tensor | float,
    ) -> None:
        """A step of dt. conductance (B, F, O) W/K and force (B, F, O) N: means over it. material: (B, O) whole
        numbers. object_turn: (B, O, 3, 3) of the objects' bodies, and normal: (B, F, 3) of the pads, in the world's
        frame. noise: (B, F) standard normal numbers, or 0."""
        pressed = force.sum(1)  # (B, O)
        hardest, which = pressed.max(-1)
        touched = hardest > 0
        rows = self._rows
        turn = (object_turn[rows, which, :, :, None] * self._axes[which, None]).sum(
            -2
        )  # (B, 3, 3) of the box
        looking = (normal[..., None] * turn[:, None]).sum(-2).abs()  # (B, F, 3)
        weight = force[rows, :, which]
        axis = (weight[..., None] * looking).sum(1).argmax(-1)
        found = self._numbers[which, material[rows, which], axis]
        # The same grasp keeps its axis: another one would be a fresh object.
        same = (which == self.touching) | ~touched
        number = found.where(~same, self._state.which)
        own = conductance[rows, :, which]
        state, volts, reading = self._tips.step(self._state, own, number, noise)
        for old, new in zip(_leaves(self._state), _leaves(state), strict=True):
            old.copy_(new)
        self.drop.copy_(reading.drop)
        self.voltage.copy_(self.voltage.roll(-1, -1))
        self.voltage[..., -1] = volts
        self.touching.copy_(which.where(touched, which * 0 - 1))

    def reset(self, worlds: Tensor | slice) -> None:
        """Those worlds at their first temperatures, the electronics at rest."""
        state = self._state
        state.heat[worlds], state.signal.filtered[worlds], state.signal.last[worlds] = 0.0, 0.0, 0.0
        state.which[worlds], self.touching[worlds] = 0, -1
        self.drop[worlds], self.voltage[worlds] = 0.0, self._resting


def _leaves(state: Any) -> tuple[Tensor, ...]:
    return state.heat, state.signal.filtered, state.signal.last, state.which


def _refuse(pads: Sequence[PadPlace]) -> None:
    first = pads[0]
    if len(pads) > 2:
        raise InvalidValueError(
            f"fingertips: at most two share an object here, got {len(pads)}; ThermalTouch takes any"
        )
    for pad in pads:
        if pad.heated is not None or pad.bare or pad.thermostat is not None:
            raise InvalidValueError(
                f"fingertip {pad.label!r}: give a sensor on an ideal thermostat here; ThermalTouch takes others"
            )
        if pad.stack != first.stack or pad.temperature != first.temperature:
            raise InvalidValueError(
                f"fingertips {first.label!r} and {pad.label!r} must have one kind of sensor and one temperature"
            )
