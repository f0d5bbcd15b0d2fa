"""The public names of a package: as tables for a page's file, and as autodoc's directives for the site."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import inspect
import re
from types import ModuleType

from sphinx.pycode import ModuleAnalyzer

_LONGEST = 300  # characters of a constant's value that a page shows


def public_names(package: str) -> str:
    """Functions, classes, errors and constants of `__all__`, each under a heading, in alphabetical order. Raises
    ValueError for a constant without a text below it."""
    module = importlib.import_module(package)
    directives = {
        "Functions": lambda name, value: f".. autofunction:: {package}.{name}",
        "Classes": lambda name, value: _class(f"{package}.{name}", value),
        "Errors": lambda name, value: _class(f"{package}.{name}", value),
        "Constants": lambda name, value: _constant(module, name, value),
    }
    return "\n".join(
        f"## {kind}\n\n```{{eval-rst}}\n"
        + "\n\n".join(directives[kind](name, value) for name, value in names)
        + "\n```\n"
        for kind, names in _by_kind(module).items()
    )


def name_tables(package: str) -> str:
    """The same names, each with its parameters and the first sentence of its text. Raises as public_names does."""
    module = importlib.import_module(package)
    sections = []
    for kind, names in _by_kind(module).items():
        rows = "".join(
            f"| `{name}{_parameters(value)}` | {_first_sentence(_summary(module, kind, name, value))} |\n"
            for name, value in names
        )
        sections.append(f"## {kind}\n\n| name | what |\n|---|---|\n{rows}")
    return "\n".join(sections)


def _by_kind(module: ModuleType) -> dict[str, list[tuple[str, object]]]:
    """Names and values of `__all__` in alphabetical order, by the heading under which they stand."""
    kinds: dict[str, list[tuple[str, object]]] = {
        "Functions": [],
        "Classes": [],
        "Errors": [],
        "Constants": [],
    }
    for name in sorted(module.__all__, key=str.casefold):
        value = getattr(module, name)
        if inspect.isclass(value):
            kind = "Errors" if issubclass(value, BaseException) else "Classes"
        else:
            kind = "Functions" if inspect.isroutine(inspect.unwrap(value)) else "Constants"
        kinds[kind].append((name, value))
    return {kind: names for kind, names in kinds.items() if names}


def _parameters(value: object) -> str:
    """Of a function, their names as a call has them; those with a default end in "=..."."""
    if not inspect.isroutine(inspect.unwrap(value)):  # pyright: ignore[reportArgumentType]
        return ""
    shown: list[str] = []
    for parameter in inspect.signature(value).parameters.values():  # pyright: ignore[reportArgumentType]
        stars = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
        if parameter.kind is parameter.KEYWORD_ONLY and not any(name.startswith("*") for name in shown):
            shown.append("*")
        shown.append(stars + parameter.name + ("" if parameter.default is parameter.empty else "=..."))
    return f"({', '.join(shown)})"


def _summary(module: ModuleType, kind: str, name: str, value: object) -> str:
    return "\n".join(_text(module, name)) if kind == "Constants" else inspect.getdoc(value) or ""


def _first_sentence(text: str) -> str:
    """Of its first paragraph, as a cell of a table."""
    paragraph = " ".join(text.strip().split("\n\n")[0].split())
    sentence = re.split(r"(?<=\.)\s+(?=[A-Z])", paragraph, maxsplit=1)[0]
    return sentence.replace("|", "\\|").replace("<", "&lt;")


def _class(path: str, value: type) -> str:
    ours = value.__module__.startswith(f"{path.rpartition('.')[0]}.")
    # One of another package is indexed under its own name, and links lead to it under this one too.
    anchor = [] if ours else [".. raw:: html", "", f'   <span id="{path}"></span>', ""]
    lines = [*anchor, f".. autoclass:: {path}", "   :members:"]
    fields = getattr(value, "_fields", None)
    if fields:  # a named tuple's have texts of their own that say nothing
        lines.append(f"   :exclude-members: {', '.join([*fields, 'count', 'index'])}")
    if not ours:
        lines.append("   :no-index:")
    return "\n".join(lines)


def _constant(module: ModuleType, name: str, value: object) -> str:
    lines = [f".. py:data:: {module.__name__}.{name}"]
    shown = repr(value)
    if len(shown) <= _LONGEST and " at 0x" not in shown:
        lines.append(f"   :value: {shown}")
    lines += ["", "   .. markdown::", "", *("      " + line for line in _text(module, name))]
    return "\n".join(lines)


def _text(module: ModuleType, name: str) -> list[str]:
    """What stands below the assignment of a constant, which `module` may have from another module of ours."""
    text = ModuleAnalyzer.for_module(module.__name__).find_attr_docs().get(("", name))
    if text:
        return text
    for node in ast.walk(ast.parse(inspect.getsource(module))):
        if isinstance(node, ast.ImportFrom) and name in {alias.name for alias in node.names}:
            origin = importlib.util.resolve_name("." * node.level + (node.module or ""), module.__package__)
            return _text(importlib.import_module(origin), name)
    raise ValueError(f"{module.__name__}.{name} has no text: put one in triple quotes below its assignment")
