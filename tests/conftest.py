"""Every run of the tests builds its own thermal networks: none are read that an older version left on this machine."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("cache")
    before = os.environ.get("THERMOGRASP_CACHE")
    os.environ["THERMOGRASP_CACHE"] = str(folder)
    yield folder
    if before is None:
        del os.environ["THERMOGRASP_CACHE"]
    else:
        os.environ["THERMOGRASP_CACHE"] = before
