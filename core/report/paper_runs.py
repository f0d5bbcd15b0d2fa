"""What the paper simulated and measured, computed: ten materials, two modes, smooth and rough faces.

The geometry and temperatures are the paper's (section 3.1): element 9 x 9 x 3 mm, object 40 x 40 x 10 mm, thermostat
36 °C, object 24 °C. It gives no properties of materials, no contact pressure and no roughness; the materials are the
package's, the element is the preset "seed", and the contacts are those below.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from thermograsp import thermal
from thermograsp.thermal.conductance import typical_slope
from thermograsp.thermal.grid_axisymmetric import grid
from thermograsp.thermal.grid_contact import OBJECT, SENSOR
from thermograsp.thermal.grid_press import March
from thermograsp.thermal.problem import Mode

MATERIALS = thermal.SEED_MATERIALS
"""The paper's ten, in its order: rising effusivity."""
MODES: tuple[Mode, Mode] = ("O", "T")
SENSOR_TEMPERATURE, OBJECT_TEMPERATURE = 36.0, 24.0
SECONDS = 20.0
SECTION_TIME = 4.0
OBJECT_SIZE = (0.04, 0.04, 0.01)
SMOOTH = 1e4
"""W/(m2 K), a contact as good as that of polished faces with air between."""
ROUGHNESS = 5e-6
"""m rms, of a sawn or milled face; cloth is coarser by itself."""
PRESSURE = 1e4
"""Pa, 0.8 N on the element's face."""


@dataclass(frozen=True, slots=True)
class Effort:
    """tolerance: K of temperature drop. dt: s between samples. resolution: of the axisymmetric grid."""

    tolerance: float
    dt: float
    resolution: int


FULL = Effort(tolerance=0.002, dt=0.02, resolution=2)
QUICK = Effort(tolerance=0.005, dt=0.02, resolution=1)


@dataclass(frozen=True, slots=True)
class Sweep:
    """The ten materials in one mode. conductance: (10,) W/(m2 K). t: (n,) s. drop: (10, n) K. sensor_surface,
    object_surface: (10, n) °C, the two sides of the opening contact. rungs: the model that made each curve."""

    mode: Mode
    conductance: np.ndarray
    t: np.ndarray
    drop: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    rungs: tuple[str, ...]


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
    """smooth, rough: by mode. sections: by mode, in the order of MATERIALS, at SECTION_TIME. effort: how finely all was
    computed."""

    smooth: dict[str, Sweep]
    rough: dict[str, Sweep]
    sections: dict[str, tuple[Section, ...]]
    effort: Effort


Task = tuple[str, Callable[[], object]]


def run_paper(effort: Effort, progress: Callable[[list[Task]], Iterator[Task]] = iter) -> PaperRuns:
    """All curves and sections. progress: passes the named tasks on, one by one, as they are done."""
    results: dict[str, object] = {}
    tasks: list[Task] = []
    for mode in MODES:
        tasks.append(
            (f"smooth {mode}", lambda mode=mode: sweep(mode, np.full(len(MATERIALS), SMOOTH), effort))
        )
        tasks.append((f"rough {mode}", lambda mode=mode: sweep(mode, rough_conductances(mode), effort)))
        tasks.append(
            (f"section {mode}", lambda mode=mode: tuple(section(m, mode, effort) for m in MATERIALS))
        )
    for name, task in progress(tasks):
        results[name] = task()
    pick = lambda kind: {mode: results[f"{kind} {mode}"] for mode in MODES}  # noqa: E731
    return PaperRuns(pick("smooth"), pick("rough"), pick("section"), effort)  # pyright: ignore[reportArgumentType]


def sweep(mode: Mode, conductance: np.ndarray, effort: Effort) -> Sweep:
    """The ten curves of one figure's panel."""
    presses = [
        thermal.press(
            name,
            mode=mode,
            conductance=float(h),
            object_size=OBJECT_SIZE,
            sensor_temperature=SENSOR_TEMPERATURE,
            object_temperature=OBJECT_TEMPERATURE,
            seconds=SECONDS,
            dt=effort.dt,
            tolerance=effort.tolerance,
        )
        for name, h in zip(MATERIALS, conductance, strict=True)
    ]
    return Sweep(
        mode,
        conductance,
        presses[0].t,
        np.array([p.temperature_drop for p in presses]),
        np.array([p.sensor_surface for p in presses]),
        np.array([p.object_surface for p in presses]),
        tuple(str(p.rung) for p in presses),
    )


def rough_conductances(mode: Mode) -> np.ndarray:
    """(10,) W/(m2 K) of ROUGHNESS at PRESSURE by the contact laws. T mode: the lapped face on each material. O mode:
    the contact that opens is thermostat on element, aluminium as rough on the same face whatever the object."""
    return np.array([_rough(name if mode == "T" else "aluminium") for name in MATERIALS])


def _rough(name: str) -> float:
    face = thermal.Surface.of(thermal.material(name))
    roughness = max(face.roughness, ROUGHNESS)
    face = replace(face, roughness=roughness, slope=typical_slope(roughness))
    return float(thermal.contact_conductance(thermal.joint(thermal.LAPPED_ALUMINA, face), PRESSURE))


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
