"""Objects of other sizes in a compiled scene: what the compiler would have made of them, to the last bit."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from thermograsp.envs import ObjectSpec
from thermograsp.envs.mechanics import batch as mechanics_batch
from thermograsp.envs.mechanics.batch import Mechanics

FIRST = (ObjectSpec(), ObjectSpec(name="other", shape="sphere", size=(0.03, 0.03, 0.03)))


def drawn(rng: np.random.Generator, first: ObjectSpec) -> ObjectSpec:
    shape = ("box", "cylinder", "sphere")[rng.integers(3)]
    x, y, z = rng.uniform(0.012, 0.1, 3) * (0.8, 0.8, 1.0)
    size = {"box": (x, y, z), "cylinder": (x, x, z), "sphere": (x, x, x)}[shape]
    colour = tuple(rng.uniform(0, 1, 4))
    fields = {"density": rng.uniform(50, 2e4), "friction": rng.uniform(0, 2), "rgba": colour}
    return replace(first, shape=shape, size=size, **fields)


@pytest.mark.parametrize("first", [FIRST[:1], FIRST], ids=["one", "two"])
@pytest.mark.parametrize("lateral", [False, True])
def test_fields_are_the_compiler_s(first: Sequence[ObjectSpec], lateral: bool) -> None:
    mechanics, rng = Mechanics(first, 2, lateral=lateral), np.random.default_rng(len(first))
    for _ in range(8):
        objects = [tuple(drawn(rng, each) for each in first) for _ in range(2)]
        mechanics.reset(objects=objects)
        for row, items in enumerate(objects):
            placed, compiled = mechanics.env_model(row), mechanics._build(items)
            for name in mechanics_batch._MODEL_ARRAYS:
                assert np.array_equal(getattr(placed, name), getattr(compiled, name)), name


def test_nothing_is_compiled_for_a_size(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanics = Mechanics(FIRST, 1)
    monkeypatch.setattr(mechanics_batch, "build_scene", None)
    mechanics.reset([0], [[replace(each, size=(0.03, 0.03, 0.03)) for each in FIRST]])
    assert mechanics.env_model(0).geom_size[-1, 0] == 0.015


def test_what_is_glued_on_is_compiled() -> None:
    mechanics = Mechanics(FIRST[:1], 1)
    assert mechanics._resized is not None
    glued = replace(FIRST[0], elements=(0.009, 0.0035))
    assert Mechanics((glued,), 1)._resized is None
