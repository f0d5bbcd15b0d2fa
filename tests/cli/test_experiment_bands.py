"""The rigs on which the paper's experiment is repeated: what is drawn, and what their curves are worth."""

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.reports.paper.bands import RUNGS, UNKNOWN, Bands, draw_rigs
from thermograsp.reports.paper.sweeps import OBJECT_SIZE, Rig, rough_conductances


def test_rigs_fill_their_ranges_and_are_the_same_every_time() -> None:
    rigs = draw_rigs(20)
    assert rigs == draw_rigs(20) and len(set(rigs)) == 20
    for name, each in UNKNOWN.items():
        values = np.array([getattr(rig, name) for rig in rigs])
        low, high = np.log([each.low, each.high]) if each.logarithmic else (each.low, each.high)
        share = ((np.log(values) if each.logarithmic else values) - low) / (high - low)
        assert sorted(np.floor(share * 20).astype(int)) == list(range(20)), name


def test_rough_slack_contacts_conduct_less() -> None:
    for mode in ("O", "T"):
        usual = rough_conductances(mode, Rig())
        assert (rough_conductances(mode, Rig(roughness=1e-5)) <= usual).all()
        assert (rough_conductances(mode, Rig(pressure=1e5)) > usual).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mode", "name", "air", "tolerance"),
    [
        ("O", "plastic", 0.0, 0.005),  # networks of mode O have the air lumped, however fine they are
        ("T", "plastic", 9.0, 0.01),
        ("T", "aluminium", 9.0, 0.01),
    ],
)
def test_fixed_networks_are_as_good_as_chosen_ones(
    mode: thermal.Mode, name: str, air: float, tolerance: float
) -> None:
    keywords = {"conductance": 2000.0, "object_size": OBJECT_SIZE, "air": air, "tolerance": tolerance}
    curves = [
        thermal.press(name, mode=mode, rung=rung, **keywords).temperature_drop
        for rung in ("auto", RUNGS[mode])
    ]
    assert np.abs(curves[0] - curves[1])[3:].max() < 0.01


def test_what_parts_the_rigs_is_named() -> None:
    rigs = draw_rigs(24)
    bands = Bands(rigs, ())
    rough = np.array([rig.roughness for rig in rigs])
    name, deciding_value, elsewhere = bands.deciding(rough > np.median(rough)) or ("", 0.0, 0.0)
    assert name == "roughness" and deciding_value > np.median(rough) > elsewhere
    assert bands.deciding(np.ones(24, bool)) is None
    assert bands.deciding(np.arange(24) % 2 == 0) is None
