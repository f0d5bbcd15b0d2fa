"""How far networks from heat kernels are off a semi-analytic solution of the same contact in the Laplace domain.

    python studies/networks/laplace_judge.py                 the touches that plates did not serve, then 20 drawn scenes
    python studies/networks/laplace_judge.py --no-known --centred --scenes 60
    python studies/networks/laplace_judge.py --scenes 100 --seed 7 --json
    python studies/networks/laplace_judge.py --no-known --resolution coarse --seed 2026 --scenes 1000

Fingertips touch rectangles anywhere on the low and high faces of a box, each the part of a sensor's face that the box
covers. The heat flow is even on each of graded strips' products; element and box are sums over eigenfunctions (cosines,
turned by the film of air on the box's faces), layer by layer a transmission line; time comes from Talbot's contour. It
shares no code with thermal/kernels. Errors are shares of the first difference, so a hot object is a cold one.

The judge itself is within .0002 K of 12 K of the recorded press; `--resolution coarse` shows what its own grading does.

F: fingertips, C: cells of one contact, M: eigenfunctions of an axis, T: times.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit
from thermograsp.thermal import Material, SensorStack, material, materials, sensor
from thermograsp.thermal.batch import FIXED_LEVEL
from thermograsp.thermal.kernels import (
    Detail,
    Footprint,
    Patches,
    Resolution,
    Spot,
    box_side,
    tip_at,
    touch_sides,
)
from thermograsp.thermal.network import LEVELS
from thermograsp.touch.heat.places import resolution

TIMES = np.array([0.05, 0.15, 0.5, 1.5, 5.0, 12.0, 30.0])
"""(T,) s after the touch at which drops are compared, as far as LEVELS are promised."""
JUDGED = (*(level for level, _ in LEVELS), FIXED_LEVEL, resolution(0.05))
"""The last two are of environments, and of ThermalTouch, whose patterns are not of each place but of the whole face."""
WITHIN = 0.05 / 12
"""Share of the first difference, over which touches are counted."""
FACE = {"low": 4, "high": 5}
"""The box's faces of this axis, as thermal/kernels numbers them."""


@dataclass(frozen=True, slots=True)
class Touch:
    """low: (2,) m, the contact's corner nearest the face's, on the box; size: (2,) m of it; on_element: (2,) m, the
    same corner on the sensor's face. conductance: W/(m2 K). face: low or high, of the box's thickness."""

    low: tuple[float, float]
    size: tuple[float, float]
    on_element: tuple[float, float]
    conductance: float
    face: str = "high"

    @property
    def area(self) -> float:
        """m2."""
        return self.size[0] * self.size[1]


@dataclass(frozen=True, slots=True)
class Scene:
    """size: m of the box. film: W/(m2 K) to the air on all its faces but under the touches. touches: one, or two whose
    rectangles do not overlap."""

    material: Material
    size: tuple[float, float, float]
    film: float
    touches: tuple[Touch, ...]
    stack: SensorStack


class Accuracy(NamedTuple):
    """strips: in half a contact's side, at most, each `ratio` of its neighbour toward the edge but none below finest m.
    waves: largest wave number times the finest strip. nodes: on Talbot's contour."""

    strips: int
    ratio: float
    finest: float
    waves: float
    nodes: int


FINE = Accuracy(6, 0.45, 3e-5, 2.5, 10)
COARSE = Accuracy(5, 0.45, 6e-5, 1.5, 9)


def edges(width: float, accuracy: Accuracy) -> np.ndarray:
    """Strips' ends from 0 to width, m, graded toward both."""
    widths = np.array([width / 2])
    for count in range(accuracy.strips, 1, -1):
        finer = accuracy.ratio ** np.arange(count)
        finer *= width / 2 / finer.sum()
        if finer[-1] >= accuracy.finest:
            widths = finer
            break
    half = np.concatenate(([0.0], np.cumsum(widths[::-1])))
    return np.concatenate((half, width - half[-2::-1]))


class Axis(NamedTuple):
    """squared: (M,) 1/m2 wave numbers; means: for each contact (M, strips) of normalised eigenfunctions over strips."""

    squared: np.ndarray
    means: list[np.ndarray]


