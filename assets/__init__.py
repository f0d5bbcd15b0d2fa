"""Data files of the package: MJCF, materials, sensor presets. Imports nothing of ours."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent


def asset(name: str) -> Path:
    """Path of a data file, e.g. asset("materials.toml"). Raises FileNotFoundError with the full path."""
    path = ROOT / name
    if not path.is_file():
        raise FileNotFoundError(f"no asset {name!r}: {path} does not exist; reinstall the package")
    return path
