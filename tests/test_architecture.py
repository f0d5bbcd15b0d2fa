"""The house: which room may import which, that rooms are entered by their doors, and that nothing runs in a circle.

A folder is a top-level folder of the repository; a room is a package in one. The door of a room is its `__init__`.
"""

import ast
import graphlib
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

LEAVES = (
    "errors",
    "notice",
    "sources",
    "files",
    "columns",
    "plant",
    "doors",
    "beside",
    "compiled",
    "lanes",
    "opengl",
)
"""Modules and rooms of the root package that everybody may import; each may import those before it."""

FOLDERS = {
    "assets": "assets",
    "thermal": "thermal",
    "touch": "touch",
    "envs": "envs",
    "hardware": "hardware",
    "figures": "figures",
    "agents": "agents",
    "dataset": "dataset",
    "twin": "twin",
    "reports": "reports",
    "bench": "benchmarks",
    "studio": "studio",
    "mjlab": "core/mjlab",
    "lerobot": "core/lerobot",
    "cli": "core/cli",
}
"""Folder of each package below the root."""

MAY_IMPORT = {
    "assets": (),
    "thermal": ("assets",),
    "touch": ("assets", "thermal"),
    "envs": ("assets", "thermal", "touch"),
    "hardware": ("assets", "thermal"),
    "figures": ("assets", "thermal", "touch", "envs"),
    "agents": ("assets", "thermal", "touch", "envs", "figures"),
    "dataset": ("assets", "thermal", "touch", "envs", "agents"),
    "twin": ("assets", "thermal", "touch", "envs", "hardware", "agents"),
    "reports": ("assets", "thermal", "touch", "envs", "figures", "agents"),
    "bench": ("assets", "thermal", "touch", "envs", "figures", "agents"),
    "studio": ("assets", "thermal", "touch", "envs", "hardware", "figures", "agents", "twin"),
    "mjlab": ("assets", "thermal", "touch"),
    "lerobot": ("hardware",),
    "cli": tuple(folder for folder in FOLDERS if folder != "cli"),
}
"""Folder -> the other folders that it may import; all may import the leaves."""

ROOMS = {
    "thermal": (
        "numerics",
        "matter",
        "surfaces",
        "contact",
        "pressed",
        "plates",
        "kernels",
        "padded",
        "unrolled",
        "readout",
        "network",
        "stack",
        "curves",
        "batch",
        "rungs",
        "meshes",
        "anywhere",
        "fitting",
        "identification",
        "measured",
    ),
    "envs": (
        "limits",
        "bodies",
        "grippers",
        "mechanics",
        "footprint",
        "sensing",
        "readout",
        "spaces",
        "plant",
        "tasks",
        "pictures",
        "gym",
        "sb3",
        "senses",
        "taxels",
    ),
    "touch": (
        "pointers",
        "scene",
        "contacts",
        "heat",
        "draw",
        "fixed_touch",
        "readings",
        "watch",
        "heard",
        "given",
        "ahead",
        "thermal_touch",
        "engine",
        "wrappers",
    ),
    "hardware": ("errors", "protocol", "lines", "drivers", "recordings", "emulators", "plant"),
    "studio": ("control", "sources", "session", "web"),
    "reports": ("demo", "paper"),
    "bench": (
        "kinds",
        "measured_on",
        "accuracy",
        "stability",
        "grasp",
        "speed",
        "episode",
        "identify",
        "peer",
        "stopping",
    ),
}
"""Rooms (and single files) of a folder, from the ground up: each may import those before it."""

COMMON = ("thermograsp.envs.limits", "thermograsp.envs.sb3", "thermograsp.hardware.errors")
"""Files of a folder that belong to no room; other folders may import them."""

LENT_BY_THE_ROOT = {
    "thermograsp": ("thermograsp.touch", "thermograsp.wrappers"),
    "thermograsp.wrappers": ("thermograsp.touch.wrappers",),
}
"""Modules of the root package -> those whose names they lend when they are asked for; their own import stays light."""

MOST_FILES = 12  # of a room, its door not counted


def package_of(path: Path) -> str:
    """Dotted name of a source file's module."""
    relative = path.relative_to(ROOT).with_suffix("")
    for package, folder in (*FOLDERS.items(), ("", "core")):
        if relative.is_relative_to(folder):
            parts = ["thermograsp", *([package] if package else []), *relative.relative_to(folder).parts]
            return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
    raise AssertionError(path)


