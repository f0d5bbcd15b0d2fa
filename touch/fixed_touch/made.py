"""A FixedTouch of pads, objects and their networks.

F: fingertips, O: objects, W: worlds.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import mujoco
import numpy as np

from ...thermal import Material, SignalChain, SignalState
from ...thermal.numerics import Array, as_integers, as_like
from ..contacts import SensorPlaces, array_contacts
from ..heat import FixedNetworks, array_narrow, network_tables
from ..scene import BodyShape, PadPlace
from .record import record_places
from .state import FixedTouchState
from .step import FixedTouch


def fixed_touch(
    model: mujoco.MjModel,
    pads: Sequence[PadPlace],
    shapes: Sequence[BodyShape],
    kinds: Sequence[Sequence[BodyShape]],
    materials: Sequence[Sequence[Material]],
    networks: FixedNetworks,
    *,
    substeps: int,
    ambient: float,
    chain: SignalChain,
    places: SensorPlaces | None,
    worlds: tuple[np.ndarray, np.ndarray],
    now: tuple[np.ndarray, np.ndarray, np.ndarray] | None,
    samples: int,
    like: Array,
) -> FixedTouch:
    """kinds: the objects once for each number of a material. worlds: (W, O) numbers of their materials, and °C at
    first. now: the electronics (F,), (F,) and voltages (F, samples) of the one world whose heat is as in `networks`;
    None for worlds at their first temperatures."""
    tips = tuple(pad.label for pad in pads)
    objects = tuple(shape.name for shape in shapes)
    of = [(o, geom) for o, shape in enumerate(shapes) for geom in shape.geoms]
    begin, at = networks.begin, np.arange(len(networks.state))
    mean = (at == begin[:-1, None]).astype(float)
    states_of = ((at >= begin[:-1, None]) & (at < begin[1:, None])).astype(float)

    def array(values: np.ndarray | Sequence[float]) -> Array:
        return as_like(np.asarray(values, float), like)

    def integers(values: np.ndarray | Sequence[int]) -> Array:
        return as_integers(array(values))

    count = len(worlds[0])
    nothing = np.zeros((count, len(tips)))
    origin = FixedTouchState(
        array(np.tile(networks.state, (count, 1))),
        array(np.tile(networks.narrow_state, (count, 1, 1))),
        SignalState(array(nothing), array(nothing)),
        array(np.zeros((count, len(tips), samples))),
        integers(worlds[0]),
        array(worlds[1]),
    )
    made = FixedTouch(
        networks.dt,
        substeps,
        tips,
        objects,
        tuple(map(tuple, materials)),
        integers([pad.body for pad in pads]),
        integers([geom for _, geom in of]),
        ambient,
        chain,
        origin,
        array([pad.stack.seebeck for pad in pads]),
        array(networks.difference),
        network_tables(networks.rates, networks.ports, networks.drop, networks.dt, like),
        array_narrow(
            networks.narrow,
            networks.ripples,
            networks.narrow_number,
            networks.behind,
            networks.width,
            networks.decay,
            networks.dt,
            networks.modes,
            like,
        ),
        integers(np.arange(len(tips) * len(objects)) * max(map(len, materials))),
        array(networks.held),
        array(mean),
        array(states_of),
        integers([o for o, _ in of]),
        array(np.eye(len(objects))[[o for o, _ in of]]),
        array_contacts(model, pads, kinds, like),
        None if places is None else record_places(places, pads, len(of), like),
    )
    if now is None:
        return replace(made, origin=made.reset(origin))
    filtered, last, voltage = (array(each[None]) for each in now)
    return replace(made, origin=origin._replace(signal=SignalState(filtered, last), voltage=voltage))


def pad_poses(
    model: mujoco.MjModel, data: mujoco.MjData | None, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]
) -> np.ndarray:
    """(F, O, 6): the pads' middles m and the ways they look in the frames of the objects' bodies, in the data's pose or
    the model's first."""
    now = mujoco.MjData(model) if data is None else data
    if data is None:
        mujoco.mj_kinematics(model, now)
    poses = np.zeros((len(pads), len(shapes), 6))
    for f, pad in enumerate(pads):
        turn = now.xmat[pad.body].reshape(3, 3)
        middle, normal = now.xpos[pad.body] + turn @ pad.position, turn @ pad.axes[:, 0]
        for o, shape in enumerate(shapes):
            turn = now.xmat[shape.body].reshape(3, 3)
            poses[f, o] = *((middle - now.xpos[shape.body]) @ turn), *(normal @ turn)
    return poses
