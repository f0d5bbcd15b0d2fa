"""The command line: `thermograsp COMMAND ...`, one module a command.

A command's module has NAME, HELP, add_arguments(parser) and run(args) -> exit status. It imports what is heavy inside
run, and only the chosen command's module is imported.
"""

from __future__ import annotations

import argparse
import importlib
import logging
import os
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any, NoReturn

from thermograsp.cli.shared import Help, Output, ShowVersion
from thermograsp.errors import InvalidValueError, ThermograspError, unknown_name

COMMANDS = (
    "demo",
    "grasp",
    "press",
    "identify",
    "materials",
    "objects",
    "reproduce",
    "validate",
    "rollout",
    "train",
    "score",
    "dataset",
    "device",
    "gripper",
    "bench",
    "view",
    "warmup",
)

JSON, VERBOSE = "--json", "--verbose"
"""What every command takes, anywhere on its line."""

_BAD_INPUT = 2
_INTERRUPTED = 130
_BROKEN_PIPE = 141


class _Parser(argparse.ArgumentParser):
    def __init__(self, **keywords: Any) -> None:
        super().__init__(**{"formatter_class": Help, **keywords})

    def error(self, message: str) -> NoReturn:
        raise InvalidValueError(f"{message}; see {self.prog} --help")


def main(argv: Sequence[str] | None = None) -> int:
    """Runs one command and returns its exit status: 0 only where it did what it was asked, 2 for bad input (one line on
    stderr, and with --json, which may stand anywhere, a document of it on stdout), 130 for an interrupt."""
    words = list(sys.argv[1:] if argv is None else argv)
    given = [word for word in words if word not in (JSON, VERBOSE)]
    as_json = JSON in words
    try:
        args = command_parser(given, as_json).parse_args(given or ["--help"])
        args.json = as_json
        if VERBOSE in words:
            logging.basicConfig(format="%(name)s: %(message)s")
            logging.getLogger("thermograsp").setLevel(logging.INFO)
        status = args.run(args)
        sys.stdout.flush()  # a reader that has gone shows here, not at exit
        return status
    except SystemExit as leaving:  # --help and --version
        return leaving.code if isinstance(leaving.code, int) else 0
    except KeyboardInterrupt:
        return _INTERRUPTED
    except BrokenPipeError:
        _forget_stdout()
        return _BROKEN_PIPE
    except (ThermograspError, OSError) as error:
        message = " ".join(str(error).split())
        print(f"thermograsp: {message}", file=sys.stderr)
        try:
            Output(as_json).record(  # of one line, for readers of a stream
                {"error": {"kind": type(error).__name__, "message": message}, "status": _BAD_INPUT}
            )
            sys.stdout.flush()
        except OSError:  # stdout is what cannot be written
            _forget_stdout()
        return _BAD_INPUT


def command_parser(given: Sequence[str], as_json: bool = False) -> argparse.ArgumentParser:
    """The parser of the command that is named, or of all of them where none is, for --help."""
    parser = _Parser(prog="thermograsp", description="Thermal touch for robot grasping.", allow_abbrev=False)
    parser.add_argument(
        "--version",
        action=ShowVersion,
        as_json=as_json,
        help="show the version and exit; with --json, the versions of everything that it runs on",
    )
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    first = given[0] if given else "--help"
    if not first.startswith("-") and first not in COMMANDS:
        raise unknown_name("command", first, COMMANDS)
    for name in [first] if first in COMMANDS else COMMANDS:
        module = _command(name)
        sub = commands.add_parser(name, help=module.HELP, description=module.HELP, allow_abbrev=False)
        module.add_arguments(sub)
        sub.add_argument(VERBOSE, action="store_true", help="report details of the computation on stderr")
        sub.add_argument(
            JSON, action="store_true", help="print one JSON document and nothing else; errors are JSON too"
        )
        sub.set_defaults(run=module.run)
    return parser


def _command(name: str) -> ModuleType:
    return importlib.import_module(f"thermograsp.cli.{name}")


def _forget_stdout() -> None:
    """Python flushes stdout at exit; without a reader that would print a traceback."""
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError):
        pass
