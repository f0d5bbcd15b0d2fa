"""What a dataset holds: the plan of its episodes, and its shards, each of which is keyed by its seeds."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import metadata
from typing import Any

import thermograsp
from thermograsp.agents import POLICIES
from thermograsp.dataset.keywords import decoded, encoded
from thermograsp.dataset.sources import sources_digest
from thermograsp.errors import InvalidValueError, unknown_name, whole_number
from thermograsp.thermal import SEED_MATERIALS, Material, material

FORMAT = 2
"""Version of the manifest's layout. One of format 1 lacks keywords and sources, and is read all the same."""

_DECISIVE = ("mujoco", "numba", "numpy", "scipy")
_RESERVED = ("material", "mode", "num_envs", "render_mode", "plant")  # keywords that are not a plan's to give
_MOST = 2**63 - 1  # seeds are a column of int64


def installed_versions() -> dict[str, str]:
    """Versions of what decides the numbers, by package."""
    return {"thermograsp": thermograsp.__version__, **{name: metadata.version(name) for name in _DECISIVE}}


def _seed_materials() -> tuple[Material, ...]:
    return tuple(material(name) for name in SEED_MATERIALS)


@dataclass(frozen=True, slots=True)
class Shard:
    """The episodes with the seeds first .. first + count - 1."""

    first: int
    count: int

    @property
    def seeds(self) -> range:
        return range(self.first, self.first + self.count)

    @property
    def file(self) -> str:
        """The shard's file name, from the seeds alone; names sort as seeds do."""
        return f"seeds-{self.first:012d}-{self.first + self.count - 1:012d}.parquet"