def axis(length: float, biot: float, strips: list[np.ndarray], accuracy: Accuracy) -> Axis:
    """Of 0 .. length with a film at both ends, biot: 1/m, its W/(m2 K) over the conductivity."""
    largest = accuracy.waves / min(float(np.diff(each).min()) for each in strips)
    orders = np.arange(max(int(largest * length / np.pi), 4) + 1)
    # the phase is 0 at an adiabatic end; both ends' phases and m half turns make the length: a root
    low, high = orders * np.pi / length, (orders + 1) * np.pi / length
    for _ in range(60 if biot > 0 else 0):
        middle = (low + high) / 2
        over = middle * length - orders * np.pi - 2 * np.arctan2(biot, middle) > 0
        low, high = np.where(over, low, middle), np.where(over, middle, high)
    waves = low if biot == 0 else (low + high) / 2
    phase = np.arctan2(biot, waves) if biot > 0 else np.zeros_like(waves)
    safe = np.where(waves > 0, waves, 1.0)
    squares = length / 2 + (np.sin(2 * (waves * length - phase)) + np.sin(2 * phase)) / (4 * safe)
    norm = np.where(waves > 0, squares, length)
    means = []
    for each in strips:
        rising = np.sin(waves[:, None] * each - phase[:, None]) / safe[:, None]
        rising = np.where(waves[:, None] > 0, rising, each)
        means.append(np.diff(rising, axis=1) / np.diff(each) / np.sqrt(norm)[:, None])
    return Axis(waves**2, means)


@njit(cache=True, error_model="numpy")
def _box_lines(s, conductivity, diffusivity, depth, film, x_squared, y_squared, lines, across):
    """Fills (2, M, M) real and imaginary m2 K/W: a plate's impedance of each eigenfunction at one face and to the
    other, from a plate's even and odd halves."""
    for m in range(len(x_squared)):
        for n in range(len(y_squared)):
            g = np.sqrt(s / diffusivity + x_squared[m] + y_squared[n])
            decay = np.exp(-g * depth)
            slope = (1 - decay) / (1 + decay)
            even = 1 / (film + conductivity * g * slope)
            odd = 1 / (film + conductivity * g / slope)
            one, other = (even + odd) / 2, (even - odd) / 2
            lines[0, m, n], lines[1, m, n] = one.real, one.imag
            across[0, m, n], across[1, m, n] = other.real, other.imag


@njit(cache=True, error_model="numpy")
def _element_lines(s, thickness, conductivity, capacity, x_squared, y_squared, lines):
    """Fills (2, M, M) real and imaginary m2 K/W: layers from a thermostat to the face."""
    for m in range(len(x_squared)):
        for n in range(len(y_squared)):
            line = 0.0j
            for i in range(len(thickness)):
                g = np.sqrt(s * capacity[i] / conductivity[i] + x_squared[m] + y_squared[n])
                decay = np.exp(-2 * g * thickness[i])
                slope = (1 - decay) / (1 + decay)
                step = slope / (conductivity[i] * g)
                line = (line + step) / (1 + line * conductivity[i] * g * slope)
            lines[0, m, n], lines[1, m, n] = line.real, line.imag


def _between(lines: np.ndarray, x: list[np.ndarray], y: list[np.ndarray]) -> np.ndarray:
    """(C, C) K/W between the cells of one contact (first of x and y) and another's."""
    pairs = [(a[:, :, None] * b[:, None, :]).reshape(len(a), -1) for a, b in (x, y)]
    _, rows, columns = lines.shape
    half = (lines.reshape(2 * rows, columns) @ pairs[1]).reshape(2, rows, -1)
    summed = pairs[0].T @ half[0] + 1j * (pairs[0].T @ half[1])
    shape = (x[0].shape[1], x[1].shape[1], y[0].shape[1], y[1].shape[1])
    cells = summed.reshape(shape).transpose(0, 2, 1, 3)
    return cells.reshape(shape[0] * shape[2], shape[1] * shape[3])


def _drop_of_flux(stack: SensorStack, s: complex) -> complex:
    """m2 K/W: the drop across the sensed layer, thermostat side less object side, per flux out of the face."""
    temperature, flux, sensed = 0j, 1 + 0j, 0j
    for index, layer in enumerate(stack.layers):
        k = layer.conductivity
        g = np.sqrt(s * layer.volumetric_heat_capacity / k)
        turn = g * layer.thickness
        # temperature falls and flux changes along the way to the object
        beyond = temperature * np.cosh(turn) - flux * np.sinh(turn) / (k * g)
        flux = flux * np.cosh(turn) - temperature * k * g * np.sinh(turn)
        if index == stack.sensed:
            sensed = temperature - beyond
        temperature = beyond
    return sensed / flux


