"""What the heat of many worlds costs for each control step, in PyTorch and JAX: touch.FixedTouch on recorded sensors.

    python studies/speed/worlds.py                                              on one thread of the CPU
    python studies/speed/worlds.py --device cuda --worlds 64 512 4096 32768 --bandwidth 3350
    python studies/speed/worlds.py --ways "one by one" graph --json

Two fingertips hold a cube of aluminium or of wood, with contacts of four substeps. Ways: PyTorch's operations one by
one; the same recorded as a CUDA graph (on a GPU only); compiled by torch.compile, and that as a graph; JAX's jit. The
median of several repeats counts: of processor time on the CPU, of the wall's on a GPU, with the device waited for.
Bytes are the least that a step must move: states in and out, sensors in, readings out. The error is the largest of
the temperature drop in single precision beside NumPy in double precision over a second.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import importlib
import importlib.util
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

import thermograsp
from thermograsp.thermal import SignalState
from thermograsp.touch import FixedTouch, FixedTouchState, prepare

FINGER = """<body pos="{0}.03 0 0"> <joint name="{1}" type="slide" axis="{0}1 0 0" damping="20"/>
  <geom name="{1}" type="box" size=".005 .01 .01" mass=".1"/> </body>"""
SCENE = f"""<mujoco> <option timestep=".005" gravity="0 0 0"/> <worldbody>
  <body> <freejoint/> <geom name="cube" type="box" size=".02 .02 .02" mass=".1"/> </body>
  {FINGER.format("+", "right")} {FINGER.format("-", "left")} </worldbody>
  <actuator> <motor joint="right"/> <motor joint="left"/> </actuator> </mujoco>"""
FINGERS = {"right": "right", "left": "left"}
MATERIALS = ("aluminium", "wood")
STEPS = 50  # control steps of .02 s over which the error is found
WAYS = ("one by one", "graph", "compiled", "compiled graph", "jax.jit")


class Grasp:
    """A recorded grasp. sensed: (STEPS, H, sensordata). drop: (STEPS, materials, F) K by NumPy in double precision."""

    def __init__(self) -> None:
        scene = prepare(mujoco.MjSpec.from_string(SCENE), FINGERS, {"cube": "aluminium"})
        self._touch = thermograsp.ThermalTouch(scene, fingertips=FINGERS, objects={"cube": "aluminium"})
        exact, data, rows = self.fixed(np.zeros(0)), mujoco.MjData(scene), []
        data.ctrl[:] = -8.0
        for _ in range(STEPS * exact.substeps):
            mujoco.mj_step(scene, data)
            rows.append(data.sensordata.copy())
        self.sensed = np.array(rows).reshape(STEPS, exact.substeps, -1)
        which = np.arange(len(MATERIALS))
        state, drops = exact.reset(exact.start(len(which)), material=which[:, None]), []
        for rows in self.sensed:
            state, reading = exact.advance(state, exact.contacts(np.repeat(rows[None], len(which), axis=0)))
            drops.append(reading.temperature_drop)
        self.drop = np.array(drops)

    def fixed(self, like: Any) -> FixedTouch:
        return self._touch.fixed_touch(like=like, materials={"cube": MATERIALS})


@dataclass(frozen=True)
class Way:
    """felt: from sensordata (H, sensordata), the same in every world, to the temperature drop (B, F) K a step later.
    again: such a step with the last sensordata, whose end it awaits. bytes: that a step must move."""

    felt: Callable[[np.ndarray], np.ndarray]
    again: Callable[[], object]
    bytes: int


def by_torch(grasp: Grasp, way: str, worlds: int, device: str) -> Way:
    """PyTorch's operations on tensors that stay where they are, as a simulation on a GPU has them."""
    torch = importlib.import_module("torch")
    recorded = importlib.import_module("thermograsp.mjlab.recording").recorded  # which needs no mjlab
    torch.set_num_threads(1)
    fixed = grasp.fixed(torch.zeros(0, device=device))
    which = torch.arange(worlds, device=device)[:, None] % len(MATERIALS)
    first = fixed.reset(fixed.start(worlds), material=which)
    state = packed([part.clone() for part in leaves(first)])
    sensed = torch.zeros((worlds, *grasp.sensed.shape[1:]), device=device)
    drop = torch.zeros((worlds, len(FINGERS)), device=device)

    def pure(state: FixedTouchState, sensed: Any) -> tuple[Any, Any]:
        after, reading = fixed.advance(state, fixed.contacts(sensed))
        return after, (reading.temperature_drop, reading.voltage)

    advance = torch.compile(pure, fullgraph=True, dynamic=False) if "compiled" in way else pure

    def step() -> None:
        after, read = advance(state, sensed)
        write(state, after)
        drop.copy_(read[0])

    run = recorded(step, (*leaves(state), drop)) if "graph" in way else step

    def felt(rows: np.ndarray) -> np.ndarray:
        sensed.copy_(torch.as_tensor(rows, dtype=sensed.dtype, device=device).expand_as(sensed))
        run()
        return drop.double().cpu().numpy()

    def again() -> None:
        run()
        if device == "cuda":
            torch.cuda.synchronize()

    moved = [*leaves(first), *leaves(first), sensed, drop, first.voltage]
    return Way(felt, again, sum(part.numel() * part.element_size() for part in moved))


