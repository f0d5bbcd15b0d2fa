"""`thermograsp press`: the sensor on one object, by any model of the ladder."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from thermograsp.cli.press.mesh import KEYWORDS, PLATES, add_mesh_arguments, press_mesh, refuse_mesh_arguments
from thermograsp.cli.shared import (
    Output,
    add_materials_file,
    add_mode,
    add_object_size,
    add_sensor,
    add_skin,
    add_surround,
    add_tolerance,
    chosen_material,
    target,
)

if TYPE_CHECKING:
    from thermograsp.thermal import Press

NAME = "press"
HELP = "Press the sensor on an object and print what it feels."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command: thermal.press's keywords, with its defaults."""
    add = parser.add_argument
    add("material", help="name of the material, see `thermograsp materials`")
    add_materials_file(parser)
    add_mode(parser)
    add_sensor(parser)
    add(
        "--conductance",
        type=float,
        help="contact conductance, W/(m2 K) (default: 1e4; for a heated sensor, what its contact conducts at --force)",
    )
    add(
        "--force",
        type=float,
        help="contact force of a heated sensor, N (default: the force for which its contact is stated)",
    )
    add(
        "--area",
        type=float,
        help="contact area, m2 (default: 81e-6, or the area of the sensor's face if that is smaller)",
    )
    add_skin(parser)
    add("--shape", default="square", help="shape of the contact: square or round")
    add_object_size(parser)
    add("--air", type=float, default=0.0, help="coefficient of heat transfer to the air, W/(m2 K)")
    add("--sensor-temperature", type=float, default=36.0, help="initial temperature of the thermostat, degC")
    add("--object-temperature", type=float, default=24.0, help="initial temperature of the object, degC")
    add("--seconds", type=float, default=10.0, help="length of the press, s")
    add("--dt", type=float, default=0.02, help="interval between samples, s")
    add_tolerance(parser)
    add(
        "--rung",
        default="auto",
        help="model of the press: auto for the cheapest that keeps the tolerance, or a name such as layered or network",
    )
    add(
        "--opposite",
        type=float,
        help="contact conductance of a second fingertip on the opposite face, W/(m2 K) (default: no second fingertip)",
    )
    add(
        "--thermostat-power",
        type=float,
        metavar="W",
        help="limit of the thermostat's heating power, W (default: an ideal thermostat)",
    )
    add_surround(parser)
    add(
        "--surround-conductance",
        type=float,
        help="contact conductance of the surround, W/(m2 K) (default: as pressed with 10 N)",
    )
    add_mesh_arguments(parser)
    add("--no-cache", action="store_true", help="do not keep thermal networks on disk")
    add("--csv", metavar="FILE", help="write the curves as a table")
    add("--plot", metavar="FILE", help="draw the curves: .svg, .png or .pdf")


def run(args: argparse.Namespace) -> int:
    """Presses and prints."""
    from thermograsp import thermal
    from thermograsp.columns import write_csv

    csv, plot = target(args.csv, ()), target(args.plot, (".svg", ".png", ".pdf"))
    material = chosen_material(args.material, args.materials)
    keywords = {name: getattr(args, name) for name in (*KEYWORDS, *PLATES, "area")}
    thermostat = None
    if args.thermostat_power is not None:
        first, around = args.sensor_temperature, args.object_temperature
        thermostat = thermal.Thermostat(setpoint=first, ambient=around, power_limit=args.thermostat_power)
    if args.mesh is None:
        refuse_mesh_arguments(args)
        result = thermal.press(material, **keywords, thermostat=thermostat, cache=not args.no_cache)
    else:
        result = press_mesh(args, material, thermostat)
    columns = {
        "time_s": result.t,
        "temperature_drop_K": result.temperature_drop,
        "voltage_V": result.voltage,
        "heat_flow_W": result.heat_flow,
        "sensor_surface_degC": result.sensor_surface,
        "object_surface_degC": result.object_surface,
        "stored_heat_sensor_J": result.stored_heat[:, 0],
        "stored_heat_object_J": result.stored_heat[:, 1],
    }
    if result.reading is not None:
        columns["reading_degC"] = result.reading
    if csv is not None:
        write_csv(csv, columns)
    if plot is not None:
        from thermograsp.figures import plot_press

        plot_press(plot, result, f"{material.name}, {args.mode} mode")
    _print(Output(args.json), material.name, args, result)
    return 0


def _print(output: Output, name: str, args: argparse.Namespace, result: Press) -> None:
    drop, rung = result.temperature_drop, result.rung
    peak = int(abs(drop).argmax())
    known = f"error {rung.error:.2g} K" if rung.error == rung.error else "error not measured"
    output.line(f"{name}, {args.mode} mode: rung {rung}, {known} ({rung.reason})")
    output.line(
        f"peak   {drop[peak]:8.3f} K  {1e3 * result.voltage[peak]:8.3f} mV  at {result.t[peak]:.2f} s"
    )
    output.line(f"final  {drop[-1]:8.3f} K  {1e3 * result.voltage[-1]:8.3f} mV  at {result.t[-1]:.2f} s")
    if result.reading is not None:
        first, last = result.reading[[0, -1]]
        output.line(f"reads  {first:8.3f} degC at first, {last:.3f} degC at {result.t[-1]:.2f} s")
    for file in (args.csv, args.plot):
        if file:
            output.line(f"wrote {file}")
    output.document(
        {
            "material": name,
            "mode": args.mode,
            "rung": {"name": rung.name, "orders": rung.orders, "error_K": rung.error, "reason": rung.reason},
            "samples": len(drop),
            "peak_temperature_drop_K": drop[peak],
            "peak_voltage_V": result.voltage[peak],
            "peak_time_s": result.t[peak],
            "final_temperature_drop_K": drop[-1],
            "final_voltage_V": result.voltage[-1],
            "final_reading_degC": None if result.reading is None else result.reading[-1],
            "csv": args.csv,
            "plot": args.plot,
        }
    )
