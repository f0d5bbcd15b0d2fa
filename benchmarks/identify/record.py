"""What `thermograsp bench identify` saves."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np

from thermograsp.bench.identify.measure import (
    COVER_STAGES,
    ELEVEN,
    ELEVEN_WINDOWS,
    PUBLISHED,
    STEADY,
    Accuracies,
    compare,
    cover,
    stages,
)
from thermograsp.bench.identify.touches import SETUP, WINDOWS
from thermograsp.bench.kinds import Progress, Record
from thermograsp.thermal import SEED_MATERIALS

_FEW = ("plastic", "rubber", "glass", "aluminium")


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Every method's share of right answers, the confusions, and how often intervals hold the object."""
    tests, examples, objects = (80, 120, 60) if quick else (2000, 3000, 2000)
    materials, everyday = (_FEW, _FEW) if quick else (SEED_MATERIALS, ELEVEN)
    setups = {"unknown": SETUP, "steady": STEADY}
    rng = np.random.default_rng(seed)
    total = stages(WINDOWS) + len(setups) * stages(ELEVEN_WINDOWS, net=False) + COVER_STAGES
    with progress(total) as advance:
        begun = 0

        def doing(what: str) -> None:
            nonlocal begun
            advance(what, 1 if begun else 0)  # what began before is done
            begun += 1

        ten, missing = compare(rng, SETUP, materials, WINDOWS, tests, examples, doing)
        eleven = {
            name: compare(rng, setup, everyday, ELEVEN_WINDOWS, tests // 2, examples, doing, net=False)[0]
            for name, setup in setups.items()
        }
        coverage = cover(rng, objects, doing)
        advance("done", 1)
    return {
        "left_out": missing,
        "materials": materials,
        "touches": tests,
        "examples": examples,
        "windows_s": ten.windows,
        "right": ten.share,
        "agreement_with_limit": [_agreement(ten, window) for window in ten.windows],
        "cpu_median_s": [float(np.median(ten.found[window].seconds)) for window in ten.windows],
        "cpu_99_s": [float(np.quantile(ten.found[window].seconds, 0.99)) for window in ten.windows],
        "confusion": {f"{window:g}": ten.confusion(window) for window in ten.windows},
        "eleven": {
            "materials": everyday,
            "touches": tests // 2,
            "windows_s": ELEVEN_WINDOWS,
            "conductance_W_m2K": {name: setup.conductance for name, setup in setups.items()},
            "right": {name: found.share for name, found in eleven.items()},
        },
        "published": PUBLISHED,
        "coverage": [asdict(each) for each in coverage],
    }


def _agreement(found: Accuracies, window: float) -> float:
    """Share of touches where identifier and brute force name the same material."""
    same = found.found[window].probability.argmax(axis=1) == found.limit[window].argmax(axis=1)
    return float(np.mean(same))
