"""The demonstration page's table of numbers, and what was run."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.metadata import PackageNotFoundError, version

import thermograsp
from thermograsp.figures import readable
from thermograsp.reports.demo.runs import FORCE, ModeRun

ABOUT = {
    "T": ("T mode", "The element rides on the warm fingertip and meets the object."),
    "O": ("O mode", "The element is glued to the object and meets the warm fingertip."),
}
"""Mode -> its name, and what sits where."""

_COLUMNS = (
    ("peak", "K", lambda row: f"{row['peak_temperature_drop_K']:.2f}"),
    ("after", "s", lambda row: f"{row['peak_after_touch_s']:.2f}"),
    ("end", "K", lambda row: f"{row['final_temperature_drop_K']:.2f}"),
    ("peak", "mV", lambda row: f"{1e3 * row['peak_voltage_V']:.2f}"),
    ("force", "N", lambda row: f"{row['force_N']:.2f}"),
    ("area", "mm²", lambda row: f"{1e6 * row['contact_area_m2']:.0f}"),
    ("contact", "kW/(m² K)", lambda row: f"{1e-3 * row['conductance_W_m2K']:.1f}"),
)


@dataclass(frozen=True, slots=True)
class Settings:
    """What was asked for. seconds: of each grasp. command: as one would type it."""

    seconds: float
    seed: int
    command: str


def numbers(runs: Sequence[ModeRun], order: Sequence[int]) -> str:
    """A section with one row a material, `order` of rising effusivity turned round."""
    groups, heads = ["<th></th><th></th>"], ["<th>material</th>"]
    heads.append("<th>effusivity<small>W s<sup>½</sup>/(m² K)</small></th>")
    for run in runs:
        groups.append(f'<th class="group first" colspan="{len(_COLUMNS)}">{ABOUT[run.mode][0]}</th>')
        heads += [
            f"<th{_first(k)}>{name}<small>{unit}</small></th>" for k, (name, unit, _) in enumerate(_COLUMNS)
        ]
    rows = []
    for rank in reversed(range(len(order))):
        grasp = runs[0].grasps[order[rank]]
        cells = [f'<td><span class="dot m{rank}"></span>{readable(grasp.recording.material)}</td>']
        cells.append(f"<td>{grasp.effusivity:,.0f}</td>")
        for run in runs:
            row = run.grasps[order[rank]].summary
            cells += [f"<td{_first(k)}>{write(row)}</td>" for k, (_, _, write) in enumerate(_COLUMNS)]
        rows.append(f"<tr>{''.join(cells)}</tr>")
    return (
        '<section><h2>The numbers</h2><p class="note">Of the left fingertip. Voltages are the converter’s, with its '
        "noise; after: from the touch to the peak; force, area and contact conductance at the end.</p>"
        f'<div class="scroll"><table><thead><tr>{"".join(groups)}</tr><tr>{"".join(heads)}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div></section>"
    )


def _first(column: int) -> str:
    return ' class="first strong"' if column == 0 else ""


def details(runs: Sequence[ModeRun], settings: Settings) -> str:
    """A section on what was run: settings, speed, heat models, versions."""
    count, last = sum(len(run.grasps) for run in runs), settings.seed + len(runs[0].grasps) - 1
    items = [
        ("Command", f"<code>{escape(settings.command)}</code>"),
        (
            "Grasps",
            f"{count} of {settings.seconds:g} s each, all of a mode at once; force limit {FORCE:g} N, less where that "
            f"would crush; seeds {settings.seed} to {last}",
        ),
    ]
    for run in runs:
        speed = (
            f"{run.physics_steps_per_s:,.0f} physics steps of 2 ms a second; {100 * run.heat_share:.0f} % of the "
            f"time for heat, {100 * run.mechanics_share:.0f} % for mechanics"
        )
        items.append((f"Speed, {run.mode} mode", speed))
    for run in runs:
        rungs: dict[str, list[str]] = {}
        for grasp in run.grasps:
            rungs.setdefault(grasp.recording.rung, []).append(readable(grasp.recording.material))
        listed = "; ".join(f"<code>{escape(rung)}</code> {', '.join(names)}" for rung, names in rungs.items())
        items.append((f"Heat model, {run.mode} mode", listed))
    items.append(("Versions", escape(", ".join(f"{name} {number}" for name, number in versions().items()))))
    body = "".join(f"<dt>{term}</dt><dd>{text}</dd>" for term, text in items)
    return f"<section><h2>What was run</h2><dl>{body}</dl></section>"


def versions() -> dict[str, str]:
    """The versions of what decides the numbers."""
    found = {"thermograsp": thermograsp.__version__, "Python": platform.python_version()}
    for name in ("mujoco", "gymnasium", "numpy"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "?"
    return found
