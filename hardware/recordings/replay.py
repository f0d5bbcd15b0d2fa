"""A recording through the decoder of the live driver once more."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from ..drivers import OPENED
from ..protocol import (
    Calibration,
    Code,
    Decoder,
    DecoderCounts,
    Identity,
    Samples,
    Session,
    SessionCounts,
    samples_of,
)
from .recording import EVENT, RECEIVED, SENT, Damage, read_recording


@dataclass(frozen=True, slots=True)
class Replay:
    """A decoded recording. metadata, complete, damage: the recording's. identity: of the device, None if none was
    recorded. calibration: the last one; each sample is calibrated with the one of its time. counts, decoder: what the
    driver counted. drift: of the device's clock against the host's, relative. events: (s on the host's clock, what
    happened)."""

    metadata: Mapping[str, Any]
    complete: bool
    identity: Identity | None
    calibration: Calibration
    samples: Samples
    counts: SessionCounts
    decoder: DecoderCounts
    drift: float
    events: tuple[tuple[float, str], ...]
    damage: tuple[Damage, ...] = ()


def replay(path: str | os.PathLike[str]) -> Replay:
    """Decodes everything that a recording holds. Raises as read_recording does."""
    recording = read_recording(path)
    session = Session(kept=max(1, sum(len(entry.data) for entry in recording.entries)))
    commands = Decoder()
    calibration, parts, events = Calibration(), [], []
    for entry in recording.entries:
        if entry.kind == RECEIVED:
            session.receive(entry.data, entry.time)
        elif entry.kind == SENT:
            for frame in commands.feed(entry.data):
                if frame.code == Code.KEEP_ALIVE:  # not answered
                    continue
                if frame.code == Code.IDENTIFY and frame.sequence not in session.awaited:
                    session.renumber()
                session.awaited = {frame.sequence: None}
        elif entry.kind == EVENT:
            events.append((entry.time, entry.data.decode(errors="replace")))
            if events[-1][1] == OPENED:
                session.reopened(answers=not recording.damage)
        found = session.reports.get(Calibration)
        if found is not None and isinstance(found[1], Calibration) and found[1] != calibration:
            parts.append(_taken(session, calibration))
            calibration = found[1]
    parts.append(_taken(session, calibration))
    identity = session.reports.get(Identity, (0.0, None))[1]
    return Replay(
        metadata=recording.metadata,
        complete=recording.complete,
        identity=identity if isinstance(identity, Identity) else None,
        calibration=calibration,
        samples=_joined(parts),
        counts=session.counts,
        decoder=session.decoder.counts,
        drift=session.clock.drift,
        events=tuple(events),
        damage=recording.damage,
    )


def _taken(session: Session, calibration: Calibration) -> Samples:
    rows = list(session.rows)
    session.rows.clear()
    return samples_of(rows, calibration)


def _joined(parts: list[Samples]) -> Samples:
    names = [field.name for field in fields(Samples)]
    return Samples(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})
