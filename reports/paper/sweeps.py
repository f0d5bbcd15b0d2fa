"""The paper's ten curves of one panel, smooth or on a rig: what its figures 5 and 6 are made of.

The geometry and temperatures are the paper's (section 3.1): element 9 x 9 x 3 mm, object 40 x 40 x 10 mm, thermostat
36 °C, object 24 °C. It gives no properties of materials, no contact pressure and no roughness; the materials are the
package's, the element is the preset "seed", and the contacts are those below.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from thermograsp import thermal
from thermograsp.thermal.contact import typical_slope
from thermograsp.thermal.matter import Mode

MATERIALS = thermal.SEED_MATERIALS
"""The paper's ten, in its order: rising effusivity."""
MODES: tuple[Mode, Mode] = ("O", "T")
SENSOR_TEMPERATURE, OBJECT_TEMPERATURE = 36.0, 24.0
SECONDS = 20.0
OBJECT_SIZE = (0.04, 0.04, 0.01)
SMOOTH = 1e4
"""W/(m2 K), a contact as good as that of polished faces with air between."""
ROUGHNESS = 5e-6
"""m rms, of a sawn or milled face; cloth is coarser by itself."""
PRESSURE = 1e4
"""Pa, 0.8 N on the element's face."""


@dataclass(frozen=True, slots=True)
class Effort:
    """How finely the experiment is computed. tolerance: K of temperature drop. dt: s between samples. resolution: of
    the axisymmetric grid. rigs: how many are drawn."""

    tolerance: float
    dt: float
    resolution: int
    rigs: int


FULL = Effort(tolerance=0.002, dt=0.02, resolution=2, rigs=100)
QUICK = Effort(tolerance=0.005, dt=0.02, resolution=1, rigs=40)


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
class Rig:
    """What the paper does not say of its experiment. roughness: m rms. pressure: Pa. thermostat, room: °C, the objects'
    too. air: W/(m2 K) on the objects' free faces."""

    roughness: float = ROUGHNESS
    pressure: float = PRESSURE
    thermostat: float = SENSOR_TEMPERATURE
    room: float = OBJECT_TEMPERATURE
    air: float = 0.0


ASSUMED = Rig()
"""The one that the figures draw in bold, with pressed, dry faces in still air."""


def sweep(
    mode: Mode, conductance: np.ndarray, effort: Effort, *, rig: Rig = ASSUMED, rung: str = "auto"
) -> Sweep:
    """The ten curves of one figure's panel. rig: for its temperatures and its air. rung: as in thermal.press."""
    presses = [
        thermal.press(
            name,
            mode=mode,
            conductance=float(h),
            object_size=OBJECT_SIZE,
            air=rig.air,
            sensor_temperature=rig.thermostat,
            object_temperature=rig.room,
            seconds=SECONDS,
            dt=effort.dt,
            tolerance=effort.tolerance,
            rung=rung,
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


def rough_conductances(mode: Mode, rig: Rig = ASSUMED) -> np.ndarray:
    """(10,) W/(m2 K) of the rig's roughness at its pressure by the contact laws. T mode: the lapped face on each
    material. O mode: the contact that opens is thermostat on element, aluminium as rough on the same face whatever the
    object."""
    return np.array([_rough(name if mode == "T" else "aluminium", rig) for name in MATERIALS])


def _rough(name: str, rig: Rig) -> float:
    face = thermal.Surface.of(thermal.material(name))
    roughness = max(face.roughness, rig.roughness)
    face = replace(face, roughness=roughness, slope=typical_slope(roughness))
    return float(thermal.contact_conductance(thermal.joint(thermal.LAPPED_ALUMINA, face), rig.pressure))
