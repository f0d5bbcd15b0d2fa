"""What `thermograsp bench episode` saves."""

from __future__ import annotations

from dataclasses import asdict

from thermograsp.bench.episode.measure import MATERIALS, REFERENCE, SHIPPED, measure, settings
from thermograsp.bench.kinds import Progress, Record
from thermograsp.thermal import SIGNAL_CHAINS


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Every setting's speed and error."""
    num_envs, repeats = (4, 1) if quick else (16, 2)
    chosen = settings(quick)
    with progress(1 + repeats * len(chosen)) as advance:
        points = measure(
            chosen,
            num_envs,
            repeats,
            seed,
            lambda s: advance(f"{1e3 * s.timestep:g} ms x {s.substeps}, {s.tolerance:g} K", 1),
        )
    return {
        "environments": num_envs,
        "materials": MATERIALS,
        "reference": asdict(REFERENCE),
        "shipped": asdict(SHIPPED),
        "converter_noise_V": SIGNAL_CHAINS["ads1115"].noise,
        "points": [
            {
                **asdict(p.setting),
                "control_step_s": p.setting.period,
                "seconds_per_second": p.seconds,
                "speed": p.speed,
                "error_V": p.error,
                "relative": p.relative,
                "lost": p.lost,
                "pareto": p.pareto,
                "shipped": p.setting == SHIPPED,
            }
            for p in points
        ],
    }
