"""Terms for an mjlab task's managers: what the fingertips feel as observations, materials as an event."""

from __future__ import annotations

from typing import Any

from .sensor import torch


def voltage(env: Any, sensor_name: str) -> torch.Tensor:
    """(worlds, fingertips x samples) V, for an ObservationTermCfg."""
    return env.scene[sensor_name].data.voltage.flatten(1)


def temperature_drop(env: Any, sensor_name: str) -> torch.Tensor:
    """(worlds, fingertips) K, for an ObservationTermCfg: what the voltage would tell without electronics."""
    return env.scene[sensor_name].data.temperature_drop


def randomize_material(env: Any, env_ids: torch.Tensor | None, sensor_name: str, object_name: str) -> None:
    """Draws one of an object's materials for each of those worlds, for an EventTermCfg of mode "reset"."""
    sensor = env.scene[sensor_name]
    count = env.num_envs if env_ids is None else len(env_ids)
    several = len(sensor.materials(object_name))
    sensor.set_material(object_name, torch.randint(several, (count,), device=env.device), env_ids)
