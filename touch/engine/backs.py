"""What is behind each element, as numbers that back.c steps: a chain of temperatures, a heater and its controller.

A thermostat is a chain of two, its sensor and its plate; a heated sensor's core is one that networks know already. The
controller of both is one: whatever has none heats with the integral that it starts with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...thermal import Thermostat, settled_thermostat
from ...thermal.readout import thermostat_at
from ...thermal.stack import HeatedStack, heated_core
from ..heat import TipField
from ..scene import PadPlace

_NEVER = 1e300  # N
_KELVIN = 273.15


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """What lies behind one glued element, temperatures in K above the air's. nodes: (N,) at the start, the last one at
    the element. decay: (N, N), and heat: (N,) K/W, over a step. reading: at the start, of node `read`, or -1 for what
    the element's drop leaves. power: W at the start. The controller: setpoint, gains W/K, W/K of a step and W/K of a
    step's change, limit W, and the force N that cuts it. answering: W/K of a step's change. room: W from surroundings
    that are warmer than the air. voltage: V at the start, of the divider: supply V, ratio, K and K."""

    nodes: np.ndarray
    decay: np.ndarray
    heat: np.ndarray
    read: int = -1
    reading: float = 0.0
    power: float = 0.0
    setpoint: float = 0.0
    gains: tuple[float, float, float] = (0.0, 0.0, 0.0)
    limit: float = 0.0
    cut: float = _NEVER
    answering: float = 0.0
    room: float = 0.0
    voltage: float = 0.0
    divider: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)


def chain_of(pad: PadPlace, dt: float, ambient: float) -> Chain:
    """What is behind a pad's element, in steps of dt s in air at `ambient` °C."""
    if pad.thermostat is not None:
        return _plate(
            thermostat_at(pad.temperature, pad.thermostat, None if pad.bare else pad.stack, dt), dt, ambient
        )
    if pad.heated is not None:
        return _core(pad.heated, pad.temperature, dt, ambient)
    return Chain(np.array([pad.temperature - ambient]), np.eye(1), np.zeros(1))


def back_rows(
    pads: Sequence[PadPlace], fields: Sequence[TipField], dt: float, ambient: float
) -> tuple[int, list[np.ndarray]]:
    """N, and of all elements (F, ...) rows: Back of heat.h, what is remembered at the start, decays and heats."""
    chains = [chain_of(pad, dt, ambient) for pad in pads]
    most = max(len(chain.nodes) for chain in chains)
    rows, first, decay, heat = [], [], np.zeros((len(pads), most, most)), np.zeros((len(pads), most))
    for f, (chain, pad, field) in enumerate(zip(chains, pads, fields, strict=True)):
        behind = most - len(chain.nodes)
        decay[f, behind:, behind:], heat[f, behind:] = chain.decay, chain.heat
        read = chain.read + behind if chain.read >= 0 else -1
        capacity = 0.0 if pad.bare else pad.stack.heat_capacity
        unknown = capacity - float(field.tip.side.outputs["element"] @ field.uniform)
        control = chain.setpoint, *chain.gains, chain.limit, chain.cut
        moves = pad.heated is not None or pad.thermostat is not None
        rows.append((moves, *control, chain.answering - unknown / dt, chain.room, read, *chain.divider))
        record = chain.voltage, chain.reading, chain.reading, chain.power, 0.0, 0.0
        first.append((*record, *np.zeros(behind), *chain.nodes))
    return most, [np.array(rows), np.array(first), decay, heat]


def _plate(thermostat: Thermostat, dt: float, ambient: float) -> Chain:
    """thermal/readout/thermostat.py, whose balances are linear but for the controller."""
    begun = settled_thermostat(thermostat, 1)
    loss, lag = thermostat.loss, thermostat.sensor_lag
    lost = -np.expm1(-dt * loss / thermostat.heat_capacity)
    heat = lost / loss if loss else dt / thermostat.heat_capacity
    kept = np.exp(-dt / lag) if lag else 0.0
    late = (lag / dt) * (1 - kept)
    decay = np.array([[kept, (1 - late) * (1 - lost) + late - kept], [0.0, 1 - lost]])
    start = float(begun.temperature[0]) - ambient
    return Chain(
        np.full(2, start),
        decay,
        heat * np.array([1 - late, 1.0]),
        read=0,
        reading=start,
        power=float(begun.power[0]),
        setpoint=thermostat.setpoint - ambient,
        gains=(thermostat.proportional, thermostat.integral * dt, thermostat.derivative / dt),
        limit=thermostat.power_limit,
        room=loss * (thermostat.ambient - ambient),
    )


def _core(sensor: HeatedStack, temperature: float, dt: float, ambient: float) -> Chain:
    """thermal/stack/core.py."""
    core = heated_core(sensor, dt)
    begun, area = core.settled(np.array([temperature]), ambient), core.element.face_area
    divider, zero = sensor.divider, ambient + _KELVIN
    drive = sensor.law.drive(np.zeros((1, 2)), begun.before)
    _, *gains, limit = drive.controller
    power = float(drive.power[0, 0])
    reading = float(begun.reading[0]) - ambient
    ratio = (divider.supply / float(divider.voltage(np.array(ambient))) - 1) * np.exp(-divider.beta / zero)
    return Chain(
        begun.nodes[0] - ambient,
        core.decay,
        core.heat,
        read=-1 if core.readout is None else core.readout,
        reading=reading,
        power=power * area,
        setpoint=reading,
        gains=(gains[0] * area, gains[1] * area * dt, gains[2] * area / dt),
        limit=(limit or power) * area,
        cut=min(drive.ends, _NEVER),
        answering=core.answering / dt,
        voltage=float(divider.voltage(begun.reading)[0]),
        divider=(divider.supply, ratio, divider.beta, zero),
    )
