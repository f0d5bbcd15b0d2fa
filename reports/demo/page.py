"""The demonstration's page: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
import io
import itertools
from collections.abc import Sequence
from html import escape

import numpy as np
from matplotlib.colors import to_hex
from PIL import Image

from thermograsp.envs.pictures import temperature_colour
from thermograsp.envs.tasks import LIFTED
from thermograsp.figures import Curve, Mark, Press, Touch, chart, face_section, pressure_section, readable
from thermograsp.reports.demo.page_style import style_sheet
from thermograsp.reports.demo.runs import (
    COLOURS,
    FILMED,
    Grasp,
    ModeRun,
)
from thermograsp.reports.demo.tables import (
    ABOUT,
    Settings,
    details,
    numbers,
)

_STILL_WIDTH = 380  # pixels


def demo_page(
    runs: Sequence[ModeRun], pressed: Sequence[Press], touched: Sequence[Touch], settings: Settings
) -> str:
    """The page's HTML."""
    order = np.argsort([grasp.effusivity for grasp in runs[0].grasps], kind="stable").tolist()
    stills = next((run.stills for run in runs if run.stills), ())
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        "<title>thermograsp: ten materials at a fingertip</title>",
        f"<style>{style_sheet(len(order), len(stills))}</style></head><body><main>",
        "<header><h1>What ten materials feel like to a robot’s fingertips</h1>",
        f'<p class="lede">{_lede(runs, order)}</p></header>',
        _charts(runs, order, settings),
        _film(stills, next((run.no_picture for run in runs), "")),
        pressure_section(pressed),
        face_section(touched),
        numbers(runs, order),
        details(runs, settings),
        "</main></body></html>",
    ]
    return "\n".join(parts) + "\n"


def _lede(runs: Sequence[ModeRun], order: list[int]) -> str:
    config = "Fingertips kept at 36 °C close on ten 40 mm cubes at 24 °C, lift them by 5 cm and hold them."
    ordered = [runs[0].grasps[i] for i in order]
    swapped = [
        f"{readable(low.recording.material)} and {readable(high.recording.material)}, "
        f"{100 * (high.effusivity / low.effusivity - 1):.0f} % apart"
        for low, high in itertools.pairwise(ordered)
        if _drop(low)[-1] > _drop(high)[-1]
    ]
    but = f", but for {' and '.join(swapped)}" if swapped else ""
    return (
        f"{config} The temperature drop over each fingertip’s heat flux sensor tells how fast its heat is drawn away: "
        f"in T mode the ten end in the order of their effusivity √(kρc){but}."
    )


def _name(run: ModeRun, i: int) -> str:
    return run.grasps[i].recording.material


def _drop(grasp: Grasp) -> np.ndarray:
    return grasp.recording.columns["temperature_drop_left_K"]


def _charts(runs: Sequence[ModeRun], order: list[int], settings: Settings) -> str:
    top = max(float(_drop(grasp).max()) for run in runs for grasp in run.grasps)
    y_end = 2.0 * np.ceil(top / 2 + 0.05)
    figures = []
    for run in runs:
        curves = [
            Curve(
                readable(_name(run, i)),
                f"m{rank}",
                run.grasps[i].recording.columns["time_s"],
                _drop(run.grasps[i]),
            )
            for rank, i in enumerate(order)
        ]
        name, about = ABOUT[run.mode]
        svg = chart(curves, _marks(run.grasps), settings.seconds, float(y_end), f"Temperature drop in {name}")
        figures.append(
            f'<figure><figcaption><h2>{name}: temperature drop, K</h2><p class="note">{about}</p></figcaption>'
            f"{svg}</figure>"
        )
    return f'<div class="pair">{"".join(figures)}</div>'


def _marks(grasps: Sequence[Grasp]) -> list[Mark]:
    """The touch, the lift's start and its end: medians over the grasps, which differ by a control step or two."""
    touch = [grasp.recording.touch for grasp in grasps]
    marks = [Mark(float(np.nanmedian(touch)), "touch", before=True)] if np.isfinite(touch).any() else []
    for height, label in ((0.001, "lift"), (LIFTED, "held at 5 cm")):
        times = []
        for grasp in grasps:
            columns = grasp.recording.columns
            above = np.flatnonzero(columns["height_m"] >= height)
            if len(above):
                times.append(columns["time_s"][above[0]])
        if times:
            marks.append(Mark(float(np.median(times)), label))
    return marks


def _film(stills: Sequence, no_picture: str) -> str:
    if not stills:
        return (
            f'<section><h2>No pictures</h2><p class="note">{escape(no_picture)}</p></section>'
            if no_picture
            else ""
        )
    low, high = COLOURS
    frames = "".join(_still(still) for still in stills)
    stops = ", ".join(to_hex(color) for color in temperature_colour(np.linspace(low, high, 17), low, high))
    return (
        f"<section><h2>One of the grasps: {readable(FILMED)}, T mode</h2>"
        '<p class="note">Sensor faces and cube are coloured by temperature. Each band runs through both contacts, from '
        "thermostat to thermostat; the figures are the sensor faces’ and the cube’s mean.</p>"
        f'<div class="film">{frames}</div><div class="key"><span>{low:g} °C</span>'
        f'<span class="bar" style="background:linear-gradient(90deg, {stops})"></span><span>{high:g} °C</span></div>'
        "</section>"
    )


def _still(still) -> str:
    low, high = COLOURS
    colors = [to_hex(tuple(temperature_colour(celsius, low, high).tolist())) for celsius in still.across]
    bands = "".join(
        f'<i{" class=wide" if i == len(colors) // 2 else ""} style="background:{color}" title="{celsius:.2f} °C"></i>'
        for i, (color, celsius) in enumerate(zip(colors, still.across, strict=True))
    )
    _, sensor, _, mean, _, right, _ = still.across
    reads = f"<span>{sensor:.1f}</span><span>{mean:.1f}</span><span>{right:.1f} °C</span>"
    return (
        f'<div><img alt="The gripper after {still.time:.1f} s" src="{_picture(still.pixels)}">'
        f'<div class="when">{still.time:.1f} s</div><div class="across">{bands}</div>'
        f'<div class="reads">{reads}</div></div>'
    )


def _picture(pixels: np.ndarray) -> str:
    image = Image.fromarray(np.ascontiguousarray(pixels))
    image = image.resize(
        (_STILL_WIDTH, round(image.height * _STILL_WIDTH / image.width)), Image.Resampling.LANCZOS
    )
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=88, optimize=True)
    return f"data:image/jpeg;base64,{base64.b64encode(buffer.getvalue()).decode()}"
