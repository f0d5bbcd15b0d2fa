"""Arguments that several commands share, and what they become."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermograsp.errors import InvalidValueError, positive, unknown_name, whole_number

if TYPE_CHECKING:
    from thermograsp.thermal import Material


class _OldName(argparse.Action):
    """Stores as the option of the new name does, and says on stderr what that is."""

    def __init__(self, option_strings: Sequence[str], dest: str, new: str, **keywords: Any) -> None:
        super().__init__(option_strings, dest, **keywords)
        self._new = new

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        print(f"thermograsp: {option_string} is an old name of {self._new}", file=sys.stderr)
        setattr(namespace, self.dest, values)


def add_old_name(parser: argparse.ArgumentParser, old: str, option: argparse.Action) -> None:
    """Takes an option under a name that it had before, too, with a word that it is old; --help leaves it out."""
    parser.add_argument(
        old,
        action=_OldName,
        new=option.option_strings[0],
        dest=option.dest,
        nargs=option.nargs,
        type=option.type or str,
        default=argparse.SUPPRESS,
        help=argparse.SUPPRESS,
    )


def add_materials_file(parser: argparse.ArgumentParser) -> argparse.Action:
    """--materials FILE, for materials of one's own."""
    return parser.add_argument(
        "--materials", metavar="FILE", help="TOML table of your own materials, used instead of the package's"
    )


def add_mode(parser: argparse.ArgumentParser) -> None:
    """--mode."""
    parser.add_argument(
        "--mode",
        default="T",
        help="sensing mode: T (element on the thermostat) or O (element on the object)",
    )


def add_sensor(parser: argparse.ArgumentParser) -> None:
    """--sensor."""
    parser.add_argument(
        "--sensor", default="seed", help="name of a sensor, or a file that `thermograsp device fit` wrote"
    )


def add_object_size(parser: argparse.ArgumentParser) -> None:
    """--object-size, of a plate of 40 x 40 x 10 mm unless it is given."""
    parser.add_argument(
        "--object-size",
        type=float,
        nargs=3,
        default=(0.04, 0.04, 0.01),
        metavar=("X", "Y", "THICKNESS"),
        help="size of the object, m",
    )


def add_surround(parser: argparse.ArgumentParser) -> None:
    """--surround, for sensors by themselves unless it is given."""
    parser.add_argument(
        "--surround",
        metavar="MATERIAL",
        help="material of a pad of 20 mm around the sensor, which gives heat too (default: no pad)",
    )


def add_skin(parser: argparse.ArgumentParser) -> None:
    """--skin, for sensors that are bare unless it is given."""
    parser.add_argument(
        "--skin",
        help="name of a skin over the sensor's face, in T mode only, such as filled_silicone (default: bare)",
    )


def add_tolerance(parser: argparse.ArgumentParser) -> None:
    """--tolerance."""
    parser.add_argument(
        "--tolerance", type=float, default=0.05, help="tolerance of the simulated temperature drop, K"
    )


def add_seed(parser: argparse.ArgumentParser, about: str) -> None:
    """--seed, a whole number from 0 on."""
    parser.add_argument("--seed", type=seed_number, default=0, help=about)


def add_duration(parser: argparse.ArgumentParser) -> None:
    """--seconds, above 0, for what otherwise runs until an interrupt."""
    parser.add_argument("--seconds", type=duration, help="time to run, s (default: until Ctrl-C)")


def seed_number(text: str) -> int:
    try:
        return whole_number("seed", int(text))
    except ValueError:  # ours is one too
        raise argparse.ArgumentTypeError(f"seed must be a whole number, 0 or above, got {text}") from None


def duration(text: str) -> float:
    try:
        return positive("seconds", float(text))
    except InvalidValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def chosen_material(name: str, file: str | None) -> Material:
    """The material of that name, from the user's table where there is one. Raises UnknownNameError."""
    from thermograsp import thermal

    if file is None:
        return thermal.material(name)
    table = thermal.load_materials(file)
    if name not in table:
        raise unknown_name("material", name, table)
    return table[name]


def target(path: str | None, suffixes: tuple[str, ...]) -> Path | None:
    """The path to which a result is to go, checked before the work is done. Raises InvalidValueError."""
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
