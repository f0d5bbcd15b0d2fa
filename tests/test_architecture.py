"""Which folder may import which, read from the source, and what an import loads, read from a fresh interpreter."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = ("assets", "thermal", "envs", "hardware")
LEAVES = ("errors", "files", "plant")
ALL = {"root", "bench", "cli", "dataset", "report", "twin", "view", *LEAVES, *FOLDERS}
MAY_IMPORT = {
    "root": set(),
    "errors": set(),
    "files": {"errors"},
    "plant": {"errors"},
    "assets": set(),
    "thermal": {*LEAVES, "assets"},
    "envs": {*LEAVES, "assets", "thermal"},
    "hardware": {*LEAVES, "assets", "thermal"},
    "__main__": ALL,
    "bench": ALL,
    "cli": ALL,
    "dataset": ALL,
    "report": ALL,
    "twin": ALL,
    "view": ALL,
}


def sources() -> list[Path]:
    return [path for folder in ("core", *FOLDERS) for path in sorted((ROOT / folder).rglob("*.py"))]


def module_of(path: Path) -> tuple[str, str]:
    """Dotted name of a source file's module, and of the package that its relative imports start from."""
    parts = list(path.relative_to(ROOT).with_suffix("").parts)
    parts = ["thermograsp", *parts[1:]] if parts[0] == "core" else ["thermograsp", *parts]
    if parts[-1] == "__init__":
        return ".".join(parts[:-1]), ".".join(parts[:-1])
    return ".".join(parts), ".".join(parts[:-1])


def room(module: str) -> str | None:
    """The row of the table that a module belongs to; None for other people's modules."""
    parts = module.split(".")
    if parts[0] != "thermograsp":
        return None
    return parts[1] if len(parts) > 1 and parts[1] in MAY_IMPORT else "root"


def imports(source: str, package: str) -> Iterator[tuple[str, bool, int]]:
    """(module, relative, line) of each import anywhere in the source."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, False, node.lineno
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            module = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                yield (
                    f"{module}.{alias.name}" if module == "thermograsp" else module,
                    node.level > 0,
                    node.lineno,
                )


def breaches(source: str, module: str, package: str) -> list[str]:
    here = room(module)
    assert here is not None
    found = []
    for target, relative, line in imports(source, package):
        there = room(target)
        if there is None or there == here:
            continue
        if there not in MAY_IMPORT[here]:
            found.append(f"{module}, line {line}: {here} must not import {target}")
        elif here in FOLDERS and relative != (there in FOLDERS):
            found.append(
                f"{module}, line {line}: import {target} {'absolutely' if relative else 'relatively'}"
            )
        elif here not in FOLDERS and relative:
            found.append(f"{module}, line {line}: import {target} absolutely")
    return found


@pytest.mark.parametrize("path", sources(), ids=lambda path: str(path.relative_to(ROOT)))
def test_a_file_imports_only_what_its_folder_may(path: Path) -> None:
    assert not breaches(path.read_text(encoding="utf-8"), *module_of(path))


@pytest.mark.parametrize(
    ("line", "module", "package"),
    [
        ("from ..envs import scene", "thermograsp.thermal.press", "thermograsp.thermal"),
        ("from .. import envs", "thermograsp.thermal.press", "thermograsp.thermal"),
        ("from ..envs.scene import x", "thermograsp.hardware", "thermograsp.hardware"),
        ("from thermograsp.thermal import material", "thermograsp.envs.scene", "thermograsp.envs"),
        ("import thermograsp.thermal", "thermograsp.envs.scene", "thermograsp.envs"),
        ("from ..errors import positive", "thermograsp.thermal.press", "thermograsp.thermal"),
        ("from thermograsp.cli import main", "thermograsp.hardware.wire", "thermograsp.hardware"),
        ("def f():\n    from thermograsp import files", "thermograsp.errors", "thermograsp"),
        ("from thermograsp import thermal", "thermograsp", "thermograsp"),
        ("from ..thermal import press", "thermograsp.cli.press", "thermograsp.cli"),
    ],
)
def test_a_wrong_arrow_is_seen(line: str, module: str, package: str) -> None:
    assert len(breaches(line, module, package)) == 1


@pytest.mark.parametrize(
    ("line", "module", "package"),
    [
        ("from ..thermal import press", "thermograsp.envs.scene", "thermograsp.envs"),
        ("from ...assets import asset", "thermograsp.thermal.solvers.grid", "thermograsp.thermal.solvers"),
        ("from .layers import Layer\nimport numpy", "thermograsp.thermal.press", "thermograsp.thermal"),
        ("from thermograsp.errors import positive", "thermograsp.thermal.press", "thermograsp.thermal"),
        ("from thermograsp import envs, hardware", "thermograsp.cli.press", "thermograsp.cli"),
    ],
)
def test_a_right_arrow_passes(line: str, module: str, package: str) -> None:
    assert not breaches(line, module, package)


@pytest.mark.parametrize(
    ("module", "unwanted"),
    [
        ("thermograsp", ("mujoco", "numba", "scipy", "matplotlib")),
        ("thermograsp.thermal", ("mujoco", "matplotlib")),
        ("thermograsp.hardware", ("mujoco", "matplotlib")),
    ],
)
def test_an_import_stays_light(module: str, unwanted: tuple[str, ...]) -> None:
    code = f"import sys, {module}; print([name for name in {unwanted!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
