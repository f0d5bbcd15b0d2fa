"""The public names of a package, as autodoc's directives in Markdown."""

from __future__ import annotations

import ast
import importlib
import inspect
from types import ModuleType

from sphinx.pycode import ModuleAnalyzer

_LONGEST = 300  # characters of a constant's value that a page shows


def public_names(package: str) -> str:
    """Functions, classes, errors and constants of `__all__`, each under a heading, in alphabetical order. Raises
    ValueError for a constant without a text below it."""
    module = importlib.import_module(package)
    groups: dict[str, list[str]] = {"Functions": [], "Classes": [], "Errors": [], "Constants": []}
    for name in sorted(module.__all__, key=str.casefold):
        value = getattr(module, name)
        if inspect.isclass(value):
            kind = "Errors" if issubclass(value, BaseException) else "Classes"
            groups[kind].append(_class(f"{package}.{name}", value))
        elif inspect.isroutine(inspect.unwrap(value)):
            groups["Functions"].append(f".. autofunction:: {package}.{name}")
        else:
            groups["Constants"].append(_constant(module, name, value))
    return "\n".join(
        f"## {title}\n\n```{{eval-rst}}\n" + "\n\n".join(entries) + "\n```\n"
        for title, entries in groups.items()
        if entries
    )


def _class(path: str, value: type) -> str:
    lines = [f".. autoclass:: {path}", "   :members:"]
    fields = getattr(value, "_fields", None)
    if fields:  # a named tuple's have texts of their own that say nothing
        lines.append(f"   :exclude-members: {', '.join([*fields, 'count', 'index'])}")
    return "\n".join(lines)


def _constant(module: ModuleType, name: str, value: object) -> str:
    lines = [f".. py:data:: {module.__name__}.{name}"]
    shown = repr(value)
    if len(shown) <= _LONGEST and " at 0x" not in shown:
        lines.append(f"   :value: {shown}")
    lines += ["", "   .. markdown::", "", *("      " + line for line in _text(module, name))]
    return "\n".join(lines)


def _text(module: ModuleType, name: str) -> list[str]:
    """What stands below the assignment in the module that `module` takes the name from."""
    for node in ast.parse(inspect.getsource(module)).body:
        if isinstance(node, ast.ImportFrom) and name in {alias.name for alias in node.names}:
            analyzer = ModuleAnalyzer.for_module(f"{module.__name__}.{node.module}")
            text = analyzer.find_attr_docs().get(("", name))
            if text:
                return text
    raise ValueError(f"{module.__name__}.{name} has no text: put one in triple quotes below its assignment")
