"""The firmware in a simulator, where its tools are installed."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from .board import Board, build, require_tools


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    require_tools()
    return build(tmp_path_factory.mktemp("firmware"))


@pytest.fixture
def board(made: tuple[Path, str]) -> Iterator[Board]:
    one = Board(made[0])
    yield one
    one.close()
