"""docs/extending.md names the files that take a contact force to a voltage: they are there, and call each other."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_TEXT = (ROOT / "docs/extending.md").read_text(encoding="utf-8").partition("to voltage in six files")[2]
_ROWS = [
    tuple(cell.strip().strip("`") for cell in line.strip("|").split("|"))
    for line in _TEXT.splitlines()
    if re.match(r"\| \w+/", line)
]
_METHODS = re.findall(r"`(\w+)\.(\w+)`\s*\((\w[\w/]*\.py)\)", _TEXT)


def _tree(file: str) -> ast.Module:
    return ast.parse((ROOT / file).read_text(encoding="utf-8"))


def _defined(tree: ast.AST) -> set[str]:
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


def _called(tree: ast.AST) -> set[str]:
    calls = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return {func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "") for func in calls}


def test_there_are_six_files_and_one_plant_that_calls_three_methods() -> None:
    assert len({row[0] for row in _ROWS}) == len(_ROWS) == 6
    assert len(_METHODS) == 4


@pytest.mark.parametrize("row", _ROWS, ids=lambda row: row[0])
def test_each_function_is_in_its_file_and_is_called_from_where_it_says(row: tuple[str, ...]) -> None:
    file, functions, *_, caller = row
    for function in functions.replace("`", "").split(", "):
        assert function in _defined(_tree(file))
        assert function in _called(_tree(caller))


def test_the_plant_s_step_calls_the_methods() -> None:
    (_, step, plant), *methods = _METHODS
    body = next(n for n in ast.walk(_tree(plant)) if isinstance(n, ast.FunctionDef) and n.name == step)
    moves = next(n for n in ast.walk(_tree(plant)) if isinstance(n, ast.FunctionDef) and n.name == "_move")
    for owner, method, file in methods:
        classes = [n for n in ast.walk(_tree(file)) if isinstance(n, ast.ClassDef) and n.name == owner]
        assert classes and method in _defined(classes[0])
        assert method in _called(body) | _called(moves)


def test_every_caller_is_a_file_of_the_page() -> None:
    """So that nothing on the way is left out."""
    named = {row[0] for row in _ROWS} | {file for *_, file in _METHODS}
    assert {row[-1] for row in _ROWS} <= named
