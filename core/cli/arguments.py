"""Arguments that several commands share, and what they become."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from thermograsp.errors import InvalidValueError, unknown_name

if TYPE_CHECKING:
    from thermograsp.thermal import Material


def add_materials_file(parser: argparse.ArgumentParser) -> None:
    """--materials FILE, for materials of one's own."""
    parser.add_argument(
        "--materials",
        metavar="FILE",
        help="take the material from your own TOML table",
    )


def chosen_material(name: str, file: str | None) -> Material:
    """The material of that name, from the user's table where there is one. Raises UnknownNameError."""
    from thermograsp import thermal

    if file is None:
        return thermal.material(name)
    own = thermal.load_materials(file)
    if name not in own:
        raise unknown_name("material", name, own)
    return own[name]


def target(path: str | None, suffixes: tuple[str, ...]) -> Path | None:
    """Where a result is to go, checked before the work is done. Raises InvalidValueError."""
    if path is None:
        return None
    file = Path(path)
    if suffixes and file.suffix.lower() not in suffixes:
        raise InvalidValueError(f"cannot write {path}: its name must end with {' or '.join(suffixes)}")
    if not file.resolve().parent.is_dir():
        raise InvalidValueError(
            f"cannot write {path}: there is no folder {file.resolve().parent}; create it first"
        )
    if file.is_dir():
        raise InvalidValueError(f"cannot write {path}: it is a folder; name a file")
    return file
