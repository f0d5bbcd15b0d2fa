"""Datasets of episodes: made on one machine or many, one Parquet file a range of seeds, and read as batches.

    from thermograsp import dataset
    dataset.make(dataset.Plan(episodes=1000), "grasps", workers=2)
    for batch in dataset.iterate("grasps", 256, columns=["voltage", "material"], rng=numpy.random.default_rng(0)): ...

docs/datasets.md lists the columns.
"""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.dataset.keywords import decoded
    from thermograsp.dataset.lerobot_export import export_lerobot
    from thermograsp.dataset.minari_export import export_minari
    from thermograsp.dataset.plan import Plan, Shard
    from thermograsp.dataset.reading import iterate, load
    from thermograsp.dataset.run import ShardCounts, make
    from thermograsp.dataset.shards import read_plan

__all__ = [
    "Plan",
    "Shard",
    "ShardCounts",
    "decoded",
    "export_lerobot",
    "export_minari",
    "iterate",
    "load",
    "make",
    "read_plan",
]

__getattr__ = opened(__name__, renamed={"Made": "ShardCounts"})  # until 0.3
