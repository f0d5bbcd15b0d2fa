"""A hash of the sources that make a result: what an older version of the code kept on disk is never read back."""

import hashlib
import re
from functools import cache
from pathlib import Path

_ROOT = Path(__file__).parent
_PACKAGE = __name__.partition(".")[0]
_IMPORT = re.compile(r"^[ \t]*from[ \t]+(\.*)([\w.]*)[ \t]+import[ \t]+(\([^)]*\)|[^\n#]*)", re.MULTILINE)
_PLAIN_IMPORT = re.compile(r"^[ \t]*import[ \t]+([\w.]+)", re.MULTILINE)


@cache
def source_hash(module: str) -> str:
    """Hash of the source of a module and of all modules of this package that it imports, straight or through others.

    module: dotted name. One of another package, whose sources are not ours to follow, gives the same hash always. A
    process reads the files once: tens of milliseconds for a room in the middle of the house.
    """
    total = hashlib.sha256()
    for name in sorted(imported_modules(module)):
        total.update(f"{name}\0{_content(name)}\0".encode())
    return total.hexdigest()


def imported_modules(module: str) -> set[str]:
    """A module of this package and all others of it that it imports, also where only a type checker or a function
    does; empty for a module of another package."""
    found: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name not in found and _file(name) is not None:
            found.add(name)
            waiting += _imports(name)
    return found


@cache
def _imports(module: str) -> frozenset[str]:
    """What the import statements of a source may load: modules, and names that may turn out to be none."""
    path = _file(module)
    assert path is not None
    source = path.read_text(encoding="utf-8")
    package = module.split(".") if path.name == "__init__.py" else module.split(".")[:-1]
    found = set(_PLAIN_IMPORT.findall(source))
    for dots, origin, names in _IMPORT.findall(source):
        base = package[: len(package) + 1 - len(dots)] if dots else []
        origin = ".".join([*base, *([origin] if origin else [])])
        found.add(origin)
        found |= {f"{origin}.{name}" for name in re.findall(r"(\w+)(?:\s+as\s+\w+)?", names)}
    return frozenset(found)


@cache
def _content(module: str) -> str:
    path = _file(module)
    assert path is not None
    return hashlib.sha256(path.read_bytes()).hexdigest()


@cache
def _file(module: str) -> Path | None:
    """The source of a module of this package."""
    package, *parts = module.split(".")
    if package != _PACKAGE:
        return None
    folder = _ROOT.joinpath(*parts)
    if (door := folder / "__init__.py").is_file():
        return door
    file = folder.with_suffix(".py")
    return file if parts and file.is_file() else None
