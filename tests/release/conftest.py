"""What is published, built once for all tests of this folder: a wheel, an sdist, and the sdist's own wheel."""

import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from .tree import clean_environment, clone, run


@dataclass(frozen=True, slots=True)
class Release:
    """wheel, sdist: of the tree. rebuilt: the wheel of the sdist."""

    wheel: Path
    sdist: Path
    rebuilt: Path


@pytest.fixture(scope="session")
def release(tmp_path_factory: pytest.TempPathFactory) -> Release:
    tree = clone(tmp_path_factory.mktemp("tree"))
    published, direct = tmp_path_factory.mktemp("published"), tmp_path_factory.mktemp("direct")
    build = [sys.executable, "-m", "build", "--no-isolation"]
    environment = clean_environment(tmp_path_factory.mktemp("home"))
    run([*build, "--outdir", published], tree, environment)  # an sdist, and a wheel of that
    run([*build, "--wheel", "--outdir", direct], tree, environment)
    ((wheel,), (rebuilt,), (sdist,)) = (
        direct.glob("*.whl"),
        published.glob("*.whl"),
        published.glob("*.tar.gz"),
    )
    return Release(wheel, sdist, rebuilt)
