"""What commands share: arguments, output, versions, and MuJoCo without OpenGL."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.cli.shared.arguments import (
        add_duration,
        add_materials_file,
        add_mode,
        add_old_name,
        add_seed,
        add_sensor,
        add_skin,
        add_tolerance,
        chosen_material,
        target,
    )
    from thermograsp.cli.shared.help import Help, described
    from thermograsp.cli.shared.opengl import load_mujoco
    from thermograsp.cli.shared.output import Output, plain
    from thermograsp.cli.shared.versions import ShowVersion

__all__ = [
    "Help",
    "Output",
    "ShowVersion",
    "add_duration",
    "add_materials_file",
    "add_mode",
    "add_old_name",
    "add_seed",
    "add_sensor",
    "add_skin",
    "add_tolerance",
    "chosen_material",
    "described",
    "load_mujoco",
    "plain",
    "target",
]

__getattr__ = opened(__name__)