@dataclass(frozen=True, slots=True)
class Plan:
    """What a dataset holds: episode i is one of env_id, reset with seed + i and driven by the policy. Its material is
    drawn from `materials`; if that is empty, the object keeps its own.

    mode: T or O. keywords: others of the environment, such as objects, randomize, tolerance, taxels, gripper: numbers,
    text, lists and records, as keywords.py has them; a list is kept as a tuple. shard_size: episodes a file. versions:
    of the packages that decide the numbers. sources: hash of those of thermograsp that do, "" where it is not known.
    Raises InvalidValueError and UnknownNameError."""

    env_id: str = "thermograsp/Grasp-v0"
    episodes: int = 1000
    seed: int = 0
    policy: str = "scripted"
    mode: str = "T"
    materials: tuple[Material, ...] = field(default_factory=_seed_materials)
    keywords: Mapping[str, Any] = field(default_factory=dict)
    shard_size: int = 128
    versions: Mapping[str, str] = field(default_factory=installed_versions)
    sources: str = field(default_factory=sources_digest)

    def __post_init__(self) -> None:
        if not isinstance(self.keywords, Mapping):
            raise InvalidValueError(
                f"keywords must be a dictionary, such as {{'tolerance': 0.02}}, got {self.keywords!r}"
            )
        if not isinstance(self.env_id, str) or not self.env_id:
            raise InvalidValueError(
                f"env_id must be the name of an environment, such as 'thermograsp/Grasp-v0', got {self.env_id!r}"
            )
        if isinstance(self.materials, str) or not isinstance(self.materials, Sequence):
            raise InvalidValueError(f"materials must be a list of materials, got {self.materials!r}")
        object.__setattr__(self, "materials", tuple(map(material, self.materials)))
        kept = {name: decoded(encoded(value, name)) for name, value in self.keywords.items()}
        object.__setattr__(self, "keywords", kept)
        for name in _RESERVED:
            if name in kept:
                raise InvalidValueError(f"{name} is an argument of its own, not one of the keywords")
        for name, least in (("episodes", 1), ("seed", 0), ("shard_size", 1)):
            whole_number(name, getattr(self, name), least)
        if self.seed + self.episodes - 1 > _MOST:
            raise InvalidValueError(
                f"seed {self.seed} is too large for {self.episodes} episodes: the last must be below 2**63"
            )
        if self.policy not in POLICIES:
            raise unknown_name("policy", self.policy, POLICIES)
        if self.mode not in ("T", "O"):
            raise InvalidValueError(f"mode must be 'T' or 'O', got {self.mode!r}")
        if not self.materials and not kept.keys() & {"objects", "scene"}:
            raise InvalidValueError("materials is empty: give at least one, or objects that have their own")

    @property
    def shards(self) -> tuple[Shard, ...]:
        """All of them, in the order of their seeds."""
        end = self.seed + self.episodes
        return tuple(
            Shard(first, min(self.shard_size, end - first))
            for first in range(self.seed, end, self.shard_size)
        )

    @property
    def env_config(self) -> dict[str, Any]:
        """Keywords of the environment."""
        return {"mode": self.mode, "material": list(self.materials) or None, **self.keywords}

    def document(self) -> dict[str, Any]:
        """The plan as JSON holds it; SI units, as Material's."""
        fields = {one.name: getattr(self, one.name) for one in dataclasses.fields(self)}
        fields["materials"] = [dataclasses.asdict(one) for one in self.materials]
        fields["keywords"] = encoded(self.keywords)
        return {"format": FORMAT, **fields, "versions": dict(self.versions)}

    def of_file(self) -> dict[str, Any]:
        """What each file holds of the plan: all but the number of episodes, for a dataset may grow."""
        document = self.document()
        del document["episodes"]
        return document

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Plan:
        """The plan that `document` returned. Raises InvalidValueError for anything else."""
        content = dict(document)
        number = content.pop("format", None)
        if number == 1:
            content |= {"keywords": {}, "sources": ""}
        elif number != FORMAT:
            raise InvalidValueError(
                f"format must be 1 or {FORMAT}, got {document.get('format')!r}: another version of thermograsp wrote it"
            )
        try:
            content["materials"] = tuple(Material(**one) for one in content["materials"])
            content["keywords"] = {name: decoded(one) for name, one in content["keywords"].items()}
            content["sources"]  # else it would be ours
            return cls(**content)
        except (KeyError, TypeError) as error:
            raise InvalidValueError(f"an entry is missing or unknown: {error}") from error

    def differences(self, other: Plan) -> list[str]:
        """What tells `other` from this plan, one phrase a field: empty where they are equal. Materials of the same
        names are told apart by their properties, versions by package; that of thermograsp counts where the sources are
        not known."""
        found = _differences(self, other)
        if "materials" in found and _text(self.materials) == _text(other.materials):
            del found["materials"]
            for one_side, other_side in zip(self.materials, other.materials, strict=True):
                differences = _differences(one_side, other_side)
                found |= {f"{name} of {one_side.name}": what for name, what in differences.items()}
        if found.pop("keywords", None):
            found |= {
                f"keyword {name}": difference for name, difference in _unlike(self.keywords, other.keywords)
            }
        known = bool(self.sources and other.sources)
        if found.pop("sources", None) and known:
            this_hash = f"{self.sources[:8]} ({self.versions.get('thermograsp')})"
            found["hash of thermograsp's sources"] = f"{this_hash}, not {other.sources[:8]}"
        if found.pop("versions", None):
            for name in sorted({*self.versions, *other.versions} - ({"thermograsp"} if known else set())):
                one_side, other_side = self.versions.get(name), other.versions.get(name)
                if one_side != other_side:
                    found[f"version of {name}"] = f"{one_side}, not {other_side}"
        return [f"{name} is {difference}" for name, difference in found.items()]


def _differences(one_side: Any, other_side: Any) -> dict[str, str]:
    """Field -> "this, not that" of two dataclasses, for the fields that decide whether they are equal."""
    pairs = {
        one.name: (getattr(one_side, one.name), getattr(other_side, one.name))
        for one in dataclasses.fields(one_side)
        if one.compare
    }
    return {name: f"{_text(a)}, not {_text(b)}" for name, (a, b) in pairs.items() if a != b}


def _unlike(one_side: Mapping[str, Any], other_side: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """(name, "this, not that") of entries that differ."""
    for name in sorted({*one_side, *other_side}):
        a, b = (encoded(one[name]) if name in one else "left out" for one in (one_side, other_side))
        if a != b:
            yield name, f"{a}, not {b}"


def _text(value: Any) -> str:
    return ", ".join(one.name for one in value) if isinstance(value, tuple) else str(value)
