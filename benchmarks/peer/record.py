"""What `thermograsp bench peer` saves."""

from __future__ import annotations

from dataclasses import asdict

from thermograsp.bench.kinds import Progress, Record
from thermograsp.bench.peer.measure import (
    COLD,
    PEER_FIRST_MILLIMETRE,
    PEER_HEAT,
    PUBLISHED_BY,
    TIMES,
    WARM,
    touches,
)


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Every plate: nothing is random, and there is no coarser run."""
    del quick, seed, progress
    return {
        "published_by": PUBLISHED_BY,
        "times_s": TIMES,
        "tip_C": WARM,
        "plate_C": COLD,
        "plates": [asdict(touch) for touch in touches()],
        "peer_first_millimetre": PEER_FIRST_MILLIMETRE,
        "peer_heat_J_per_m2": PEER_HEAT,
    }