class Contour:
    """Solves a scene at one Laplace variable after another."""

    def __init__(self, scene: Scene, accuracy: Accuracy) -> None:
        self.scene = scene
        made, touches = scene.material, scene.touches
        strips = [[edges(touch.size[a], accuracy) for touch in touches] for a in range(2)]
        biot = scene.film / made.conductivity
        self.box = [
            axis(
                scene.size[a],
                biot,
                [each + touch.low[a] for each, touch in zip(strips[a], touches, strict=True)],
                accuracy,
            )
            for a in range(2)
        ]
        self.elements = [
            [axis(scene.stack.width, 0.0, [strips[a][f] + touch.on_element[a]], accuracy) for a in range(2)]
            for f, touch in enumerate(touches)
        ]
        self.areas = [
            np.outer(np.diff(strips[0][f]), np.diff(strips[1][f])).ravel() for f in range(len(touches))
        ]
        size = 2, len(self.box[0].squared), len(self.box[1].squared)
        self.room = np.empty(size), np.empty(size)
        layers = scene.stack.layers
        self.layers = tuple(
            np.array([getattr(layer, name) for layer in layers])
            for name in ("thickness", "conductivity", "volumetric_heat_capacity")
        )

    def drops(self, s: complex) -> np.ndarray:
        """(F,) K s per K of first difference."""
        scene, touches = self.scene, self.scene.touches
        made, (alone, across) = scene.material, self.room
        first, second = self.box
        capacity = made.volumetric_heat_capacity
        _box_lines(
            s,
            made.conductivity,
            made.conductivity / capacity,
            scene.size[2],
            scene.film,
            first.squared,
            second.squared,
            alone,
            across,
        )
        blocks = [
            [
                _between(
                    alone if one.face == other.face else across,
                    [first.means[f], first.means[o]],
                    [second.means[f], second.means[o]],
                )
                for o, other in enumerate(touches)
            ]
            for f, one in enumerate(touches)
        ]
        whole, areas = np.block(blocks), np.concatenate(self.areas)
        # under the touches no air: what the film takes there is put back
        whole = np.linalg.solve(np.eye(len(areas)) - whole * (scene.film * areas), whole)
        start = 0
        for touch, (x, y), cell_areas in zip(touches, self.elements, self.areas, strict=True):
            lines = np.empty((2, len(x.squared), len(y.squared)))
            _element_lines(s, *self.layers, x.squared, y.squared, lines)
            end = start + len(cell_areas)
            whole[start:end, start:end] += _between(lines, x.means * 2, y.means * 2)
            whole[start:end, start:end] += np.diag(1 / (touch.conductance * cell_areas))
            start = end
        flow = np.linalg.solve(whole, np.full(len(areas), 1 / s))
        ends = np.cumsum([0, *map(len, self.areas)])
        heat = np.add.reduceat(flow, ends[:-1])
        return heat / scene.stack.face_area * _drop_of_flux(scene.stack, s)


def judged(scene: Scene, times: np.ndarray = TIMES, accuracy: Accuracy = FINE) -> np.ndarray:
    """(F, T) K per K of first difference: drops after all touches at once (Talbot's fixed contour: Abate & Valko,
    Int. J. Numer. Meth. Engng 60, 2004)."""
    contour, count = Contour(scene, accuracy), accuracy.nodes
    angle = np.arange(1, count) * np.pi / count
    cot = 1 / np.tan(angle)
    slope = angle + (angle * cot - 1) * cot
    found = np.empty((len(scene.touches), len(times)))
    for i, t in enumerate(times):
        radius = 2 * count / (5 * t)
        total = np.real(0.5 * np.exp(radius * t) * contour.drops(complex(radius)))
        for theta, c, sigma in zip(angle, cot, slope, strict=True):
            s = radius * theta * (c + 1j)
            total = total + np.real(np.exp(s * t) * (1 + 1j * sigma) * contour.drops(s))
        found[:, i] = radius / count * total
    return found


