"""What the studio says of things that it holds: one of the ten is never none of them, and a foreign one is."""

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from thermograsp.studio.control.choices import Choices, Controls, Stock
from thermograsp.studio.control.feeling import Feeling
from thermograsp.studio.sources.simulated import SimulatedGrasp
from thermograsp.thermal import SEED_MATERIALS
from thermograsp.thermal.matter.mounting import Mode

HELD = 8.0  # s
LONG = pytest.mark.skipif(
    not os.environ.get("THERMOGRASP_LONG"), reason="its curves take half a minute: make test-view-long"
)


def looks(materials: Sequence[str], mode: Mode, named: tuple[str, ...]) -> dict[str, list[dict[str, Any]]]:
    """What is told of each material in the default scene, held for HELD: every look of it. named: those that are known
    besides the ten."""
    stock = Stock()
    grasp = SimulatedGrasp(Choices(materials=tuple(materials), mode=mode), stock)
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in materials}
    with ThreadPoolExecutor(1) as workers:
        feelings = [
            Feeling(grasp.touch_setup(row), stock.materials, named, workers) for row in range(grasp.rows)
        ]
        for feeling in feelings:
            feeling._making.result()
        while grasp.time < HELD + 0.5:  # it closes for half a second
            columns = grasp.step(Controls())
            for row, (name, feeling) in enumerate(zip(materials, feelings, strict=True)):
                feeling.add(columns, row)
                found[name] += [look for look in [feeling.look()] if look is not None]
    grasp.close()
    return found


@pytest.mark.parametrize("mode", [pytest.param("T", marks=pytest.mark.slow), pytest.param("O", marks=LONG)])
def test_what_is_of_the_ten_is_never_none_of_them(mode: Mode) -> None:
    for name, seen in looks(SEED_MATERIALS, mode, ()).items():
        assert len(seen) >= HELD / 0.25, name
        assert {one["verdict"] for one in seen} <= {"no_touch", "several", "material"}, name
        assert dict(seen[-1]["likely"])[name] > 0.3, name


def test_what_is_not_of_them_is_none_of_them() -> None:
    """Between rubber and glass in effusivity, where none of the ten is; the apple holds as much heat as water."""
    for name, seen in looks(("apple", "gfrp"), "T", ()).items():
        assert seen[-1]["verdict"] == "not_listed", name
        assert name not in dict(seen[-1]["likely"])


def test_what_was_chosen_is_known_too() -> None:
    seen = looks(("apple",), "T", ("apple",))["apple"]
    assert seen[-1]["verdict"] == "material" and seen[-1]["likely"][0][0] == "apple"
