"""What is kept of compiled models: as they were, no more than asked for, and in few pieces of memory."""

import dataclasses

import numpy as np
import pytest

from thermograsp.envs import ObjectSpec
from thermograsp.envs.mechanics import batch as mechanics_batch
from thermograsp.envs.mechanics import kept_fields
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.envs.mechanics.kept_fields import KeptFields


def of_size(factor: float) -> ObjectSpec:
    """With elements glued on: its scene is compiled."""
    one = ObjectSpec(elements=(0.009, 0.0035))
    return dataclasses.replace(one, size=tuple(factor * side for side in one.size))


def fields(number: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(number)
    return {
        "mass": rng.random(3),
        "flags": rng.integers(0, 2, 5).astype(np.uint8),  # what follows it is aligned all the same
        "place": rng.random((2, 3)).astype(np.float32),
        "none": np.zeros((0, 4)),
        "wide": rng.random(4 * number),
    }


def test_fields_come_back_as_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also those that are larger than a block, and those in blocks of before."""
    monkeypatch.setattr(kept_fields, "_BLOCK", 256)
    kept = KeptFields(10)
    keys = [(of_size(1 + number / 100),) for number in range(10)]
    for number, key in enumerate(keys):
        kept.add(key, fields(7 * number))
    for number, key in enumerate(keys):
        wanted, found = fields(7 * number), kept[key]
        assert found.keys() == wanted.keys()
        for name, values in wanted.items():
            assert np.array_equal(found[name], values) and found[name].dtype == values.dtype


def test_the_oldest_go_and_the_number_of_blocks_stays() -> None:
    kept = KeptFields(3)
    for number in range(3000):
        kept.add((of_size(0.5 + number / 1e4),), {"field": np.full(100, float(number))})
        assert len(kept) <= 3
    assert (of_size(0.5 + 2999 / 1e4),) in kept and (of_size(0.5 + 2996 / 1e4),) not in kept
    assert kept[(of_size(0.5 + 2998 / 1e4),)]["field"][0] == 2998.0
    blocks = {id(place.block) for places in kept._places.values() for place in places}
    assert len(blocks) <= 2


def test_an_object_that_was_forgotten_is_the_same_when_it_comes_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(mechanics_batch, "_KEPT_MODELS", 2)
    mechanics = Mechanics((of_size(1.0),), 1)
    sizes = [0.8, 0.9, 1.1, 0.8, 1.0, 0.9]
    models = []
    for factor in sizes:
        mechanics.reset([0], [(of_size(factor),)])
        assert 1 <= len(mechanics._compiled) <= 2
        models.append(mechanics.env_model(0))
    for first, second in ((0, 3), (1, 5)):
        for name in ("geom_size", "body_inertia", "geom_aabb", "dof_invweight0", "qpos0"):
            assert np.array_equal(getattr(models[first], name), getattr(models[second], name))
    assert not np.array_equal(models[0].geom_size, models[1].geom_size)
