"""`thermograsp bench speed`: environment steps beside bare MuJoCo's, where time goes, memory, start-up."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output


def report(record: Record, output: Output) -> None:
    """Prints shares of bare MuJoCo's speed, the ways to run many environments, scenes of one's own, and what one
    environment costs."""
    parts, modes, lasting = record["parts"], record["modes"], record["endurance"]
    output.line("share of bare mujoco.batch's speed: median (quartiles), by CPU time; parts of a step's time")
    output.table(
        ("environments", "share", "quartiles", "with resets", *parts, "touching", "same bits"),
        [
            (
                str(s["num_envs"]),
                f"{s['ratio']:.3f}",
                "{:.3f} .. {:.3f}".format(*s["quartiles"]),
                f"{s['ratio_with_resets']:.3f}",
                *(f"{100 * s['parts'][name]:.1f} %" for name in parts),
                f"{100 * s['touching']:.0f} %",
                "yes" if s["same"] else "NO",
            )
            for s in record["speeds"]
        ],
    )
    output.line()
    output.table(
        (f"{modes[0]['num_envs']} environments", "speed over native", "same bits"),
        [(m["mode"], f"{m['ratio']:.2f}", "yes" if m["same"] else "NO") for m in modes],
    )
    output.line()
    output.table(
        ("scene", "share of bare", "quartiles", "bare", "same bits"),
        [
            (
                s["scene"],
                f"{s['ratio']:.3f}",
                "{:.3f} .. {:.3f}".format(*s["quartiles"]),
                f"{1e6 * s['bare']:.1f} us for each {s['unit']}",
                "yes" if s["same"] else "NO",
            )
            for s in record["scenes"]
        ],
    )
    output.line()
    output.line(
        f"one episode of {lasting['steps']:,} steps and {lasting['touches']:,} touches: "
        f"the last quarter costs {lasting['growth']:.3f} of the first"
    )
    drawn = record["drawn"]
    output.line(
        f"{drawn['num_envs']} environments, boxes of any size touched anywhere, all else drawn too, "
        f"{drawn['episodes']:,} episodes of {drawn['seconds']:g} s: {drawn['ratio']:.3f} of the speed without "
        + "({:.3f} .. {:.3f}), ".format(*drawn["quartiles"])
        + "longest step {:.1f} ms (without: {:.1f} ms)".format(*(1e3 * each for each in drawn["longest"]))
    )
    output.line(
        f"of the speed of the same draws with heat in the middle of each face: {drawn['heat_ratio']:.3f} "
        + "({:.3f} .. {:.3f})".format(*drawn["heat_quartiles"])
    )
    if len(drawn["memory"]) > 1:
        first, *_, last = (each / 1e6 for each in drawn["memory"])
        output.line(
            f"memory of all after a tenth of these episodes {first:.0f} MB, at their end {last:.0f} MB"
        )
    output.line(f"memory per environment {record['memory']['per_env'] / 1e3:.1f} kB")
    start = record["start_up"]
    output.line(
        f"import gymnasium {1e3 * start['gymnasium']:.0f} ms, thermograsp after it "
        f"{1e3 * start['thermograsp']:.2f} ms; make {start['make']:.2f} s, reset {start['reset']:.3f} s, "
        f"first step {start['step']:.3f} s"
    )
