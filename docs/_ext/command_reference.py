"""Every command with its arguments, as Markdown, from the parsers themselves."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from thermograsp.cli import command_parser
from thermograsp.cli.shared import described


def command_reference() -> str:
    """A section for each command, and for each action of those that have some."""
    return "\n".join(_section(parser) for parser in _leaves(command_parser([])))


def _leaves(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    below = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    if not below:
        yield parser
    for action in below:
        for sub in action.choices.values():
            yield from _leaves(sub)


def _section(parser: argparse.ArgumentParser) -> str:
    rows = [_row(action) for action in parser._actions if _shown(action)]
    given = "".join(f"| {names} | {text} |\n" for names, text in rows)
    return f"## {parser.prog}\n\n{_cell(parser.description or '')}\n\n| argument | what |\n|---|---|\n{given}"


def _shown(action: argparse.Action) -> bool:
    """Old names of options are not."""
    return not isinstance(action, argparse._HelpAction) and action.help != argparse.SUPPRESS


def _row(action: argparse.Action) -> tuple[str, str]:
    value = _value(action)
    if action.option_strings:
        names = ", ".join(f"`{name}{' ' + value if value else ''}`" for name in action.option_strings)
    else:
        names = f"`{value}`"
    text = described(action) % {**vars(action), "prog": ""}
    return names.replace("|", "\\|"), _cell(text)


def _value(action: argparse.Action) -> str:
    """What is to be given, as the usage line has it."""
    if action.nargs == 0:
        return ""
    fallback = action.dest.upper() if action.option_strings else action.dest
    if action.choices:
        fallback = "{" + ",".join(map(str, action.choices)) + "}"
    name = action.metavar or fallback
    one = name if isinstance(name, str) else " ".join(name)
    return {"*": f"[{one} ...]", "+": f"{one} ...", "?": f"[{one}]"}.get(str(action.nargs), one)


def _cell(text: str) -> str:
    """Text in a table: what stands between backticks is code, and nothing else of it is Markdown."""
    parts = " ".join(text.split()).split("`")
    for i in range(0, len(parts), 2):
        for special in "\\*_[]<>|$":
            parts[i] = parts[i].replace(special, "\\" + special)
    return "`".join(parts)
