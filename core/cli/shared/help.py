"""What is said of an argument, with the default that its parser has."""

from __future__ import annotations

import argparse


class Help(argparse.HelpFormatter):
    """Shows each argument's default behind its help, as it would be given on a command line."""

    def _get_help_string(self, action: argparse.Action) -> str:
        return described(action)


def described(action: argparse.Action) -> str:
    """The argument's help, still to be filled in by %, and its default where it has one that can be given."""
    text, optional = action.help or "", action.option_strings or action.nargs in ("?", "*")
    if not optional or action.nargs == 0 or action.default in (None, "", argparse.SUPPRESS):
        return text
    values = action.default if isinstance(action.default, list | tuple) else [action.default]
    shown = " ".join(map(_shown, values)).replace("%", "%%")
    return f"{text} (default {shown})" if shown else text


def _shown(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
