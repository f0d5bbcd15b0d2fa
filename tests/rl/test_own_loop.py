"""A training loop in plain PyTorch over a vector environment that resets in the next step, as CleanRL's scripts do."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments

torch = pytest.importorskip("torch", reason="needs PyTorch: make test-rl")

ENVS, STEPS, LIMIT = 4, 45, 20


def test_actor_and_critic_learn_from_whole_and_cut_episodes() -> None:
    envs = gymnasium.make_vec(
        "thermograsp/Grasp-v0", num_envs=ENVS, vectorization_mode="vector_entry_point", seconds=LIMIT / 50
    )
    envs = gymnasium.wrappers.vector.FlattenObservation(envs)
    envs = gymnasium.wrappers.vector.RecordEpisodeStatistics(envs)
    torch.manual_seed(0)
    assert envs.single_observation_space.shape and envs.single_action_space.shape
    (width,), (many,) = envs.single_observation_space.shape, envs.single_action_space.shape
    actor, critic = torch.nn.Linear(width, many), torch.nn.Linear(width, 1)
    first = actor.weight.detach().clone()
    optimizer = torch.optim.Adam([*actor.parameters(), *critic.parameters()], lr=1e-3)
    seen, _ = envs.reset(seed=0)
    fresh, lengths = np.zeros(ENVS, bool), []
    for _ in range(STEPS):
        policy = torch.distributions.Normal(actor(torch.as_tensor(seen, dtype=torch.float32)), 0.3)
        action = policy.sample()
        value = critic(torch.as_tensor(seen, dtype=torch.float32))[:, 0]
        following, reward, terminated, truncated, infos = envs.step(action.numpy())
        with torch.no_grad():
            later = critic(torch.as_tensor(following, dtype=torch.float32))[:, 0]
            target = torch.as_tensor(reward, dtype=torch.float32) + 0.99 * later * torch.as_tensor(
                ~terminated, dtype=torch.float32
            )
        counted = torch.as_tensor(~fresh, dtype=torch.float32)  # the step after an end only resets
        advantage = target - value
        loss = (
            counted * (advantage**2 - policy.log_prob(action).sum(1) * advantage.detach())
        ).sum() / counted.sum().clamp(min=1.0)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        if "episode" in infos:
            lengths += infos["episode"]["l"][infos["_episode"]].tolist()
        seen, fresh = following, terminated | truncated
    assert torch.isfinite(actor.weight).all() and not torch.equal(actor.weight, first)
    assert lengths == [LIMIT] * (2 * ENVS)
    envs.close()
