"""A step of many small tensor operations as one launch of a GPU."""

# torch is installed in environments of their own alone
# pyright: reportMissingImports=false

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from thermograsp.errors import MissingDependencyError, install

try:
    import torch
except ImportError as error:
    raise MissingDependencyError(f"thermograsp.mjlab needs mjlab: {install('mjlab')}") from error

_WARM = 3  # runs before a recording, in which libraries allocate and torch.compile compiles


@dataclass(frozen=True)
class Recording:
    """A step as a CUDA graph. It holds the step too: the graph reads its tensors where they lie, so they must live."""

    step: Callable[[], None]
    graph: torch.cuda.CUDAGraph

    def __call__(self) -> None:
        self.graph.replay()


def recorded(step: Callable[[], None], written: Sequence[torch.Tensor]) -> Recording:
    """The step recorded as a CUDA graph: one launch in place of one for each operation. It must read and write tensors
    that stay where they are. Runs before the recording leave `written`, the tensors that it changes, as they were."""
    before = [tensor.clone() for tensor in written]
    beside = torch.cuda.Stream()
    beside.wait_stream(torch.cuda.current_stream())
    with torch.cuda.stream(beside):
        for _ in range(_WARM):
            step()
    torch.cuda.current_stream().wait_stream(beside)
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph):
        step()
    for tensor, old in zip(written, before, strict=True):
        tensor.copy_(old)
    return Recording(step, graph)
