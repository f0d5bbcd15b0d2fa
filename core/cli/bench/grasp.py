"""`thermograsp bench grasp`: what MuJoCo's settings cost, how well they hold an object, and what heat gets from it."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output

_HELD = "held"


def report(record: Record, output: Output) -> None:
    """Prints the worst of four shapes, each shape's fate, and whether what is shipped is on the front."""
    points, shapes, first = record["points"], record["shape_names"], record["metrics_from_s"]
    output.line(
        "cost: CPU time of the mechanics over that of what is shipped "
        f"({1e3 * points[0]['seconds_per_second']:.1f} ms per second)"
    )
    output.line(
        "slip: farthest, against the gripper, while held and shaken. force: RMS, normal, against the 10 N commanded"
    )
    output.line(
        "reference: RMS, normal force, against a run with a time step of "
        f"{1e3 * record['reference']['timestep']:g} ms"
    )
    output.line("jitter: RMS scatter of the contact's centroid within 20 ms, less the reference's")
    output.line(
        f"drop: largest error of the temperature drop from {first['drop']} s after the touch on, median; "
        f"late: from {first['drop_late']} s on"
    )
    columns = ("slip mm", "force N", "reference N", "jitter um", "drop K", "late K")
    output.table(
        ("worst of four shapes", "cost", *columns),
        [(_name(p), f"{p['ratio']:.2f}", *_cells(p["worst"], record["metrics"])) for p in points],
    )
    output.line()
    output.table(
        ("fate; slip, mm, and error of the drop, K", *shapes),
        [(_name(p), *(_fate(p["shapes"][shape]) for shape in shapes)) for p in points],
    )
    output.line()
    beaten_by = points[0]["beaten_by"]
    if beaten_by:
        output.line(f"what is shipped is beaten by {'; '.join(beaten_by)}")
    else:
        output.line("what is shipped is on the front: nothing is better in one column and worse in none")


def _name(point: Record) -> str:
    return f"{point['family']}, {point['label']}"


def _cells(errors: Record, metrics: dict[str, str]) -> list[str]:
    if errors["fate"] != _HELD:
        return [errors["fate"], *[""] * (len(metrics) - 1)]
    return [f"{errors[f'{name}_{unit}']:.4g}" for name, unit in metrics.items()]


def _fate(errors: Record) -> str:
    return (
        f"{errors['slip_mm']:.4f} {errors['drop_K']:.3f}" if errors["fate"] == _HELD else str(errors["fate"])
    )
