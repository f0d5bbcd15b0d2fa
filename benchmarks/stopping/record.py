"""What `thermograsp bench stopping` saves."""

from __future__ import annotations

import numpy as np

from thermograsp.agents.learning import HELD_OUT
from thermograsp.bench.kinds import Progress, Record
from thermograsp.bench.stopping.measure import answers, declared, fitted, fixed, identified, last_decisions
from thermograsp.bench.stopping.touches import setup_known, touched

WINDOWS = (0.1, 0.2, 0.3, 0.5, 1.0, 2.0)  # s of contact
EXAMPLES = 800_000_000
"""Seed of the first episode that the fitted posterior learns from."""
_SECONDS = 2.6  # of an episode: the latest touch, and the longest window


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Right answers by contact time, and where the agent stops. Episodes are the held-out ones, whatever
    the seed."""
    del seed
    episodes = 20 if quick else 500
    with progress(3 * episodes) as advance:
        of_interest = touched(episodes, HELD_OUT, _SECONDS, advance)
        examples = touched(episodes, EXAMPLES, _SECONDS, advance)
        setup = setup_known()
        named = {
            "agent": np.take_along_axis(answers(of_interest), last_decisions(of_interest, WINDOWS), axis=1),
            "identify": identified(of_interest, WINDOWS, setup, advance),
            "fitted": fitted(of_interest, examples, WINDOWS, setup.noise),
        }
    at = last_decisions(of_interest, WINDOWS)
    seconds, right = fixed(of_interest)
    mean, good = declared(of_interest)
    return {
        "episodes": episodes,
        "first_seed": HELD_OUT,
        "examples": episodes,
        "materials": of_interest.materials,
        "windows_s": WINDOWS,
        "contact_s": np.take_along_axis(of_interest.contact, at, axis=1).mean(axis=0),
        "right": {name: (each == of_interest.truth[:, None]).mean(axis=0) for name, each in named.items()},
        "fixed": {"contact_s": seconds, "right": right},
        "declared": {"contact_s": mean, "right": good, "fixed_right": float(np.interp(mean, seconds, right))},
    }
