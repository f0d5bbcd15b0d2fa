"""What `thermograsp bench grasp` saves."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np

from thermograsp.bench.grasp.course import FORCE, PERIOD, PHASES, duration
from thermograsp.bench.grasp.errors import FATES, FIRST, LATE, METRICS, Errors
from thermograsp.bench.grasp.measure import SHAPES, measure, placement_count, reference, runs
from thermograsp.bench.kinds import Progress, Record


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Every variant's cost and errors, what is shipped first."""
    with progress(runs(quick)) as advance:
        points = measure(quick, np.random.default_rng(seed), lambda doing: advance(doing, 1))
    return {
        "force_commanded_N": FORCE,
        "seconds": duration(),
        "phases_s": {name: PERIOD * steps for name, steps in PHASES.items()},
        "placements": placement_count(quick),
        "reference": asdict(reference(quick)),
        "metrics": METRICS,
        "metrics_from_s": {"drop": FIRST, "drop_late": LATE},
        "fates": FATES,
        "shape_names": SHAPES,
        "points": [
            {
                "family": p.variant.family,
                "label": p.variant.label,
                "settings": asdict(p.variant.settings),
                "seconds_per_second": p.seconds,
                "ratio": p.ratio,
                "worst": _errors(p.worst),
                "shapes": {shape: _errors(errors) for shape, errors in p.shapes.items()},
                "beaten_by": p.beaten_by,
            }
            for p in points
        ],
    }


def _errors(errors: Errors) -> Record:
    return {
        "fate": errors.fate,
        **{f"{name}_{unit}": getattr(errors, name) for name, unit in METRICS.items()},
    }
