"""A wheel and an sdist hold the package, all of it, and nothing else; both ways lead to the same wheel."""

import configparser
import email
import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import thermograsp

from .conftest import Release
from .tree import ROOT, sources

VERSION = thermograsp.__version__
INFO = f"thermograsp-{VERSION}.dist-info"


def setup() -> configparser.ConfigParser:
    parser = configparser.ConfigParser()
    parser.read(ROOT / "setup.cfg", encoding="utf-8")
    return parser


def packaged() -> dict[str, str]:
    """Path in the wheel of each file of the source folders, by its path in the repository."""
    pairs = [line.split(" = ") for line in setup()["options"]["package_dir"].split("\n") if line]
    tops = {folder: name.replace(".", "/") for name, folder in pairs}
    found = {}
    for path in sources():
        top, _, rest = path.partition("/")
        if top in tops and rest:
            found[path] = f"{tops[top]}/{rest}"
    return found


def test_the_wheel_is_the_source_folders(release: Release) -> None:
    with zipfile.ZipFile(release.wheel) as wheel:
        held = {name: wheel.read(name) for name in wheel.namelist()}
    about = {name for name in held if name.startswith(INFO)}
    assert set(held) - about == set(packaged().values())
    for path, name in packaged().items():
        assert held[name] == (ROOT / path).read_bytes(), name
    names = ("METADATA", "RECORD", "WHEEL", "entry_points.txt", "licenses/LICENSE", "top_level.txt")
    assert about == {f"{INFO}/{name}" for name in names}


def test_what_users_look_for_is_in_the_wheel(release: Release) -> None:
    with zipfile.ZipFile(release.wheel) as wheel:
        names = set(wheel.namelist())
    for wanted in (
        "thermograsp/py.typed",
        "thermograsp/assets/materials.toml",
        "thermograsp/assets/sensors.toml",
        "thermograsp/hardware/firmware/Makefile",
    ):
        assert wanted in names
    assert not [
        name for name in names if re.search(r"(^|/)tests?/|__pycache__|\.(pyc|nbc|nbi|o|hex|elf)$", name)
    ]


def test_the_sdist_makes_the_same_wheel(release: Release) -> None:
    with zipfile.ZipFile(release.wheel) as one, zipfile.ZipFile(release.rebuilt) as other:
        assert {name: one.read(name) for name in sorted(one.namelist())} == {
            name: other.read(name) for name in sorted(other.namelist())
        }


def test_the_sdist_holds_what_it_is_made_of(release: Release) -> None:
    top = f"thermograsp-{VERSION}/"
    with tarfile.open(release.sdist) as sdist:
        names = {member.name.removeprefix(top) for member in sdist.getmembers() if member.isfile()}
    about = {
        "CHANGELOG.md",
        "CITATION.cff",
        "LICENSE",
        "MANIFEST.in",
        "README.md",
        "setup.cfg",
        "pyproject.toml",
    }
    made = {name for name in names if name == "PKG-INFO" or name.startswith("thermograsp.egg-info/")}
    assert names - made == {*packaged(), *about}


def test_the_metadata(release: Release) -> None:
    with zipfile.ZipFile(release.wheel) as wheel:
        about = email.message_from_bytes(wheel.read(f"{INFO}/METADATA"))
    assert (about["Name"], about["Version"]) == ("thermograsp", VERSION)
    assert about["License-Expression"] == "Apache-2.0" and about.get_all("License-File") == ["LICENSE"]
    assert about["Requires-Python"] == ">=3.11"
    assert about["Description-Content-Type"] == "text/markdown"
    assert set(about.get_all("Provides-Extra") or ()) == set(setup()["options.extras_require"])
    assert about.get_payload(decode=True) == (ROOT / "README.md").read_bytes()


def test_an_index_would_take_it(release: Release) -> None:
    command = [sys.executable, "-m", "twine", "check", "--strict", release.wheel, release.sdist]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_files_have_names_that_say_what_they_are(release: Release) -> None:
    assert release.wheel.name == f"thermograsp-{VERSION}-py3-none-any.whl"
    assert release.sdist.name == f"thermograsp-{VERSION}.tar.gz"
    assert Path(release.rebuilt.name) == Path(release.wheel.name)
