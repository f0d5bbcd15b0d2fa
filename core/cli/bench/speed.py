"""`thermograsp bench speed`: environment steps beside bare MuJoCo's, where time goes, memory, start-up."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from thermograsp.bench import endurance, processes, speed, vector_modes
from thermograsp.bench.speed_figure import draw_speed
from thermograsp.cli.output import Output

_COUNTS, _QUICK_COUNTS = (1, 16, 64, 256, 1024), (1, 4)


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figure and what goes into the JSON document."""
    counts = _QUICK_COUNTS if args.quick else _COUNTS
    plans = {n: _plan(n, args.quick) for n in counts}
    speeds = []
    with output.progress(sum(blocks for blocks, _ in plans.values()) + 20 + 3) as advance:
        # First: beside the memory that the others leave behind, fresh processes start more slowly.
        start = processes.start_up(1 if args.quick else 5, lambda what: advance(what, 0))
        advance("", 1)
        for n, (blocks, steps) in plans.items():
            doing = f"{n} environments"
            speeds.append(speed.measure(n, blocks, steps, args.seed, lambda what=doing: advance(what, 1)))
        lasting = endurance.endure(
            1_000 if args.quick else 100_000, args.seed, lambda: advance("endurance", 1)
        )
        modes = vector_modes.compare(
            *((2, 2, 10) if args.quick else (16, 10, 50)), args.seed, lambda what: advance(what, 0)
        )
        advance("", 1)
        memory = processes.memory((64, 256) if args.quick else counts, lambda what: advance(what, 0))
        advance("", 1)

    output.line("share of bare mujoco.batch's speed: median (quartiles), by CPU time; parts of a step's time")
    header = ("environments", "share", "quartiles", "with resets", *speed.PARTS, "touching", "same bits")
    output.table(
        header,
        [
            (
                str(s.num_envs),
                f"{s.ratio:.3f}",
                f"{s.quartiles[0]:.3f} .. {s.quartiles[1]:.3f}",
                f"{s.ratio_with_resets:.3f}",
                *(f"{100 * s.parts[name]:.1f} %" for name in speed.PARTS),
                f"{100 * s.touching:.0f} %",
                "yes" if s.same else "NO",
            )
            for s in speeds
        ],
    )
    output.line()
    output.table(
        (f"{modes[0].num_envs} environments", "speed over native", "same bits"),
        [(m.mode, f"{m.ratio:.2f}", "yes" if m.same else "NO") for m in modes],
    )
    output.line()
    output.line(
        f"one episode of {lasting.steps:,} steps and {lasting.touches:,} touches: "
        f"the last quarter costs {lasting.growth:.3f} of the first"
    )
    output.line(f"memory per environment {memory.per_env / 1e3:.1f} kB")
    output.line(
        f"import gymnasium {1e3 * start.gymnasium:.0f} ms, thermograsp after it {1e3 * start.thermograsp:.2f} ms; "
        f"make {start.make:.2f} s, reset {start.reset:.3f} s, first step {start.step:.3f} s"
    )
    files = draw_speed(folder / "speed", speeds, modes, lasting, memory, start, footnote)
    return files, {
        "id": speed.ID,
        "layers": speed.LAYERS,
        "parts": speed.PARTS,
        "speeds": [{**asdict(s), "ratio_with_resets": s.ratio_with_resets, "parts": s.parts} for s in speeds],
        "modes": [asdict(m) for m in modes],
        "endurance": {**asdict(lasting), "growth": lasting.growth},
        "memory": asdict(memory),
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
