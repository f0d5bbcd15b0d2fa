"""docs/howto.md: the trainings run as they are written."""

import re
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("stable_baselines3", reason="needs stable-baselines3: make test-rl")

PAGE = Path(__file__).parents[2] / "docs" / "howto.md"


@pytest.mark.parametrize("block", re.findall(r"```python rl\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL))
def test_the_block_runs_and_trains(block: str) -> None:
    """All steps that it asks for are taken, and what comes of them is a policy for that environment."""
    names: dict[str, Any] = {"__name__": "__main__"}
    exec(compile(block, PAGE.name, "exec"), names)
    model, env = names["model"], names["env"]
    (steps,) = re.findall(r"model\.learn\((\d+)\)", block)
    assert model.num_timesteps >= int(steps) and model._n_updates > 0
    assert all(bool(part.isfinite().all()) for part in model.policy.parameters())
    observation, _ = env.reset(seed=0)
    actions, _ = model.predict(observation)
    assert actions.shape == env.action_space.shape and env.action_space.contains(actions)


@pytest.mark.parametrize(
    "block", re.findall(r"```python torchrl\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
)
def test_the_block_runs_in_torchrl(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("torchrl", reason="needs TorchRL: make test-rl")
    exec(compile(block, PAGE.name, "exec"), {"__name__": "__main__"})
    assert "torch.Size([4, 20])" in capsys.readouterr().out


@pytest.mark.parametrize(
    "block", re.findall(r"```python tensorboard\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
)
def test_the_block_writes_curves(block: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    loader: Any = pytest.importorskip(
        "tensorboard.backend.event_processing.event_accumulator", reason="needs tensorboard: make test-rl"
    )
    monkeypatch.chdir(tmp_path)
    exec(compile(block, PAGE.name, "exec"), {"__name__": "__main__"})
    (run,) = (tmp_path / "runs").iterdir()
    events = loader.EventAccumulator(str(run))
    events.Reload()
    assert {"rollout/ep_rew_mean", "rollout/ep_len_mean"} <= set(events.Tags()["scalars"])