SOURCES = {
    package_of(path): path
    for folder in dict.fromkeys((*FOLDERS.values(), "core"))
    for path in sorted((ROOT / folder).rglob("*.py"))
}
PACKAGES = {module for module, path in SOURCES.items() if path.name == "__init__.py"}


def _tree(source: str) -> ast.Module:
    """Parsed again where Python 3.11 miscounts the depth of a tree and raises SystemError, as beside a thread."""
    try:
        return ast.parse(source)
    except SystemError:
        return ast.parse(source)


@cache
def imports(module: str, source: str) -> tuple[tuple[str, bool, int], ...]:
    """(module, relative, line) of each import anywhere in the source of one of our modules."""
    package = module if module in PACKAGES else module.rpartition(".")[0]
    found: list[tuple[str, bool, int]] = []
    for node in ast.walk(_tree(source)):
        if isinstance(node, ast.Import):
            found += [(alias.name, False, node.lineno) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            target = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                whole = f"{target}.{alias.name}"
                found.append((whole if whole in SOURCES else target, node.level > 0, node.lineno))
    return tuple(found)


def place(module: str) -> tuple[str, str]:
    """Folder and room of one of our modules; ("", leaf) for a leaf, ("", "") for the root itself."""
    parts = module.split(".")[1:]
    if not parts or parts[0] not in FOLDERS:
        return "", parts[0] if parts else ""
    return parts[0], parts[1] if len(parts) > 1 else ""


def open_to_others(module: str) -> bool:
    """Whether others may import a module itself: a door, a file of no room, or one that its door names."""
    package, _, name = module.rpartition(".")
    return module in PACKAGES or module in COMMON or name in lent(package)


@cache
def lent(package: str) -> frozenset[str]:
    """The names in a door's `__all__`."""
    for node in _tree(SOURCES[package].read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.List):
            return frozenset(ast.literal_eval(node.value))
    return frozenset()


def breaches(module: str, source: str) -> list[str]:
    """What is wrong with the imports of a module, a sentence each."""
    (folder, room), found = place(module), []
    for target, relative, line in imports(module, source):
        if target.split(".")[0] != "thermograsp":
            continue
        if target in LENT_BY_THE_ROOT.get(module, ()):
            continue
        at = f"{module}, line {line}: "
        to_folder, to_room = place(target)
        if not to_folder:
            if not folder and room in LEAVES:
                if to_room not in (*LEAVES[: LEAVES.index(room)], room):
                    found.append(f"{at}leaf {room} must not import {target}")
            elif to_room and to_room not in LEAVES and folder != "cli" and room != "__main__":
                found.append(f"{at}{target} is no leaf")
            elif target.count(".") > 1 and not open_to_others(target):
                found.append(f"{at}{target} lies behind the door of its room")
            elif folder and relative:
                found.append(f"{at}import {target} absolutely")
        elif not folder:
            if room != "__main__":
                found.append(f"{at}{room or 'the root'} must not import {target}")
        elif folder != to_folder:
            if to_folder not in MAY_IMPORT[folder]:
                found.append(f"{at}{folder} must not import {target}")
            elif not open_to_others(target):
                found.append(f"{at}{target} lies behind the door of its room")
            elif relative != (folder in INNER):
                found.append(f"{at}import {target} {'absolutely' if relative else 'relatively'}")
        elif folder in ROOMS and room and room != to_room:
            order = ROOMS[folder]
            if not to_room:
                found.append(f"{at}a room must not import its folder's own door")
            elif order.index(to_room) > order.index(room):
                found.append(f"{at}{room} stands below {to_room}")
            elif not open_to_others(target) and (ROOT / FOLDERS[folder] / to_room).is_dir():
                found.append(f"{at}{target} lies behind the door of its room")
    return found


INNER = ("thermal", "touch", "envs", "hardware")
"""Folders that import each other relatively, so that type checkers see one file once."""


def test_files_import_only_what_their_rooms_may() -> None:
    texts = {module: path.read_text(encoding="utf-8") for module, path in SOURCES.items()}
    assert [breach for module, text in texts.items() for breach in breaches(module, text)] == []


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("thermograsp.thermal.rungs.press", "from ...envs import ObjectSpec"),
        ("thermograsp.thermal.matter.sensors", "from ..rungs import press"),
        ("thermograsp.thermal.rungs.press", "from ..matter.mounting import Mode"),
        ("thermograsp.thermal.rungs.press", "from .. import material"),
        ("thermograsp.envs.mechanics.scene", "from thermograsp.thermal import material"),
        ("thermograsp.envs.mechanics.scene", "from ...thermal.matter.mounting import Mode"),
        ("thermograsp.thermal.rungs.press", "from ...errors import positive"),
        ("thermograsp.hardware.drivers.link", "from thermograsp.cli import main"),
        ("thermograsp.errors", "def f():\n    from thermograsp import files"),
        ("thermograsp.thermal.rungs.press", "from thermograsp.compiled.hashes import compiled_hash"),
        ("thermograsp.compiled.hashes", "from thermograsp.opengl import offscreen"),
        ("thermograsp", "from thermograsp import thermal"),
        ("thermograsp.figures.look", "from thermograsp.agents import rollout"),
        ("thermograsp.cli.press", "from thermograsp.thermal.rungs.problem import PressProblem"),
    ],
)
def test_a_wrong_arrow_is_seen(module: str, line: str) -> None:
    assert len(breaches(module, line)) == 1


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("thermograsp.envs.mechanics.scene", "from ...thermal import material"),
        ("thermograsp.envs.mechanics.scene", "from ...thermal.contact import contact"),
        ("thermograsp.envs.mechanics.scene", "from ..limits import TIPS\nfrom ..bodies import ObjectSpec"),
        ("thermograsp.thermal.rungs.press", "from .problem import PressProblem\nimport numpy"),
        ("thermograsp.thermal.rungs.press", "from thermograsp.errors import positive"),
        ("thermograsp.cli.press", "from thermograsp.thermal.rungs import press"),
        (
            "thermograsp.compiled.cache",
            "from .hashes import compiled_hash\nfrom thermograsp.notice import notice",
        ),
    ],
)
def test_a_right_arrow_passes(module: str, line: str) -> None:
    assert not breaches(module, line)


