"""`thermograsp device replay`: what a recording holds, through the driver's own decoder."""

from __future__ import annotations

import argparse

import numpy as np

from thermograsp.cli.shared import Output, target

HELP = "Decode a recording: report what arrived and what was lost, and write a CSV file."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    parser.add_argument("file", metavar="FILE", help="recording from `thermograsp device record`")
    parser.add_argument("--csv", metavar="FILE", help="write a table with one row per sample, calibrated")


def run(args: argparse.Namespace) -> int:
    """Prints, and writes the CSV. 1 where the recording holds no sample."""
    from thermograsp.columns import write_csv
    from thermograsp.hardware import replay

    csv = target(args.csv, ())
    output, again = Output(args.json), replay(args.file)
    samples, counts = again.samples, again.counts
    seconds = float(np.ptp(samples.time)) if len(samples) else 0.0
    output.line(
        f"{counts.samples} samples in {seconds:.2f} s, {counts.lost} frames lost, {again.decoder.rejected} rejected"
    )
    if not again.complete:
        output.line("the recorder did not finish this file: it was killed, or records still")
    for when, what in again.events:
        output.line(f"  {what} at {when - again.events[0][0]:.2f} s")
    if csv is not None:
        write_csv(csv, samples.columns)
        output.line(f"wrote {csv}")
    output.document(
        {
            "metadata": again.metadata,
            "complete": again.complete,
            "damage": [{"at": damage.at, "bytes": damage.bytes} for damage in again.damage],
            "samples": counts.samples,
            "seconds": seconds,
            "lost": counts.lost,
            "rejected": again.decoder.rejected,
            "duplicates": counts.duplicates,
            "drift_ppm": 1e6 * again.drift,
            "faults": samples.faults.name or "",
            "events": [{"time_s": when, "event": what} for when, what in again.events],
            "csv": args.csv,
        }
    )
    return 0 if len(samples) else 1
