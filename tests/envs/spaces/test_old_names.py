"""Names of earlier versions go on for one version, with a word that they are old."""

import importlib
import sys

import pytest

from thermograsp import envs
from thermograsp.envs.spaces import Senses


@pytest.mark.parametrize(
    ("module", "name", "now"), [("senses", "Senses", Senses), ("taxels", "Taxels", envs.Taxels)]
)
def test_an_old_module_warns_and_holds_what_it_held(module: str, name: str, now: object) -> None:
    sys.modules.pop(f"thermograsp.envs.{module}", None)
    with pytest.warns(DeprecationWarning, match="import from there"):
        old = importlib.import_module(f"thermograsp.envs.{module}")
    assert getattr(old, name) is now


def test_an_old_class_warns_and_is_the_one_of_today() -> None:
    with pytest.warns(DeprecationWarning, match=r"envs\.Thing is now thermograsp\.envs\.GraspBody"):
        old = envs.Thing  # pyright: ignore[reportAttributeAccessIssue]
    assert old is envs.GraspBody


def test_the_bodies_of_a_plant_go_by_their_old_name_for_a_version() -> None:
    plant = envs.SimulatedPlant(1, envs.SimulationConfig(material="glass", cache=False))
    with pytest.warns(DeprecationWarning, match="bodies"):
        old = plant.things
    assert [body.material.name for body in old] == ["glass"] and old == plant.bodies
