"""The command reference has every command and every option."""

import re

from command_reference import command_reference

from thermograsp.cli import COMMANDS, device


def test_every_command_has_a_section() -> None:
    sections = re.findall(r"^## thermograsp (.*)$", command_reference(), re.MULTILINE)
    assert {section.split()[0] for section in sections} == set(COMMANDS)
    assert {f"device {action}" for action in device.ACTIONS} <= set(sections)
    assert len(set(sections)) == len(sections)


def test_options_stand_as_they_are_typed() -> None:
    page = command_reference()
    for cell in (
        "| `material` |",
        "`--csv FILE`",
        "`--object-size X Y THICKNESS`",
        "`[NAME ...]`",
        "`--json`",
    ):
        assert cell in page
    assert "%(" not in page
