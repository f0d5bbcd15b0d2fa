"""All curves that a touch can give, on a common basis of a few functions of time.

r: basis functions, E: effusivities, C: heat capacities, H: contact resistances, M: materials, n: times.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline
from threadpoolctl import threadpool_limits

from thermograsp.files import cached_arrays
from thermograsp.notice import busy

from ..curves import UnitCurves
from ..matter import Material, SensorStack
from ..matter import material as named_material
from . import prior as prior
from .setup import TouchSetup

_KNOTS, _FIRST = 240, 2e-3  # s, scale on which knots begin to spread
_EFFUSIVITIES, _CAPACITIES, _WIDEST = 52, 11, 3.3
_RESISTANCES = 20
_KEPT = 4e-6  # of K per K, what the basis may leave out of a curve


@dataclass(frozen=True, slots=True)
class CurveTable:
    """Curves of objects at nodes of heat capacity and contact resistance. coefficients: (N, C, H, r) on the basis per K
    of difference. Axes: objects, heat capacity in standard deviations (C = 1: known), and log of the contact resistance
    (m2 K/W). log_resistance: (first, spacing). capacity_step: standard deviations between neighbours, the middle one is
    the median."""

    coefficients: np.ndarray
    log_resistance: tuple[float, float]
    capacity_step: float


@dataclass(frozen=True, slots=True)
class CurveLibrary:
    """The curves that identification compares a touch with. knots: (n,) s. functions: (n, r), the basis at the knots.
    objects: curves of any object, its effusivities log_effusivity (E,). materials: curves of the named materials, which
    are exact. typical: (r,) rms of the objects' coefficients, spread: (r, r), whose square is their second moment; both
    per kelvin."""

    knots: np.ndarray
    functions: np.ndarray
    log_effusivity: np.ndarray
    objects: CurveTable
    materials: CurveTable
    typical: np.ndarray = field(init=False, repr=False, compare=False)
    spread: np.ndarray = field(init=False, repr=False, compare=False)
    _spline: CubicSpline = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        flat = self.objects.coefficients.reshape(-1, self.functions.shape[1])
        with threadpool_limits(1, user_api="blas"):  # so that their number decides no last bits
            moment = flat.T @ flat / len(flat)
            sizes, turn = np.linalg.eigh(moment)
        object.__setattr__(self, "typical", np.sqrt(np.diag(moment)))
        object.__setattr__(self, "spread", turn * np.sqrt(np.maximum(sizes, 0.0)))
        object.__setattr__(self, "_spline", CubicSpline(self.knots, self.functions))

    def basis(self, t: np.ndarray) -> np.ndarray:
        """(n, r) at t s after the touch, 0 before it."""
        return np.where(t[:, None] > 0, self._spline(np.maximum(t, 0.0)), 0.0)

    def basis_rate(self, t: np.ndarray) -> np.ndarray:
        """(n, r) 1/s, its derivative by time."""
        return np.where(t[:, None] > 0, self._spline(np.maximum(t, 0.0), 1), 0.0)


def curve_library(
    setup: TouchSetup, materials: Sequence[str | Material], *, cache: bool = True
) -> CurveLibrary:
    """The curves of a setup and the named materials. The first call for a setup takes a second (O mode: 10)."""
    chosen = [named_material(one) for one in materials]
    geometry = setup.geometry(chosen[0])
    knots = _FIRST * np.sinh(np.linspace(0, np.arcsinh(setup.horizon / _FIRST), _KNOTS))
    log_resistance = np.log(np.geomspace(*setup.resistance, _RESISTANCES))
    log_effusivity = np.log(np.geomspace(*prior.RANGE, _EFFUSIVITIES))
    unit = UnitCurves(geometry, knots, setup.converter.bandwidth, setup.core)
    key = {
        "layers": [
            (each.thickness, each.conductivity, each.volumetric_heat_capacity)
            for each in geometry.stack.layers
        ],
        "contact": (
            geometry.stack.width,
            geometry.stack.sensed,
            geometry.area,
            geometry.shape,
            geometry.mode,
        ),
        "object_size": geometry.object_size,
        "axes": [knots, log_resistance, log_effusivity],
        "bandwidth": float(setup.converter.bandwidth),
        "heated": "" if isinstance(setup.worn, SensorStack) else repr(setup.worn),
    }

    def curves(material: Material) -> np.ndarray:
        return unit.on(material)(np.exp(-log_resistance))

    def objects() -> dict[str, np.ndarray]:
        deviations = np.linspace(-_WIDEST, _WIDEST, _CAPACITIES)
        all_curves = []
        for e in np.exp(log_effusivity):
            for capacity in prior.heat_capacity(e, deviations):  # pyright: ignore[reportGeneralTypeIssues]
                all_curves.append(curves(Material("object", e**2 / capacity, capacity, 1.0)))
        found = np.array(all_curves)
        functions = _basis(found.reshape(-1, len(knots)))
        coefficients = _project(functions, found)
        shape = (len(log_effusivity), len(deviations), len(log_resistance), functions.shape[1])
        return {"functions": functions, "coefficients": coefficients.reshape(shape)}

    def named() -> dict[str, np.ndarray]:
        found = [curves(one) for one in chosen]
        return {"coefficients": _project(functions, np.array(found))[:, None]}

    with busy("computing how materials feel to this sensor, once"):
        stored = cached_arrays({**key, "of": "objects"}, objects, enabled=cache)
    functions = stored["functions"]
    properties = [(one.conductivity, one.volumetric_heat_capacity) for one in chosen]
    named_curves = cached_arrays({**key, "of": "materials", "materials": properties}, named, enabled=cache)
    axis = (float(log_resistance[0]), float(log_resistance[1] - log_resistance[0]))
    return CurveLibrary(
        knots,
        functions,
        log_effusivity,
        CurveTable(stored["coefficients"], axis, 2 * _WIDEST / (_CAPACITIES - 1)),
        CurveTable(named_curves["coefficients"], axis, 1.0),
    )


def _basis(curves: np.ndarray) -> np.ndarray:
    """(n, r): functions of unit largest value whose span is within _KEPT of every curve (N, n) at every time."""
    _, weights, right = np.linalg.svd(curves, full_matrices=False)
    count = int(np.searchsorted(-weights, -_KEPT * np.sqrt(len(curves)) / 10)) + 1
    rows = right[:count]
    return (rows / np.abs(rows).max(axis=1, keepdims=True)).T


def _project(functions: np.ndarray, curves: np.ndarray) -> np.ndarray:
    """(..., r) coefficients of curves (..., n); functions are orthogonal over the knots."""
    return curves @ functions / (functions**2).sum(axis=0)
