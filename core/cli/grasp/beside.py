"""`thermograsp grasp --plant serial:...`: a real grasp, and the same one in simulation beside it."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, target
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.envs import GraspBatch
    from thermograsp.twin import Beside


def run_beside(args: argparse.Namespace, simulated: GraspBatch) -> int:
    """Grasps on the plant of the arguments, simulates, writes and prints. 1 where the grasp ended before its time, or
    the object was not held for --hold seconds at its end. There is no lift: holding is what can be judged."""
    from thermograsp.columns import write_csv
    from thermograsp.envs import GraspBatch, GraspTask
    from thermograsp.twin import grasp_beside

    if not args.plant.startswith("serial:"):
        raise InvalidValueError(
            f"--plant takes serial://PORT?gripper=URL, got {args.plant!r}; see docs/hardware.md"
        )
    if args.render is not None:
        raise InvalidValueError("--render draws a simulation; with --plant use --plot")
    csv, plot = target(args.csv, ()), target(args.plot, (".svg", ".png", ".pdf"))
    output = Output(args.json)
    real = GraspBatch(1, plant=args.plant, task=GraspTask(hold_seconds=args.hold, seconds=args.seconds))
    try:
        with output.progress(args.seconds) as advance:
            grasp = grasp_beside(
                real,
                simulated,
                args.seconds,
                args.force,
                args.seed,
                watch=lambda time: advance("grasping", real.dt),
            )
    finally:
        real.close()
        simulated.close()
    if csv is not None:
        write_csv(csv, grasp.columns)
    if plot is not None:
        from thermograsp.figures import plot_beside

        plot_beside(plot, grasp.columns, f"{args.material}, {args.mode} mode")
    held = not grasp.error and grasp.held >= args.hold
    _print(output, args, grasp, held)
    return 0 if held else 1


def _print(output: Output, args: argparse.Namespace, grasp: Beside, held: bool) -> None:
    counts = grasp.counts
    output.line(
        f"{grasp.error or ('held' if held else 'not held')}: both pads pressed for the last {grasp.held:.2f} s"
    )
    output.line(
        f"{counts.steps} steps, {counts.overruns} late, {1e3 * counts.latest:.1f} ms at most; "
        f"{counts.repeated} samples repeated, {counts.skipped} skipped"
    )
    document: dict[str, Any] = {
        "plant": args.plant,
        "material": args.material,
        "mode": args.mode,
        "held": held,
        "held_s": grasp.held,
        "error": grasp.error,
        "steps": counts.steps,
        "overruns": counts.overruns,
        "latest_s": counts.latest,
        "repeated": counts.repeated,
        "skipped": counts.skipped,
        "delay_s": grasp.delay,
        "difference_V": grasp.difference,
        "csv": args.csv,
        "plot": args.plot,
    }
    if grasp.delay == grasp.delay:
        output.line(
            f"voltage {1e3 * grasp.delay:.0f} ms behind the simulation, "
            f"{1e3 * grasp.difference:.3f} mV rms off it after that"
        )
    else:
        output.line("no voltage that could be set against the simulation")
    for file in (args.csv, args.plot):
        if file:
            output.line(f"wrote {file}")
    output.document(document)
