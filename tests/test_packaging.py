"""setup.cfg lists packages and data files by hand: nothing is forgotten."""

import configparser
import re
from pathlib import Path

import pytest

import thermograsp

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def setup() -> configparser.ConfigParser:
    parser = configparser.ConfigParser()
    parser.read(ROOT / "setup.cfg", encoding="utf-8")
    return parser


def folders(setup: configparser.ConfigParser) -> dict[str, Path]:
    """Folder of each mapped import name."""
    pairs = (line.split("=") for line in setup["options"]["package_dir"].split("\n") if line)
    return {name.strip(): ROOT / folder.strip() for name, folder in pairs}


def found_packages(setup: configparser.ConfigParser) -> dict[str, Path]:
    """Folder of every package that the source tree holds."""
    found = {}
    for name, top in folders(setup).items():
        for marker in top.rglob("__init__.py"):
            found[".".join([name, *marker.parent.relative_to(top).parts])] = marker.parent
    return found


def test_the_packages_listed_are_those_that_exist(setup: configparser.ConfigParser) -> None:
    listed = setup["options"]["packages"].split()
    assert sorted(listed) == sorted(found_packages(setup))


def test_every_data_file_is_covered(setup: configparser.ConfigParser) -> None:
    packages = found_packages(setup)
    patterns = {name: value.split() for name, value in setup["options.package_data"].items()}
    unknown = set(patterns) - set(packages)
    assert not unknown
    covered = {
        path for name, globs in patterns.items() for glob in globs for path in packages[name].glob(glob)
    }
    data = [
        path
        for top in folders(setup).values()
        for path in top.rglob("*")
        if path.is_file() and path.suffix != ".py" and "__pycache__" not in path.parts
    ]
    assert [str(path.relative_to(ROOT)) for path in data if path not in covered] == []


def test_the_package_is_marked_as_typed() -> None:
    assert (Path(thermograsp.__file__).parent / "py.typed").is_file()


def test_the_version_is_semantic_and_the_changelog_s_topmost() -> None:
    assert re.fullmatch(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)", thermograsp.__version__)
    titles = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert titles[0] == thermograsp.__version__
    numbers = [tuple(map(int, title.split("."))) for title in titles]
    assert numbers == sorted(set(numbers), reverse=True)


def test_the_citation_is_complete_and_of_this_version(setup: configparser.ConfigParser) -> None:
    """What the Citation File Format 1.2.0 asks for, and what is said elsewhere too."""
    yaml = pytest.importorskip("yaml", reason="needs PyYAML: the extra test")
    about = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= set(about)
    known = {"abstract", "type", "version", "license", "keywords", "references"}
    assert set(about) - known == {"cff-version", "message", "title", "authors"}
    assert about["cff-version"] == "1.2.0" and about["type"] == "software"
    assert about["version"] == thermograsp.__version__
    bibtex = (ROOT / "docs" / "howto.md").read_text(encoding="utf-8")
    assert f"version = {{{thermograsp.__version__}}}" in bibtex
    assert about["license"] == setup["metadata"]["license_expression"]
    assert len(set(about["keywords"])) == len(about["keywords"])
    for one in [about, *about["references"]]:
        assert one["title"] and one["authors"]
        for author in one["authors"]:
            assert set(author) in ({"name"}, {"family-names", "given-names"})
    for reference in about["references"]:
        assert {"type", "title", "authors"} <= set(reference)
