"""What a dataset holds: the plan of its episodes, and its shards, each of which is keyed by its seeds."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import metadata
from typing import Any

import thermograsp
from thermograsp.errors import InvalidValueError, unknown_name
from thermograsp.report.policies import POLICIES
from thermograsp.thermal import SEED_MATERIALS, Material, material

FORMAT = 1
"""Version of the files' layout."""

_DECISIVE = ("mujoco", "numba", "numpy", "scipy")
_MOST = 2**63 - 1  # seeds are a column of int64


def installed_versions() -> dict[str, str]:
    """Versions of what decides the numbers, by package."""
    return {"thermograsp": thermograsp.__version__, **{name: metadata.version(name) for name in _DECISIVE}}


def _seed_materials() -> tuple[Material, ...]:
    return tuple(material(name) for name in SEED_MATERIALS)


@dataclass(frozen=True, slots=True)
class Shard:
    """Episodes of seeds first .. first + count - 1."""

    first: int
    count: int

    @property
    def seeds(self) -> range:
        return range(self.first, self.first + self.count)

    @property
    def file(self) -> str:
        """Its file's name, from the seeds alone; names sort as seeds do."""
        return f"seeds-{self.first:012d}-{self.first + self.count - 1:012d}.parquet"


@dataclass(frozen=True, slots=True)
class Plan:
    """Episode i is that of env_id reset with seed + i, acted on by the policy; its material is drawn from `materials`.

    mode: T or O. shard_size: episodes a file. versions: of the packages that decide the numbers.
    Raises InvalidValueError and UnknownNameError."""

    env_id: str = "thermograsp/Grasp-v0"
    episodes: int = 1000
    seed: int = 0
    policy: str = "scripted"
    mode: str = "T"
    materials: tuple[Material, ...] = field(default_factory=_seed_materials)
    shard_size: int = 128
    versions: Mapping[str, str] = field(default_factory=installed_versions)

    def __post_init__(self) -> None:
        for name, least in (("episodes", 1), ("seed", 0), ("shard_size", 1)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or value < least:
                raise InvalidValueError(f"{name} must be a whole number, {least} or above, got {value!r}")
        if self.seed + self.episodes - 1 > _MOST:
            raise InvalidValueError(
                f"seed {self.seed} is too large for {self.episodes} episodes: the last must be below 2**63"
            )
        if self.policy not in POLICIES:
            raise unknown_name("policy", self.policy, POLICIES)
        if self.mode not in ("T", "O"):
            raise InvalidValueError(f"mode must be 'T' or 'O', got {self.mode!r}")
        if not self.materials:
            raise InvalidValueError("materials is empty: give at least one")

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
        return {"mode": self.mode, "material": list(self.materials)}

    def document(self) -> dict[str, Any]:
        """The plan as JSON holds it; SI units, as Material's."""
        fields = {one.name: getattr(self, one.name) for one in dataclasses.fields(self)}
        materials = [dataclasses.asdict(one) for one in self.materials]
        return {"format": FORMAT, **fields, "materials": materials, "versions": dict(self.versions)}

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Plan:
        """The plan that `document` returned. Raises InvalidValueError for anything else."""
        content = dict(document)
        if content.pop("format", None) != FORMAT:
            raise InvalidValueError(
                f"format must be {FORMAT}, got {document.get('format')!r}: another version of thermograsp wrote it"
            )
        try:
            content["materials"] = tuple(Material(**one) for one in content["materials"])
            return cls(**content)
        except (KeyError, TypeError) as error:
            raise InvalidValueError(f"an entry is missing or unknown: {error}") from error

    def differences(self, other: Plan) -> list[str]:
        """What tells `other` from this plan, one phrase a field: empty where they are equal. Materials of the same
        names are told apart by their properties, versions by package."""
        found = _differences(self, other)
        if "materials" in found and _told(self.materials) == _told(other.materials):
            del found["materials"]
            for mine, theirs in zip(self.materials, other.materials, strict=True):
                found |= {f"{name} of {mine.name}": told for name, told in _differences(mine, theirs).items()}
        if found.pop("versions", None):
            for name in sorted({*self.versions, *other.versions}):
                mine, theirs = self.versions.get(name), other.versions.get(name)
                if mine != theirs:
                    found[f"version of {name}"] = f"{mine}, not {theirs}"
        return [f"{name} is {told}" for name, told in found.items()]


def _differences(mine: Any, theirs: Any) -> dict[str, str]:
    """Field -> "this, not that" of two dataclasses, for the fields that decide whether they are equal."""
    pairs = {
        one.name: (getattr(mine, one.name), getattr(theirs, one.name))
        for one in dataclasses.fields(mine)
        if one.compare
    }
    return {name: f"{_told(a)}, not {_told(b)}" for name, (a, b) in pairs.items() if a != b}


def _told(value: Any) -> str:
    return ", ".join(one.name for one in value) if isinstance(value, tuple) else str(value)
