"""The hash of sources follows every import of ours and nothing else."""

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import thermograsp
from thermograsp.sources import imported_modules, source_hash

ROOT = Path(thermograsp.__file__).parent


def imports_by_syntax(module: str) -> set[str]:
    """As Python's own parser finds them."""
    found: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name not in found and (imported := imports_of(name)) is not None:
            found.add(name)
            waiting += imported
    return found


@cache
def imports_of(module: str) -> tuple[str, ...] | None:
    """By one source of ours; None for what is no module of ours."""
    parts = module.split(".")
    folder = ROOT.joinpath(*parts[1:])
    path = folder / "__init__.py" if (folder / "__init__.py").is_file() else folder.with_suffix(".py")
    if parts[0] != "thermograsp" or not path.is_file():
        return None
    package = parts if path.name == "__init__.py" else parts[:-1]
    found: list[str] = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) + 1 - node.level] if node.level else []
            origin = ".".join([*base, *([node.module] if node.module else [])])
            found += [origin, *(f"{origin}.{alias.name}" for alias in node.names)]
    return tuple(found)


@pytest.mark.parametrize(
    "module",
    [
        "thermal.network.cached",
        "thermal.meshes.touched",
        "thermal.identification.library",
        "envs.bodies.library",
    ],
)
def test_every_import_is_followed(module: str) -> None:
    found = imported_modules(f"thermograsp.{module}")
    assert imports_by_syntax(f"thermograsp.{module}") <= found
    assert {f"thermograsp.{module}", "thermograsp.errors"} < found


def test_a_hash_is_of_the_sources_alone() -> None:
    modules = ("thermograsp.thermal.network.cached", "thermograsp.errors", "numpy", "__main__")
    code = f"from thermograsp.sources import source_hash\nfor m in {modules}: print(source_hash(m))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [source_hash(module) for module in modules]
    network, errors, others, main = done.stdout.split()
    assert len({network, errors, others}) == 3 and main == others


def test_an_edit_anywhere_below_changes_the_hash(tmp_path: Path) -> None:
    """Of a copy; an edit beside it changes nothing."""
    code = "from thermograsp.sources import source_hash; print(source_hash('thermograsp.thermal.door'))"
    files = {
        "thermograsp/__init__.py": "",
        "thermograsp/sources.py": (ROOT / "sources.py").read_text(),
        "thermograsp/errors.py": "",
        "thermograsp/beside.py": "",
        "thermograsp/thermal/__init__.py": "from .beside import x",
        "thermograsp/thermal/beside.py": "x = 1",
        "thermograsp/thermal/door/__init__.py": "from .one import (\n    a as a,\n    b,\n)",
        "thermograsp/thermal/door/one.py": "def b():\n    from ..below import two\n\na = 1",
        "thermograsp/thermal/below/__init__.py": "",
        "thermograsp/thermal/below/two.py": "import thermograsp.errors",
    }
    for name, content in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(content)

    def hashed() -> str:
        return subprocess.run(
            [sys.executable, "-B", "-S", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
        ).stdout

    first = hashed()
    for name in ("beside", "thermal/beside"):
        (tmp_path / f"thermograsp/{name}.py").write_text("x = 2")
    assert hashed() == first
    hashes = {first}
    for name in ("errors", "thermal/door/one", "thermal/below/__init__", "thermal/below/two"):
        path = tmp_path / f"thermograsp/{name}.py"
        path.write_text(path.read_text() + "\n# edited\n")
        hashes.add(hashed())
    assert len(hashes) == 5
