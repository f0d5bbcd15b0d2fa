"""A small dataset that most tests of datasets look at."""

from pathlib import Path

from thermograsp import dataset
from thermograsp.thermal import material

# Glass is held after 188 steps, water gel is crushed after 25, gold is too heavy and runs into the time limit: 500.
MATERIALS = tuple(material(name) for name in ("glass", "water_gel", "gold"))
PLAN = dataset.Plan(episodes=7, seed=8, shard_size=3, materials=MATERIALS)


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def copied(folder: Path, to: Path) -> Path:
    for name, content in contents(folder).items():
        (to / name).write_bytes(content)
    return to
