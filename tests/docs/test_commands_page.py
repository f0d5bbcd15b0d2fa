"""The command reference has every command and every option."""

import re

from command_reference import command_reference

from thermograsp.cli import COMMANDS, device


def test_every_command_has_a_section() -> None:
    sections = re.findall(r"^## thermograsp (.*)$", command_reference(), re.MULTILINE)
    wanted = [name for name in COMMANDS if name != "device"]
    wanted += [f"device {action}" for action in device.ACTIONS]
    assert sorted(sections) == sorted(wanted)


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
