"""`thermograsp device ACTION`: real and emulated fingertips and grippers on serial ports, one module an action.

An action's module has HELP, add_arguments(parser) and run(args) -> exit status; only the chosen one's run is imported.
"""

from __future__ import annotations

import argparse
import importlib

NAME = "device"
HELP = (
    "List, monitor, record, replay, test, calibrate, fit and emulate fingertips and grippers on serial ports."
)

ACTIONS = (
    "list",
    "monitor",
    "record",
    "replay",
    "selftest",
    "clear-faults",
    "calibrate",
    "fit",
    "emulate",
    "gripper",
    "emulate-gripper",
    "emulate-hand",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """A parser of its own for each action."""
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    for name in ACTIONS:
        module = importlib.import_module(f"{__name__}.{name.replace('-', '_')}")
        sub = actions.add_parser(name, help=module.HELP, description=module.HELP, allow_abbrev=False)
        module.add_arguments(sub)
        sub.set_defaults(act=module.run)


def run(args: argparse.Namespace) -> int:
    """Runs the action."""
    return args.act(args)