def networks(scene: Scene, level: Resolution | Detail, times: np.ndarray = TIMES) -> np.ndarray:
    """(F, T) K per K of first difference: the same from networks, solved exactly. level: a Resolution for fixed rates,
    as the environments have them, a Detail for networks of just this touch."""
    touches, count = scene.touches, level.patterns
    elements = [
        (
            scene.stack,
            (
                (touch.on_element[0], touch.on_element[0] + touch.size[0]),
                (touch.on_element[1], touch.on_element[1] + touch.size[1]),
            ),
        )
        for touch in touches
    ]
    half = np.array([touch.size for touch in touches]) / 2
    patches = Patches(
        np.array([FACE[touch.face] for touch in touches]),
        np.array([touch.low for touch in touches]) + half,
        half,
    )
    if isinstance(level, Resolution):
        (*sides, depth), made = scene.size, scene.material
        prints = [
            Footprint(covered, tuple(middle), tuple(wide))
            for (_, covered), middle, wide in zip(
                elements, patches.centre.tolist(), patches.half.tolist(), strict=True
            )
        ]
        behind = prints[::-1] if len(prints) == 2 else [None]
        known = made.conductivity, made.volumetric_heat_capacity
        spots = [
            Spot(*known, (sides[0], sides[1]), depth, near, other)
            for near, other in zip(prints, behind, strict=True)
        ]
        if level == FIXED_LEVEL:  # as the environments do
            spots = [spot.alike(scene.stack.width) for spot in spots]
        tips = tuple(
            tip_at(scene.stack, spot, level, near.covered) for spot, near in zip(spots, prints, strict=True)
        )
        box = box_side(scene.material, scene.size, scene.film, patches, tips, level)
    else:
        tips, box = touch_sides(scene.material, scene.size, scene.film, patches, elements, level)
    rates = np.concatenate([box.rates, *(one.side.rates for one in tips)])
    ports = np.zeros((len(rates), len(tips) * count))
    ports[: len(box.rates)] = box.ports
    rows, start = np.zeros((len(tips), len(rates))), len(box.rates)
    for f, one in enumerate(tips):
        end = start + len(one.side.rates)
        ports[start:end, f * count : (f + 1) * count] = -one.side.ports
        rows[f, start:end] = one.side.outputs["drop"]
        start = end
    weights = np.repeat([touch.conductance * touch.area for touch in touches], count)
    decay, turn = np.linalg.eigh(np.diag(rates) + (ports * weights) @ ports.T)
    decay = np.maximum(decay, 1e-15)
    source = turn.T @ (ports[:, ::count] @ weights[::count])
    grown = -np.expm1(-np.outer(times, decay)) / decay
    return (rows @ turn * source) @ grown.T


def shares(scene: Scene, accuracy: Accuracy = FINE) -> list[float]:
    """Largest error of the drop at any fingertip for each of JUDGED, as a share of the first difference."""
    exact = judged(scene, accuracy=accuracy)
    return [float(np.abs(networks(scene, level) - exact).max()) for level in JUDGED]


def _touch(rng: np.random.Generator, size: tuple[float, float, float], width: float, face: str) -> Touch:
    """The sensor's face all on the box, over its edge, or on a part that stands out."""
    low, extent, corner = [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]
    for a in range(2):
        room = min(width, size[a])
        extent[a] = room if rng.random() < 0.5 else room * float(rng.uniform(0.3, 1.0))
        free = size[a] - extent[a]
        kind = rng.integers(3)
        low[a] = free * (float(rng.random()) if kind == 0 else float(kind - 1))
        corner[a] = (width - extent[a]) * (
            float(rng.random()) if kind == 0 else float(2 - kind) if rng.random() < 0.8 else 0.5
        )
    h = float(10 ** rng.uniform(2, 5))
    return Touch((low[0], low[1]), (extent[0], extent[1]), (corner[0], corner[1]), h, face)


def _middle(rng: np.random.Generator, size: tuple[float, float, float], width: float, face: str) -> Touch:
    """A square in the middle of both faces."""
    side = min(width * float(np.sqrt(rng.choice([1.0, 0.6, 0.3, 0.1]))), *size[:2])
    low = (size[0] - side) / 2, (size[1] - side) / 2
    corner = (width - side) / 2
    return Touch(low, (side, side), (corner, corner), float(10 ** rng.uniform(2, 5)), face)


def drawn(rng: np.random.Generator, centred: bool) -> Scene:
    """A box of any material, 4 mm to .1 m wide and .1 to 50 mm thick, in still air or none, one fingertip or two.
    centred: all touch squares in the middle of faces, as `press` does; else anywhere."""
    names, stack = list(materials()), sensor("seed")
    made = material(names[rng.integers(len(names))])
    x, y, thickness = np.exp(rng.uniform(np.log((4e-3, 4e-3, 1e-4)), np.log((0.1, 0.1, 0.05)))).tolist()
    size = (x, y, thickness)
    faces = ("high",) if rng.random() < 0.5 else ("high", "low")
    film = 0.0 if rng.random() < 0.5 else float(rng.uniform(2, 25))
    place = _middle if centred else _touch
    touches = tuple(place(rng, size, stack.width, face) for face in faces)
    return Scene(made, size, film, touches, stack)


