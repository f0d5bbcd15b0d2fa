"""What docs/extending.md adds from outside serves an environment by its entry point."""

from importlib.metadata import EntryPoint, EntryPoints

import numpy as np
import pytest

from thermograsp import plant
from thermograsp.envs import GraspEnv, action_of

from .pages import blocks

OPEN, CLOSE = action_of(0.085, 0.0, 0.0), action_of(0.0, 10.0, 0.0)


def test_the_late_plant_is_the_simulated_one_a_control_step_late(monkeypatch: pytest.MonkeyPatch) -> None:
    (block,) = [block for block in blocks("docs/extending.md", "python") if "LatePlant" in block]
    names: dict = {"__name__": "my_package.plant"}
    exec(compile(block, "docs/extending.md", "exec"), names)
    point = EntryPoint("late", "my_package.plant:plant_from_url", plant.ENTRY_POINTS)
    monkeypatch.setattr(EntryPoint, "load", lambda self: names["plant_from_url"])
    monkeypatch.setattr(plant, "entry_points", lambda group: EntryPoints([point]).select(group=group))
    late, prompt = GraspEnv(plant="late:", material="glass"), GraspEnv(material="glass")
    late.reset(seed=0)
    prompt.reset(seed=0)
    found = {}
    for action in (OPEN, *[CLOSE] * 40):
        found, expected = late.step(CLOSE)[0], prompt.step(action)[0]
        for name in ("voltage", "force"):
            assert np.array_equal(found[name], expected[name])
    assert found["force"][:, 0].min() > 5.0
