"""Doors of rooms whose modules load when one of their names is first asked for."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from types import MappingProxyType
from typing import Any


def opened(
    package: str, names: Mapping[str, Sequence[str]], *, renamed: Mapping[str, str] = MappingProxyType({})
) -> Callable[[str], Any]:
    """A package's `__getattr__`. names: by module of the package, what it lends to the package;
    a module further down may lend itself.

    renamed: the package's names of today by old ones, which warn.
    The package lists the same names under TYPE_CHECKING, for type checkers and readers; a test compares the lists.
    """
    module_of = {name: module for module, each in names.items() for name in each}

    def __getattr__(name: str) -> Any:
        if name in renamed:
            new = f"{package}.{renamed[name]}"
            warnings.warn(f"{package}.{name} is now {new}", DeprecationWarning, stacklevel=2)
            return getattr(import_module(package), renamed[name])
        if name not in module_of:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        package_module = import_module(package)
        module = import_module(f"{package}.{module_of[name]}")
        value = module if module_of[name].endswith(f".{name}") else getattr(module, name)
        setattr(package_module, name, value)
        return value

    return __getattr__
