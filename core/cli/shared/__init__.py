"""What commands share: arguments, a device's connection, output, a live plot, versions, and MuJoCo without OpenGL."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.cli.shared.arguments import (
        add_duration,
        add_materials_file,
        add_mode,
        add_object_size,
        add_old_name,
        add_seed,
        add_sensor,
        add_skin,
        add_surround,
        add_tolerance,
        chosen_material,
        target,
    )
    from thermograsp.cli.shared.connection import (
        add_port,
        add_sampling,
        add_service,
        connect,
        link_document,
        link_line,
        serve,
    )
    from thermograsp.cli.shared.help import Help, described
    from thermograsp.cli.shared.live_plot import LivePlot
    from thermograsp.cli.shared.opengl import load_mujoco
    from thermograsp.cli.shared.output import Output, plain
    from thermograsp.cli.shared.versions import ShowVersion

__all__ = [
    "Help",
    "LivePlot",
    "Output",
    "ShowVersion",
    "add_duration",
    "add_materials_file",
    "add_mode",
    "add_object_size",
    "add_old_name",
    "add_port",
    "add_sampling",
    "add_seed",
    "add_sensor",
    "add_service",
    "add_skin",
    "add_surround",
    "add_tolerance",
    "chosen_material",
    "connect",
    "described",
    "link_document",
    "link_line",
    "load_mujoco",
    "plain",
    "serve",
    "target",
]

__getattr__ = opened(__name__)
