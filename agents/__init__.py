"""Policies of the environments, rollouts, and recordings of grasps."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.agents.episodes import rollout
    from thermograsp.agents.gripper_check import REPORTED_AFTER, check_gripper
    from thermograsp.agents.learning import Agent
    from thermograsp.agents.policies import POLICIES, Policy, load_policy, policy
    from thermograsp.agents.recording import LONGEST, Recording, columns_of, record
    from thermograsp.agents.scripted import ScriptedGrasp
    from thermograsp.agents.stopwatch import Stopwatch

__all__ = [
    "REPORTED_AFTER",
    "LONGEST",
    "POLICIES",
    "Agent",
    "Policy",
    "Recording",
    "ScriptedGrasp",
    "Stopwatch",
    "check_gripper",
    "columns_of",
    "load_policy",
    "policy",
    "record",
    "rollout",
]

__getattr__ = opened(__name__, renamed={"Network": "Agent", "load_network": "load_policy"})
