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
from thermograsp.cli.shared.versions import DEVELOPMENT
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
    """Without the module, what `do` does in an empty folder raises in `file`, and names `extra`, or the package itself
    where it is of an ecosystem that we only wrap (None). do: a function, or the words of a command."""

    file: str
    module: str
    extra: str | None
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
    Case("hardware/lines/serial_port.py", "serial", "hardware", "device list"),
    Case("hardware/lines/serial_port.py", "serial", "hardware", "device monitor /dev/null"),
    Case("hardware/drivers/modbus_line.py", "pymodbus", "hardware", "device gripper robotiq:///dev/null"),
    Case("core/mjlab/sensor.py", "mjlab", "mjlab", call("mjlab:ThermalTouchCfg", "touch")),
    Case("core/mjlab/sensor.py", "torch", "mjlab", call("mjlab:ThermalTouchCfg", "touch")),
    Case("dataset/schema.py", "pyarrow", "dataset", "dataset --episodes 1 --out made"),
    Case(
        "dataset/on_ray.py", "ray", "ray", "dataset --episodes 1 --workers 1 --ray-address local --out made"
    ),
    Case("dataset/minari_export.py", "minari", "minari", "dataset --export minari --out made"),
    Case("dataset/minari_export.py", "h5py", "minari", "dataset --export minari --out made"),
    Case("dataset/lerobot_export.py", "lerobot", "lerobot", "dataset --export lerobot --out made"),
    Case("core/lerobot/hand.py", "lerobot", "lerobot", call("lerobot:ThermograspHand")),
    Case("dataset/reading.py", "torch", "torch", call("dataset:load", ".", library="torch")),
    Case(
        "benchmarks/accuracy/elements.py",
        "skfem",
        "bench",
        call("bench.accuracy.elements:element_press", None, 4),
    ),
    Case(
        "benchmarks/accuracy/fipy_press.py",
        "fipy",
        "bench",
        call("bench.accuracy.fipy_press:fipy_press", None, 0.02, 9, 1e-3),
    ),
    Case(
        "benchmarks/identify/rivals.py",
        "sklearn",
        "bench",
        call("bench.identify.rivals:support_vectors", None, None, 1.0),
    ),
    Case(
        "benchmarks/identify/rivals.py",
        "torch",
        "torch",
        call("bench.identify.rivals:recurrent_net", None, None, (), 2, 0),
    ),
    Case("envs/bodies/meshes.py", "vhacdx", "mesh", cup),
    Case("envs/sb3.py", "stable_baselines3", "rl", call("envs.sb3:StableBaselinesVecEnv")),
    Case("agents/learning/training.py", "tensorboard", "rl", "train identify --steps 100"),
    Case("agents/learning/training.py", "stable_baselines3", "rl", "train identify --steps 100"),
    Case("studio/web/server.py", "websockets", "view", "view --port 0"),
    Case("touch/wrappers/dm_control.py", "dm_env", None, call("touch.wrappers:DmControlThermalWrapper")),
    Case("touch/wrappers/robosuite.py", "robosuite", None, call("touch.wrappers:RobosuiteThermalWrapper")),
)
INDIRECT = {("envs/bodies/meshes.py", "vhacdx")}
"""Imported by another package for us: trimesh."""
BEHIND_TRAINING = {
    ("agents/learning/imitation.py", "torch"),
    ("agents/learning/perceiving.py", "stable_baselines3"),
    ("agents/learning/training.py", "torch"),
}
"""The command comes to them when training.py has found stable-baselines3, which brings PyTorch."""
BY_MJLAB = {
    *((f"core/mjlab/{file}.py", "mjlab") for file in ("__init__", "keep_cube", "sort_cubes", "tasks")),
    ("core/mjlab/recording.py", "torch"),
}
"""mjlab itself imports its tasks; the door goes on without it. The sensor imports recordings behind PyTorch."""
WHERE_INSTALLED = {
    ("benchmarks/speed/fetch.py", "gymnasium_robotics"),
    ("touch/scene/own_shape.py", "manifold3d"),
}
"""The benchmark leaves its rows out elsewhere; of geoms that are not fused a warning in the log names the extra."""
BY_NUMBA = {
    ("touch/pointers/calls.py", "llvmlite"),
    ("core/lanes.py", "llvmlite"),
    ("touch/wrappers/clock.py", "llvmlite"),
}
"""numba cannot be installed without it."""
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
    folders = (line.split("=")[1].strip() for line in SETUP["options"]["package_dir"].split("\n") if line)
    for folder in folders:
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


def packaged(file: str) -> str:
    """A file's path below the root package."""
    return re.sub("^benchmarks/", "bench/", file.removeprefix("core/"))


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Hide:
    """Hides a module, and the modules of ours that have it already."""

    def hide(module: str, file: str) -> None:
        for name in list(sys.modules):
            if name.split(".")[0] == module:
                monkeypatch.delitem(sys.modules, name)
        ours = packaged(file).removesuffix(".py").replace("/", ".")
        monkeypatch.delitem(sys.modules, f"thermograsp.{ours}", raising=False)
        package, _, name = f"thermograsp.{ours}".rpartition(".")
        if name in vars(sys.modules.get(package, object)):
            monkeypatch.delattr(sys.modules[package], name)
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

    def note(error: MissingDependencyError, *words: object) -> None:
        raised.append((sys._getframe(1).f_code.co_filename, str(words[0])))
        ImportError.__init__(error, *words)

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
    assert file.endswith(packaged(case.file))
    assert "\n" not in message
    if case.extra:
        assert f"pip install 'thermograsp[{case.extra}]'" in message and case.module in brought(case.extra)
    else:
        assert re.search(r"pip install (dm-control|robosuite)$", message)
    assert not list(Path().glob("made*"))


def test_every_optional_import_is_among_the_cases() -> None:
    assert {(case.file, case.module) for case in CASES} - INDIRECT == set(
        imported()
    ) - BY_MJLAB - BY_NUMBA - WHERE_INSTALLED - BEHIND_TRAINING


def test_every_extra_is_named_by_a_case() -> None:
    extras = set(SETUP["options.extras_require"]) - DEVELOPMENT - NEVER_NAMED
    assert {case.extra for case in CASES if case.extra} == extras
    modules = set[str]().union(*(brought(extra) for extra in extras))
    assert {case.module for case in CASES if case.extra} == modules - {
        module for _, module in WHERE_INSTALLED
    }


def test_an_import_by_function_is_seen() -> None:
    source = "import a\nfrom b.c import d\nfrom . import e\nimportlib.import_module('f')\nfind_spec('g.h')"
    assert list(names_imported(ast.parse(source))) == ["a", "b.c", "f", "g.h"]
