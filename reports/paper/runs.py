"""What the paper simulated and measured, computed: ten materials, two modes, smooth and rough faces, sections."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermograsp import thermal
from thermograsp.reports.paper.bands import Bands, draw_bands, draw_rigs
from thermograsp.reports.paper.sweeps import (
    MATERIALS,
    MODES,
    OBJECT_SIZE,
    OBJECT_TEMPERATURE,
    SENSOR_TEMPERATURE,
    SMOOTH,
    Effort,
    Sweep,
    rough_conductances,
    sweep,
)
from thermograsp.thermal.matter import Mode
from thermograsp.thermal.numerics import OBJECT, SENSOR
from thermograsp.thermal.rungs import March, grid

SECTION_TIME = 4.0  # s


@dataclass(frozen=True, slots=True)
class Half:
    """Half a section through one body. radius: (i + 1,) and depth: (d + 1,) m, edges of the cells; depth grows from the
    thermostat. temperature: (d, i) °C."""

    radius: np.ndarray
    depth: np.ndarray
    temperature: np.ndarray

    @property
    def levels(self) -> np.ndarray:
        """(d,) °C, means over the element's cross-section at each depth."""
        rim = self.radius[1:] <= np.sqrt(thermal.sensor("seed").face_area / np.pi) * (1 + 1e-9)
        area = np.diff(self.radius**2)[rim]
        return self.temperature[:, rim] @ area / area.sum()


@dataclass(frozen=True, slots=True)
class Section:
    """Temperatures at one moment in element and object. back_rise: K at the middle of the object's far face."""

    element: Half
    body: Half
    back_rise: float

    @property
    def share_in_object(self) -> float:
        """Part of the whole temperature difference that lies in the object, means over the element's cross-section.

        In the element and in the contact lies the rest."""
        face = float(self.body.levels[0])
        return (face - OBJECT_TEMPERATURE) / (SENSOR_TEMPERATURE - OBJECT_TEMPERATURE)

    @property
    def share_in_element(self) -> float:
        """Part that lies between the element's two ends."""
        top, *_, bottom = self.element.levels
        return float(top - bottom) / (SENSOR_TEMPERATURE - OBJECT_TEMPERATURE)


@dataclass(frozen=True, slots=True)
class PaperRuns:
    """All computations of the paper's experiment. smooth, rough: by mode. sections: by mode, in the order of MATERIALS,
    at SECTION_TIME. bands: `rough` on other rigs. effort: how finely all was computed."""

    smooth: Mapping[str, Sweep]
    rough: Mapping[str, Sweep]
    sections: Mapping[str, tuple[Section, ...]]
    bands: Bands
    effort: Effort

    def on_rigs(self) -> list[PaperRuns]:
        """The same with the experiment on each rig of the bands in place of the assumed one."""
        return [replace(self, rough=by_mode) for by_mode in self.bands.sweeps]


Task = tuple[str, Callable[[], object]]


def run_paper(effort: Effort, progress: Callable[[list[Task]], Iterator[Task]] = iter) -> PaperRuns:
    """All curves and sections. progress: passes the named tasks on, one by one, as they are done."""
    results: dict[str, object] = {}
    tasks: list[Task] = []
    rigs = draw_rigs(effort.rigs)
    for mode in MODES:
        tasks.append(
            (f"smooth {mode}", lambda mode=mode: sweep(mode, np.full(len(MATERIALS), SMOOTH), effort))
        )
        tasks.append((f"rough {mode}", lambda mode=mode: sweep(mode, rough_conductances(mode), effort)))
        tasks.append((f"rigs {mode}", lambda mode=mode: draw_bands(rigs, mode, effort)))
        tasks.append(
            (f"section {mode}", lambda mode=mode: tuple(section(m, mode, effort) for m in MATERIALS))
        )
    for name, task in progress(tasks):
        results[name] = task()
    pick = lambda kind: {mode: results[f"{kind} {mode}"] for mode in MODES}  # noqa: E731
    drawn = pick("rigs")
    bands = Bands(rigs, tuple({mode: drawn[mode][k] for mode in MODES} for k in range(len(rigs))))  # pyright: ignore[reportIndexIssue]
    return PaperRuns(pick("smooth"), pick("rough"), pick("section"), bands, effort)  # pyright: ignore[reportArgumentType]


def section(name: str, mode: Mode, effort: Effort) -> Section:
    """Temperatures at SECTION_TIME on the axisymmetric grid (square faces are discs of equal area)."""
    stack = thermal.sensor("seed")
    problem = thermal.PressProblem(
        stack=stack,
        material=thermal.material(name),
        mode=mode,
        conductance=SMOOTH,
        area=stack.face_area,
        shape="square",
        object_size=OBJECT_SIZE,
        air=0.0,
        sensor_temperature=SENSOR_TEMPERATURE,
        object_temperature=OBJECT_TEMPERATURE,
    )
    march = March(grid(problem, effort.resolution), lambda _: SMOOTH)
    while march.time < SECTION_TIME * (1 - 1e-9):
        march.advance(min(max(0.1 * march.time, 1e-4), SECTION_TIME - march.time))
    halves = [
        Half(
            np.concatenate(([0.0], np.sqrt(np.cumsum(body.first.volumes) / np.pi))),
            body.edges + (stack.thickness if which == OBJECT else 0.0),
            march.state[which][:, :, 0] + OBJECT_TEMPERATURE,
        )
        for which, body in ((SENSOR, march.grid.bodies[SENSOR]), (OBJECT, march.grid.bodies[OBJECT]))
    ]
    return Section(*halves, back_rise=float(march.state[OBJECT][-1, 0, 0]))
