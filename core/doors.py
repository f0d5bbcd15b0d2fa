"""Doors of rooms whose modules load when one of their names is first asked for."""

import ast
import warnings
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from importlib.util import resolve_name
from types import MappingProxyType
from typing import Any


def opened(package: str, *, renamed: Mapping[str, str] = MappingProxyType({})) -> Callable[[str], Any]:
    """A package's `__getattr__`, which carries out the package's imports under `if TYPE_CHECKING:` name by name, when
    each is first asked for. renamed: the package's names of today by old ones, which warn."""

    def __getattr__(name: str) -> Any:
        if name in renamed:
            new = f"{package}.{renamed[name]}"
            warnings.warn(f"{package}.{name} is now {new}", DeprecationWarning, stacklevel=2)
            return getattr(import_module(package), renamed[name])
        origin = _late_imports(package).get(name)
        if origin is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        if origin == package:  # a module of its own
            return import_module(f"{package}.{name}")
        value = getattr(__import__(origin, fromlist=(name,)), name)
        setattr(import_module(package), name, value)
        return value

    return __getattr__


@cache
def _late_imports(package: str) -> Mapping[str, str]:
    """Name -> module that lends it, of the imports under `if TYPE_CHECKING:` in a package's source."""
    loader: Any = import_module(package).__loader__
    found: dict[str, str] = {}
    for block in ast.parse(loader.get_source(package)).body:
        if (
            isinstance(block, ast.If)
            and isinstance(block.test, ast.Name)
            and block.test.id == "TYPE_CHECKING"
        ):
            for node in block.body:
                assert isinstance(node, ast.ImportFrom)
                origin = resolve_name("." * node.level + (node.module or ""), package)
                found |= {alias.name: origin for alias in node.names}
    return found