def by_jax(grasp: Grasp, worlds: int, device: str) -> Way:
    """One jitted function of the sensordata."""
    jax = importlib.import_module("jax")
    with jax.default_device(jax.devices("gpu" if device == "cuda" else device)[0]):
        fixed = grasp.fixed(jax.numpy.zeros(0, "float32"))
        which = jax.numpy.arange(worlds)[:, None] % len(MATERIALS)
        held = {"state": fixed.reset(fixed.start(worlds), material=which)}

        @jax.jit
        def step(state: FixedTouchState, sensed: Any) -> tuple[Any, Any]:
            after, reading = fixed.advance(state, fixed.contacts(sensed))
            return after, (reading.temperature_drop, reading.voltage)

    def again() -> Any:
        held["state"], read = step(held["state"], held["sensed"])
        return jax.block_until_ready(read)

    def felt(rows: np.ndarray) -> np.ndarray:
        sensed = np.broadcast_to(rows.astype("float32"), (worlds, *rows.shape))
        held["sensed"] = jax.device_put(sensed, held["state"].heat.device)
        return np.asarray(again()[0], float)

    state = leaves(held["state"])
    sizes = [*(part.nbytes for part in state + state), held["state"].voltage.nbytes]
    return Way(felt, again, sum(sizes) + 4 * worlds * (grasp.sensed[0].size + len(FINGERS)))


def leaves(state: FixedTouchState) -> list[Any]:
    """The arrays of a state."""
    return [state.heat, state.narrow, *state.signal, state.voltage, state.material, state.first]


def packed(parts: list[Any]) -> FixedTouchState:
    """The state of those arrays."""
    heat, narrow, filtered, last, voltage, material, first = parts
    return FixedTouchState(heat, narrow, SignalState(filtered, last), voltage, material, first)


def write(state: FixedTouchState, after: FixedTouchState) -> None:
    """Copies tensors into those of the state."""
    for old, new in zip(leaves(state), leaves(after), strict=True):
        old.copy_(new)


def measure(grasp: Grasp, way: str, worlds: int, arguments: argparse.Namespace) -> dict[str, float]:
    """The figures of one way for so many worlds."""
    begin = time.perf_counter()
    made = (
        by_jax(grasp, worlds, arguments.device)
        if way == "jax.jit"
        else by_torch(grasp, way, worlds, arguments.device)
    )
    worst, seconds = 0.0, 0.0
    for rows, expected in zip(grasp.sensed, grasp.drop, strict=True):
        found = made.felt(rows)
        seconds = seconds or time.perf_counter() - begin
        worst = max(worst, float(np.abs(found - expected[np.arange(worlds) % len(MATERIALS)]).max()))
    clock = time.process_time if arguments.device == "cpu" else time.perf_counter
    times = []
    while len(times) < arguments.repeats:
        start = clock()
        made.again()
        times.append(clock() - start)
    median = float(np.median(times))
    figures = {
        "ms": 1e3 * median,
        "us_per_world": 1e6 * median / worlds,
        "gigabytes_per_s": made.bytes / median / 1e9,
        "first_step_s": seconds,
        "error_K": worst,
    }
    if arguments.bandwidth:
        figures["of_bandwidth"] = figures["gigabytes_per_s"] / arguments.bandwidth
    return figures


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--worlds", type=int, nargs="+", default=[8, 64, 512, 4096])
    parser.add_argument("--device", choices=["cpu", "cuda"], default="cpu")
    parser.add_argument("--ways", nargs="+", choices=WAYS, default=WAYS)
    parser.add_argument(
        "--bandwidth", type=float, help="GB/s of the device's memory, for the fraction reached"
    )
    parser.add_argument("--repeats", type=int, default=30)
    parser.add_argument("--json", action="store_true", help="print the result as JSON, a line each")
    arguments = parser.parse_args()
    grasp = Grasp()
    for way in arguments.ways:
        package = "jax" if way == "jax.jit" else "torch"
        if importlib.util.find_spec(package) is None or ("graph" in way and arguments.device == "cpu"):
            continue
        for worlds in arguments.worlds:
            figures = measure(grasp, way, worlds, arguments)
            if arguments.json:
                print(json.dumps({"way": way, "worlds": worlds, **figures}), flush=True)
            else:
                shown = ", ".join(f"{name} {figure:.3g}" for name, figure in figures.items())
                print(f"{way:15}{worlds:6} worlds: {shown}", flush=True)


if __name__ == "__main__":
    main()
