"""Steps that a GPU replays."""

# this package is installed in the environment of make test-mjlab alone
# pyright: reportMissingImports=false

from __future__ import annotations

import gc

import pytest

pytest.importorskip("mjlab", reason="mjlab is not installed: make test-mjlab installs it")

import torch

from thermograsp.mjlab.recording import Recording, recorded


@pytest.mark.skipif(not torch.cuda.is_available(), reason="needs a GPU")
def test_a_recording_counts_on_from_where_its_tensors_were() -> None:
    total, added = torch.zeros(4, device="cuda"), torch.ones(4, device="cuda")

    def made() -> Recording:
        twice = torch.full((4,), 2.0, device="cuda")

        def step() -> None:
            total.add_(twice * added)

        return recorded(step, [total])

    run = made()
    gc.collect()
    torch.zeros(1000, device="cuda")  # would take the place of `twice`, had it not been kept
    assert total.tolist() == [0.0] * 4
    run()
    added.fill_(3.0)
    run()
    assert total.tolist() == [8.0] * 4
