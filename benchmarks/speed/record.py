"""What `thermograsp bench speed` saves."""

from __future__ import annotations

from dataclasses import asdict

from thermograsp.bench.kinds import Progress, Record
from thermograsp.bench.speed.drawn import compare_drawn
from thermograsp.bench.speed.endurance import endure
from thermograsp.bench.speed.measure import ID, LAYERS, PARTS, measure
from thermograsp.bench.speed.processes import memory, start_up
from thermograsp.bench.speed.scenes import scenes
from thermograsp.bench.speed.vector_modes import compare

_COUNTS, _QUICK_COUNTS = (1, 16, 64, 256, 1024), (1, 4)


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Speeds by number of environments, ways to run them, an endless episode, drawn boxes, scenes of one's own, memory,
    start-up."""
    counts = _QUICK_COUNTS if quick else _COUNTS
    plans = {n: _plan(n, quick) for n in counts}
    speeds = []
    with progress(sum(blocks for blocks, _ in plans.values()) + 20 + 5) as advance:
        # First: beside the memory that the others leave behind, fresh processes start more slowly.
        start = start_up(1 if quick else 5, lambda what: advance(what, 0))
        advance("", 1)
        for n, (blocks, steps) in plans.items():
            doing = f"{n} environments"
            speeds.append(measure(n, blocks, steps, seed, lambda what=doing: advance(what, 1)))
        endurance = endure(1_000 if quick else 100_000, seed, lambda: advance("endurance", 1))
        anywhere = compare_drawn(
            *((4, 40) if quick else (16, 10_000)), seed, lambda part: advance("drawn", part)
        )
        modes = compare(*((2, 2, 10) if quick else (16, 10, 50)), seed, lambda what: advance(what, 0))
        advance("", 1)
        scene_speeds = scenes(quick, seed, advance)
        used = memory((64, 256) if quick else counts, lambda what: advance(what, 0))
        advance("", 1)
    return {
        "id": ID,
        "layers": LAYERS,
        "parts": PARTS,
        "speeds": [{**asdict(s), "ratio_with_resets": s.ratio_with_resets, "parts": s.parts} for s in speeds],
        "drawn": asdict(anywhere),
        "modes": [asdict(mode) for mode in modes],
        "scenes": [asdict(each) for each in scene_speeds],
        "endurance": {**asdict(endurance), "growth": endurance.growth},
        "memory": asdict(used),
        "start_up": {**asdict(start), "to_first_step": start.to_first_step},
    }


def _plan(num_envs: int, quick: bool) -> tuple[int, int]:
    """Blocks, and control steps of each: fewer where there are many environments. One alone takes more of them, since
    the first few after going back to a block's beginning find nothing in the processor's caches."""
    if quick:
        return 2, 10
    for most, plan in ((1, (40, 100)), (16, (40, 25)), (64, (24, 10)), (256, (14, 6))):
        if num_envs <= most:
            return plan
    return 5, 4