def test_no_imports_run_in_a_circle() -> None:
    graph = {
        module: {
            target
            for target, _, _ in imports(module, path.read_text(encoding="utf-8"))
            if target in SOURCES and target != module
        }
        for module, path in SOURCES.items()
    }
    list(graphlib.TopologicalSorter(graph).static_order())  # raises CycleError, which names the circle


def test_no_room_is_crowded() -> None:
    crowded = {
        module: count
        for module in PACKAGES
        if (count := sum(path.name != "__init__.py" for path in SOURCES[module].parent.glob("*.py")))
        > MOST_FILES
    }
    assert crowded == {}


def doors() -> list[str]:
    return sorted(name for name in PACKAGES if "opened(" in SOURCES[name].read_text(encoding="utf-8"))


@pytest.mark.parametrize("module", doors())
def test_a_door_that_opens_late_lends_what_it_imports_for_type_checkers(module: str) -> None:
    (block,) = [
        node for node in _tree(SOURCES[module].read_text(encoding="utf-8")).body if isinstance(node, ast.If)
    ]
    late: set[str] = set()
    modules: set[str] = set()
    for node in block.body:
        assert isinstance(node, ast.ImportFrom) and node.module
        (modules if node.module == module else late).update(alias.name for alias in node.names)
    everything = lent(module)
    assert modules | late <= everything
    files = {path.stem for path in SOURCES[module].parent.glob("*.py")}
    assert everything & files == modules, "a name that is also a file's would be the file once that is loaded"


def test_imports_stay_light() -> None:
    """One after another in one process: what an import loads is still there after the next."""
    unwanted = {
        "thermograsp": ("mujoco", "numba", "scipy", "matplotlib"),
        "thermograsp.wrappers": ("mujoco", "numba", "scipy", "matplotlib"),
        "thermograsp.thermal": ("mujoco", "matplotlib"),
        "thermograsp.hardware": ("mujoco", "matplotlib"),
    }
    code = (
        "import importlib, sys\n"
        f"for module, names in {unwanted!r}.items():\n"
        "    importlib.import_module(module)\n"
        "    print(module, [name for name in names if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [f"{module} []" for module in unwanted]


def test_contributing_names_every_room() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for folder, rooms in ROOMS.items():
        (row,) = re.findall(rf"^\| {FOLDERS[folder]}/ .*$", text, re.MULTILINE)
        for room in rooms:
            assert f"`{room}`" in row, f"the row of {folder}/ in CONTRIBUTING.md lacks `{room}`"


def test_numba_compiles_through_our_decorator() -> None:
    """Which keeps compiled code only as long as nothing in it has changed."""
    theirs = re.compile(r"^from numba import .*jit", re.MULTILINE)
    found = [module for module, path in SOURCES.items() if theirs.search(path.read_text(encoding="utf-8"))]
    assert found == [], "from thermograsp.compiled import njit"