def known() -> dict[str, Scene]:
    """Touches that a centred square on a plate as wide as the sensor did not serve, one fingertip."""
    stack = sensor("seed")
    w = stack.width

    def scene(
        name: str, size: tuple[float, float, float], covered: tuple[float, float], film: float, h: float
    ) -> Scene:
        # what is not covered stands over the box's first edge
        extent = (min(covered[0] * w, size[0]), min(covered[1] * w, size[1]))
        edge = tuple(0.0 if c < 1 else (size[a] - extent[a]) / 2 for a, c in enumerate(covered))
        corner = (w - extent[0] if covered[0] < 1 else (w - extent[0]) / 2, (w - extent[1]) / 2)
        touch = Touch((edge[0], edge[1]), extent, corner, h)
        return Scene(material(name), size, film, (touch,), stack)

    cube, found = (0.04, 0.04, 0.04), {}
    for h in (1e3, 1e4, 1e5):
        found |= {
            f"61 % covered, aluminium, h {h:.0e}": scene("aluminium", cube, (0.61, 1.0), 0.0, h),
            f"61 % covered, glass, h {h:.0e}": scene("glass", cube, (0.61, 1.0), 0.0, h),
            f"89 % covered, aluminium, h {h:.0e}": scene("aluminium", cube, (0.89, 1.0), 0.0, h),
            f"bar 5 mm wide, steel, h {h:.0e}": scene(
                "stainless_steel", (0.005, 0.04, 0.04), (1.0, 1.0), 0.0, h
            ),
            f"sheet .5 mm, steel, air 5, h {h:.0e}": scene(
                "stainless_steel", (0.04, 0.04, 5e-4), (1.0, 1.0), 5.0, h
            ),
            f"paper .2 mm, air 5, h {h:.0e}": scene("paper", (0.04, 0.04, 2e-4), (1.0, 1.0), 5.0, h),
            f"polypropylene 14 x 40 x .4 mm, air 15, h {h:.0e}": scene(
                "polypropylene", (0.014, 0.04, 4e-4), (1.0, 1.0), 15.0, h
            ),
        }
    return found


def _described(scene: Scene) -> str:
    size = " x ".join(f"{1e3 * side:.2f}" for side in scene.size)
    touched = ", ".join(
        f"{touch.face} {1e3 * touch.size[0]:.1f} x {1e3 * touch.size[1]:.1f} h {touch.conductance:.0f}"
        for touch in scene.touches
    )
    return f"{scene.material.name} {size} mm, film {scene.film:.0f}, {touched}"


def main() -> None:
    """Prints a line a scene: its errors at each of JUDGED; then the largest, and how many scenes are over WITHIN."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=20, help="how many are drawn (20)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--centred", action="store_true", help="draw squares in the middle of faces, as press has them"
    )
    parser.add_argument("--resolution", choices=("fine", "coarse"), default="fine", help="of the judge")
    parser.add_argument(
        "--no-known", action="store_true", help="leave out the touches that plates did not serve"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    arguments = parser.parse_args()
    accuracy = FINE if arguments.resolution == "fine" else COARSE
    rng = np.random.default_rng(arguments.seed)
    scenes = [] if arguments.no_known else list(known().items())
    scenes += [
        (_described(scene), scene)
        for scene in (drawn(rng, arguments.centred) for _ in range(arguments.scenes))
    ]
    largest, over = np.zeros(len(JUDGED)), np.zeros(len(JUDGED))
    for name, scene in scenes:
        start = time.perf_counter()
        found = shares(scene, accuracy)
        largest = np.maximum(largest, found)
        over += np.array(found) > WITHIN
        _print(arguments.json, name, found, time.perf_counter() - start)
    _print(arguments.json, "largest", largest.tolist(), 0.0)
    _print(arguments.json, f"share of {len(scenes)} over {WITHIN:.5f}", (over / len(scenes)).tolist(), 0.0)


def _print(as_json: bool, name: str, found: list[float], seconds: float) -> None:
    if as_json:
        print(json.dumps({"scene": name, "shares": found, "seconds": round(seconds, 2)}), flush=True)
    else:
        print(" ".join(f"{share:.5f}" for share in found), f"{seconds:5.1f} s ", name, flush=True)


if __name__ == "__main__":
    main()
