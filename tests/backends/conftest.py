"""PyTorch and JAX, each where it is installed: `make test-backends` installs both."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import pytest


@dataclass(frozen=True)
class Kind:
    """A namespace of arrays. float64, float32: empty arrays to compute like. compiled: a function as its users run it,
    which is operation by operation in PyTorch and jitted in JAX."""

    xp: ModuleType
    float64: Any
    float32: Any
    compiled: Callable[[Callable[..., Any]], Callable[..., Any]]

    def of(self, values: Any) -> Any:
        """The values as an array of this kind, of the same dtype."""
        return self.xp.asarray(np.asarray(values))


@pytest.fixture
def torch_kind() -> Kind:
    torch = pytest.importorskip("torch", reason="the extra torch is not installed")
    return Kind(
        torch, torch.zeros(0, dtype=torch.float64), torch.zeros(0, dtype=torch.float32), lambda step: step
    )


@pytest.fixture
def jax_kind() -> Iterator[Kind]:
    jax = pytest.importorskip("jax", reason="the extra jax is not installed")
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield Kind(jax.numpy, jax.numpy.zeros(0, "float64"), jax.numpy.zeros(0, "float32"), jax.jit)
    jax.config.update("jax_enable_x64", before)


@pytest.fixture(params=["torch", "jax"])
def kind(request: pytest.FixtureRequest) -> Kind:
    return request.getfixturevalue(f"{request.param}_kind")
