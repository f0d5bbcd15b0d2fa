"""Heat of fingertips in every world of a simulation: touch.FixedTouch, advanced in place on its device.

B: worlds, F: fingertips, O: objects, G: geoms of the objects, H: substeps, K: states of all fields.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mujoco
import numpy as np

from thermograsp.thermal.numerics import as_like
from thermograsp.touch import FixedTouch, FixedTouchReading, FixedTouchState, TouchContacts, rotation
from thermograsp.touch.scene import BodyShape

Tensor = Any


class WorldsHeat:
    """The state of all worlds, of fixed size, and its steps. Everything is written in place.

    fixed: of touch.grasp_touch, in which each material comes once for each way of grasping an object: across which
    sides. A grasp keeps its way. An object that is grasped another way has its mean temperature throughout. like: a
    tensor (B,) whose dtype and device are taken. compiled: torch.compile, or None for steps of single operations."""

    def __init__(
        self,
        model: mujoco.MjModel,
        fixed: FixedTouch,
        shapes: Sequence[BodyShape],
        *,
        ways: int,
        like: Tensor,
        compiled: Callable[..., Any] | None = None,
    ) -> None:
        self._fixed, self._ways = fixed, ways
        self._step = (
            fixed.advance if compiled is None else compiled(fixed.advance, fullgraph=True, dynamic=False)
        )
        self.state: FixedTouchState = _mapped(fixed.start(len(like)), lambda tensor: tensor.clone())
        none = 0.0 * self.state.signal.last
        self.reading = FixedTouchReading(
            self.state.voltage,
            none,
            none.clone(),
            none.clone(),
            none[..., None].repeat(1, 1, len(shapes)),
            (none - 1).long(),
            none[:, :1].repeat(1, len(shapes)),
        )
        """The tensors that every step writes into."""
        of = [(o, geom) for o, shape in enumerate(shapes) for geom in shape.geoms]
        boxes = [rotation(model.geom_quat[geom]).T @ shapes[o].axes for o, geom in of]
        self._boxes = as_like(np.array(boxes), like)  # (G, 3, 3), the box's axes in the geom's frame
        self._of_object = fixed.of_object
        self._uneven = (
            fixed.states_of - fixed.mean
        )  # (O, K), 1 at the states of an object beside its mean temperature's
        self._held = self.state.material < 0
        self._way = 0 * self.state.material

    def advance(self, contacts: TouchContacts, material: Tensor, noise: Tensor | float) -> None:
        """A step of fixed.dt. material: (B, O) integers. noise: (B, F) standard normal numbers, or 0."""
        state = self.state
        if self._ways > 1:
            heat, way = self._grasped(contacts)
            state = state._replace(heat=heat, material=material * self._ways + way)
        else:
            state = state._replace(material=material)
        state, reading = self._step(state, contacts, noise)
        _write(self.state, state)
        for old, new in zip(self.reading[1:], reading[1:], strict=True):
            old.copy_(new)

    def tensors(self) -> tuple[Tensor, ...]:
        """All that a step writes."""
        return *_leaves(self.state), *self.reading[1:], self._held, self._way

    def reset(self, worlds: Tensor | slice) -> None:
        """Puts those worlds at their first temperatures, with the electronics at rest."""
        chosen = self._held[:, 0] & False
        chosen[worlds] = True
        _write(self.state, self._fixed.reset(self.state, chosen))
        self._held[worlds] = False
        for field in self.reading[1:]:
            field[worlds] = 0
        self.reading.touching[worlds] = -1
        self.reading.object_temperature[worlds] = self._fixed.ambient

    def _grasped(self, contacts: TouchContacts) -> tuple[Tensor, Tensor]:
        """Heat (B, K) and the way (B, O) in which each object is grasped: across the sides that its forces look along
        when it is first touched."""
        force = contacts.force.sum(4).sum(1)  # (B, F, G, 3)
        turn = (contacts.geom_turn[:, -1, :, :, :, None] * self._boxes[:, None]).sum(-2)  # (B, G, 3, 3)
        along = (turn[:, None] * force[..., None]).sum(-2).abs().sum(1)  # (B, G, 3)
        load = (along[:, :, None] * self._of_object[..., None]).sum(1)  # (B, O, 3)
        touched = load.sum(-1) > 0
        way = load.argmax(-1).where(touched & ~self._held, self._way)
        other = (way != self._way).to(load.dtype)
        self._held.copy_(touched)
        self._way.copy_(way)
        return self.state.heat * (1 - (other[..., None] * self._uneven).sum(1)), way


def _mapped(state: FixedTouchState, copy: Any) -> FixedTouchState:
    """The state with each of its tensors copied by that function."""
    heat, narrow, signal, voltage, material, first = state
    return FixedTouchState(
        copy(heat), copy(narrow), type(signal)(*map(copy, signal)), copy(voltage), copy(material), copy(first)
    )


def _write(state: FixedTouchState, after: FixedTouchState) -> None:
    for old, new in zip(_leaves(state), _leaves(after), strict=True):
        old.copy_(new)


def _leaves(state: FixedTouchState) -> tuple[Tensor, ...]:
    return state.heat, state.narrow, *state.signal, state.voltage, state.material, state.first
