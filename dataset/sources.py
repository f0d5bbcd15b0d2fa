"""Which sources make a dataset's numbers: two versions of thermograsp with the same ones make the same files."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import thermograsp

_DECISIVE = ("assets", "thermal", "touch", "envs", "agents", "dataset")
"""Packages below thermograsp that decide the numbers, beside the modules of the root itself."""

_KINDS = (".py", ".toml", ".xml", ".npz", ".obj", ".stl", ".csv", ".json")


@cache
def sources_digest() -> str:
    """Hash of all files that decide the numbers, by their names and contents."""
    digest = hashlib.sha256()
    for path in sorted(Path(thermograsp.__file__).parent.glob("*.py")):
        digest.update(f"{path.name} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    for name in _DECISIVE:
        spec = find_spec(f"thermograsp.{name}")
        for place in (spec.submodule_search_locations or ()) if spec else ():
            folder = Path(place)
            files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*")}
            for relative, path in sorted(files.items()):
                if path.suffix in _KINDS and path.is_file():
                    content = hashlib.sha256(path.read_bytes()).hexdigest()
                    digest.update(f"{name}/{relative} {content}\n".encode())
    return digest.hexdigest()
