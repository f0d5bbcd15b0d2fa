"""Where and with what a figure was measured."""

from __future__ import annotations

import os
import platform
from importlib import metadata
from pathlib import Path

import thermograsp

_PACKAGES = ("mujoco", "numpy", "scipy", "numba", "scikit-fem", "FiPy")


def provenance(seed: int) -> dict[str, object]:
    """Machine, versions and seed, for JSON. A package that is not installed is left out."""
    versions = {"thermograsp": thermograsp.__version__, "python": platform.python_version()}
    for name in _PACKAGES:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    machine = {"processor": _processor(), "cores": os.cpu_count() or 1, "system": platform.system()}
    return {"machine": machine, "versions": versions, "seed": seed}


def caption(found: dict[str, object]) -> str:
    """One line of what provenance() returned, for a figure."""
    machine, versions = found["machine"], found["versions"]
    assert isinstance(machine, dict) and isinstance(versions, dict)
    named = ", ".join(f"{name} {version}" for name, version in versions.items())
    return f"{machine['processor']}, {machine['cores']} cores, {machine['system']} · {named} · seed {found['seed']}"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            key, _, value = line.partition(":")
            if key.strip() == "model name" and value.strip():
                return value.strip()
    return platform.processor() or platform.machine()
