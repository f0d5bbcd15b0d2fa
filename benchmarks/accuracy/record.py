"""What `thermograsp bench accuracy` saves."""

from __future__ import annotations

import numpy as np

from thermograsp.bench.accuracy import elements, fipy_press
from thermograsp.bench.accuracy.measure import MATERIALS, RATIO_TO, measure, methods
from thermograsp.bench.kinds import Progress, Record

_QUICK_MATERIALS = ("glass",)


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Every method on every material in both modes."""
    cases = [(name, mode) for mode in "TO" for name in (_QUICK_MATERIALS if quick else MATERIALS)]
    chosen, rng, points = methods(quick), np.random.default_rng(seed), []
    with progress(len(cases)) as advance:
        for case in cases:
            points += measure(case, chosen, rng, lambda doing: advance(doing, 0))
            advance("", 1)
    kept = [p.error <= float(p.setting.split()[0]) for p in points if p.family == "auto"]
    return {
        "reference": "semi_analytic, 3-D, good to 0.0003 K of 12 K",
        "ratio_to": RATIO_TO,
        "installed": {"scikit-fem": elements.available(), "FiPy": fipy_press.available()},
        "auto_kept_tolerance": sum(kept),
        "auto_cases": len(kept),
        "points": [
            {
                "material": p.material,
                "mode": p.mode,
                "method": p.family,
                "setting": p.setting,
                "rung": p.detail,
                "seconds_per_second": p.seconds,
                "preparation_s": p.preparation,
                "ratio": p.ratio,
                "error_K": p.error,
                "pareto": p.pareto,
            }
            for p in points
        ],
    }
