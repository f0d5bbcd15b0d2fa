"""Outputs of networks as rows, and residues of ports that are mirror images."""

from __future__ import annotations

import numpy as np

from thermograsp.thermal.numerics import mirrored_residues, output_row, port_residues

MOMENTS = np.geomspace(0.01, 60, 16)
RATES = np.geomspace(3e-3, 1e3, 12)
COLUMNS = 1 / (MOMENTS[:, None] + RATES)


def test_a_row_is_the_least_squares_of_its_transfer() -> None:
    """Of a row that there is, at states some of which fade alike; then with a jump that it has to make."""
    rng = np.random.default_rng(1)
    rates = np.repeat(RATES[::2], 3)
    ports, row = rng.normal(size=(len(rates), 3)), rng.normal(size=len(rates))
    weight = 1 / (1 + 1 / MOMENTS)
    seen = 1 / (MOMENTS[:, None] + rates)
    transfer = seen @ (row[:, None] * ports)
    found = output_row(MOMENTS, transfer, rates, ports, weight)
    np.testing.assert_allclose(seen @ (found[:, None] * ports), transfer, atol=1e-8)
    design = (weight[:, None, None] * seen[:, None, :] * ports.T).reshape(-1, len(rates))
    wanted = (weight[:, None] * transfer).ravel()
    total = np.array([1.0, 0.0, -2.0])
    exact = output_row(MOMENTS, transfer, rates, ports, weight, total)
    np.testing.assert_allclose(ports.T @ exact, total, atol=1e-12)
    # any other row with that jump is as far from the transfer, or further
    free = np.linalg.svd(ports.T)[2][3:]
    misfit = np.linalg.norm(design @ exact - wanted)
    for _ in range(20):
        other = exact + 0.1 * rng.normal(size=len(free)) @ free
        assert np.linalg.norm(design @ other - wanted) > misfit * (1 - 1e-9)


def test_a_port_that_nothing_sees_has_no_say() -> None:
    """Its jump cannot be made; the others' are."""
    rng = np.random.default_rng(2)
    ports = rng.normal(size=(12, 3))
    ports[:, 2] = 0.0
    row = output_row(MOMENTS, np.zeros((16, 3)), RATES, ports, MOMENTS, np.array([1.0, 0.5, 0.0]))
    np.testing.assert_allclose(ports.T @ row, [1.0, 0.5, 0.0], atol=1e-10)


def test_mirrored_ports_are_fitted_as_any_others() -> None:
    rng = np.random.default_rng(3)
    for _ in range(10):
        fields = rng.normal(size=(12, 6, 6)) * RATES[:, None, None]
        true = fields @ fields.transpose(0, 2, 1)
        halves = np.r_[3:6, 0:3]
        true = (true + true[:, halves][:, :, halves]) / 2
        # a little that no passive body has
        wanted = np.tensordot(COLUMNS, true, axes=1)
        wanted += 0.02 * np.abs(wanted).mean() * np.eye(6) * np.sin(np.arange(16))[:, None, None]
        weight = 1 / wanted[:, 0, 0].clip(min=1e-3 * wanted[0, 0, 0])
        expected = port_residues(COLUMNS, wanted, weight)
        found = mirrored_residues(COLUMNS, wanted, weight)
        np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
        assert min(np.linalg.eigvalsh(each).min() for each in found.transpose(2, 0, 1)) > -1e-9 * found.max()
