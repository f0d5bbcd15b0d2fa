"""Where an optional package is missing, one line says which extra brings it: for every import of one in the source."""

import ast
import configparser
import importlib
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from thermograsp.cli import main
from thermograsp.cli.versions import OWN_WORK
from thermograsp.errors import MissingDependencyError

ROOT = Path(__file__).parents[1]
SETUP = configparser.ConfigParser()
SETUP.read(ROOT / "setup.cfg", encoding="utf-8")
MODULES = {
    "pillow": "PIL",
    "pyserial": "serial",
    "scikit-fem": "skfem",
    "scikit-learn": "sklearn",
    "stable-baselines3": "stable_baselines3",
}
"""What is imported of a package of another name."""


@dataclass(frozen=True, slots=True)
class Case:
    """Without the module, what `do` does in an empty folder raises in `file`, and names `extra`. do: a function, or the
    words of a command."""

    file: str
    module: str
    extra: str
    do: Callable[[], object] | str


def call(path: str, *given: object, **keywords: object) -> Callable[[], object]:
    """A function of ours, found when it is called: `module:name`."""
    module, name = path.split(":")

    def do() -> object:
        return getattr(importlib.import_module(f"thermograsp.{module}"), name)(*given, **keywords)

    return do


def cup() -> object:
    """A mesh in two convex pieces."""
    import trimesh

    from thermograsp.envs import load_mesh

    trimesh.creation.annulus(0.01, 0.02, 0.03).export("ring.stl")
    return load_mesh("ring.stl", pieces=4)


CASES = (
    Case("hardware/serial_port.py", "serial", "hardware", "device list"),
    Case("hardware/serial_port.py", "serial", "hardware", "device monitor /dev/null"),
    Case("hardware/modbus_line.py", "pymodbus", "hardware", "device gripper robotiq:///dev/null"),
    Case("core/dataset/schema.py", "pyarrow", "dataset", "dataset --episodes 1 --out made"),
    Case("core/dataset/on_ray.py", "ray", "ray", "dataset --episodes 1 --workers 1 --out made"),
    Case("core/dataset/minari_export.py", "minari", "minari", "dataset --export minari --out made"),
    Case("core/dataset/minari_export.py", "h5py", "minari", "dataset --export minari --out made"),
    Case("core/dataset/reading.py", "torch", "torch", call("dataset:load", ".", library="torch")),
    Case("core/bench/elements.py", "skfem", "bench", call("bench.elements:element_press", None, 4)),
    Case(
        "core/bench/fipy_press.py", "fipy", "bench", call("bench.fipy_press:fipy_press", None, 0.02, 9, 1e-3)
    ),
    Case("core/bench/rivals.py", "sklearn", "bench", call("bench.rivals:support_vectors", None, None, 1.0)),
    Case("core/bench/rivals.py", "torch", "torch", call("bench.rivals:recurrent_net", None, None, (), 2, 0)),
    Case("envs/meshes.py", "vhacdx", "mesh", cup),
    Case("envs/sb3.py", "stable_baselines3", "rl", call("envs.sb3:StableBaselinesVecEnv")),
    Case("core/view/server.py", "websockets", "view", "view --port 0"),
)
INDIRECT = {("envs/meshes.py", "vhacdx")}
"""Imported by another package for us: trimesh."""
NEVER_NAMED = {"jax", "fem"}
"""thermal.array_fingertips takes its functions from the arrays that it is given; fem is a part of bench."""


def packages(text: str) -> set[str]:
    names: list[str] = re.findall(r"^(?!#|thermograsp)[\w-]+", text, re.MULTILINE)
    return {MODULES.get(name, name) for name in names}


def brought(extra: str) -> set[str]:
    """Modules that an extra brings, with those of the extras in it."""
    text = SETUP["options.extras_require"][extra]
    within = [
        name for names in re.findall(r"^thermograsp\[(.*)\]", text, re.MULTILINE) for name in names.split(",")
    ]
    return packages(text).union(*map(brought, within), {"h5py"} if "minari[hdf5]" in text else set())


def imported() -> Iterator[tuple[str, str]]:
    """(file, module) of every import in the source, by statement or by function, that the package may lack."""
    always = packages(SETUP["options"]["install_requires"]) | {"thermograsp"} | set(sys.stdlib_module_names)
    for folder in ("core", "thermal", "envs", "hardware", "assets"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for name in names_imported(ast.parse(path.read_text(encoding="utf-8"))):
                if name.split(".")[0] not in always:
                    yield str(path.relative_to(ROOT)), name.split(".")[0]


def names_imported(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module or ""
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in ("import_module", "find_spec", "__import__"):
                yield str(node.args[0].value)


Hide = Callable[[str, str], None]


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Hide:
    """Hides a module, and the modules of ours that have it already."""

    def hide(module: str, file: str) -> None:
        for name in list(sys.modules):
            if name.split(".")[0] == module:
                monkeypatch.delitem(sys.modules, name)
        ours = file.removesuffix(".py").removeprefix("core/").replace("/", ".")
        monkeypatch.delitem(sys.modules, f"thermograsp.{ours}", raising=False)
        monkeypatch.setitem(sys.modules, module, None)

    monkeypatch.chdir(tmp_path)
    return hide


@pytest.mark.parametrize(
    "case", CASES, ids=[f"{case.file} {case.module} {i}" for i, case in enumerate(CASES)]
)
def test_a_missing_package_is_one_line_with_its_extra(
    case: Case,
    without: Hide,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    raised: list[tuple[str, str]] = []

    def note(error: MissingDependencyError, *told: object) -> None:
        raised.append((sys._getframe(1).f_code.co_filename, str(told[0])))
        ImportError.__init__(error, *told)

    monkeypatch.setattr(MissingDependencyError, "__init__", note)
    without(case.module, case.file)
    if isinstance(case.do, str):
        assert main(case.do.split()) == 2
        out, err = capsys.readouterr()
        assert out == "" and err == f"thermograsp: {raised[-1][1]}\n"
    else:
        with pytest.raises(MissingDependencyError):
            case.do()
    ((file, message),) = raised
    assert file.endswith(case.file.removeprefix("core/"))
    assert "\n" not in message
    (extra,) = re.findall(r"pip install 'thermograsp\[(\w+)\]'", message)
    assert extra == case.extra and case.module in brought(extra)
    assert not list(Path().glob("made*"))


def test_every_optional_import_is_among_the_cases() -> None:
    assert {(case.file, case.module) for case in CASES} - INDIRECT == set(imported())


def test_every_extra_is_named_by_a_case() -> None:
    extras = set(SETUP["options.extras_require"]) - OWN_WORK - NEVER_NAMED
    assert {case.extra for case in CASES} == extras
    modules = set[str]().union(*(brought(extra) for extra in extras))
    assert {case.module for case in CASES} == modules


def test_an_import_by_function_is_seen() -> None:
    source = "import a\nfrom b.c import d\nfrom . import e\nimportlib.import_module('f')\nfind_spec('g.h')"
    assert list(names_imported(ast.parse(source))) == ["a", "b.c", "f", "g.h"]
