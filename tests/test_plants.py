"""Plants by URL: those of the package, and those that other packages name as entry points."""

from importlib.metadata import EntryPoint, EntryPoints

import pytest

from thermograsp import plant
from thermograsp.envs.plant.simulated import simulated_plant
from thermograsp.errors import UnknownNameError


def of_another_package(url: str, num_envs: int) -> str:
    return f"{num_envs} of {url}"


@pytest.fixture
def added(monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("mine", f"{__name__}:of_another_package", plant.ENTRY_POINTS)
    monkeypatch.setattr(EntryPoint, "load", lambda self: of_another_package)
    monkeypatch.setattr(plant, "entry_points", lambda group: EntryPoints([point]).select(group=group))


def test_the_package_s_own_are_found() -> None:
    assert plant.plant_factory("simulated") is simulated_plant


def test_another_package_adds_one(added: None) -> None:
    assert plant.plant_factory("mine://host")("mine://host", 3) == "3 of mine://host"


def test_an_unknown_one_is_refused_with_the_names_there_are(added: None) -> None:
    with pytest.raises(UnknownNameError, match="did you mean .mine"):
        plant.plant_factory("mein")
