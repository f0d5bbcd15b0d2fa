"""A task of mjlab's arm: of two cubes that look alike, lift the one of the material that is asked for."""

# mjlab is installed in the environment of make test-mjlab alone, and pyright takes this folder for it
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportGeneralTypeIssues=false
# pyright: reportIndexIssue=false, reportInvalidTypeForm=false, reportCallIssue=false

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .sensor import ThermalTouchCfg, torch  # before mjlab, whose absence it explains

# isort: split
from mjlab.entity import EntityCfg
from mjlab.managers.observation_manager import ObservationTermCfg
from mjlab.managers.reward_manager import RewardTermCfg
from mjlab.managers.scene_entity_config import SceneEntityCfg
from mjlab.tasks.manipulation import mdp
from mjlab.tasks.manipulation.config.yam.env_cfgs import get_cube_spec, yam_lift_cube_env_cfg
from mjlab.tasks.manipulation.mdp import MultiCubeLiftingCommand, MultiCubeLiftingCommandCfg

from .terms import voltage

MATERIALS = ("aluminium", "wood")
"""Of the cubes, one each; which cube is of which changes with every command."""
CUBES = tuple(f"cube_{number}" for number in range(len(MATERIALS)))
FINGERTIPS = {"left": "robot/lf_down", "right": "robot/rf_down"}
_MORE_CONTACTS = 120  # of a cube, as in mjlab's own task of several
COMMAND, SENSOR = "lift_height", "touch"


class SortCommand(MultiCubeLiftingCommand):
    """mjlab's command to lift one of several cubes, which here are of other materials each time.

    asked: (worlds,) number of the material of the cube to lift."""

    def __init__(self, cfg: SortCommandCfg, env: Any) -> None:
        super().__init__(cfg, env)
        self._touch = env.scene[cfg.sensor_name]
        self.requested = torch.zeros_like(self.target_selection)

    def _resample_command(self, env_ids: torch.Tensor) -> None:
        super()._resample_command(env_ids)
        order = torch.rand(len(env_ids), len(self.cubes), device=self.device).argsort(-1)
        for number, name in enumerate(self.cfg.entity_names):
            self._touch.set_material(f"{name}/cube", order[:, number], env_ids)
        self.requested[env_ids] = order.gather(-1, self.target_selection[env_ids, None])[:, 0]


@dataclass(kw_only=True)
class SortCommandCfg(MultiCubeLiftingCommandCfg):
    """Configuration of SortCommand. entity_names: of the cubes, each with as many materials as there are cubes.
    sensor_name: of a ThermalTouchCfg."""

    sensor_name: str = SENSOR

    def build(self, env: Any) -> SortCommand:
        return SortCommand(self, env)


def requested_material(env: Any, command_name: str, materials: int) -> torch.Tensor:
    """(worlds, materials) 1 for the one that a SortCommand asks for, 0 for the others, for an ObservationTermCfg."""
    requested = env.command_manager.get_term(command_name).requested
    return torch.nn.functional.one_hot(requested, materials).float()


def requested_cube(env: Any, command_name: str) -> torch.Tensor:
    """(worlds, cubes) 1 for the cube to lift, which only a critic may know."""
    command = env.command_manager.get_term(command_name)
    return torch.nn.functional.one_hot(command.target_selection, len(command.cubes)).float()


def sort_cubes_cfg(play: bool = False) -> Any:
    """A ManagerBasedRlEnvCfg: mjlab's task Mjlab-Lift-Cube-Yam with two cubes, and fingertips that tell them apart.

    Both cubes' places are observed, the voltages and the material that is asked for. play: without an end."""
    cfg = yam_lift_cube_env_cfg(play)
    cfg.scene.entities = {"robot": cfg.scene.entities["robot"]} | {
        name: EntityCfg(spec_fn=get_cube_spec) for name in CUBES
    }
    cfg.sim.nconmax += _MORE_CONTACTS * len(CUBES)
    cfg.scene.sensors += (ThermalTouchCfg(SENSOR, FINGERTIPS, {f"{name}/cube": MATERIALS for name in CUBES}),)
    again = cfg.commands[COMMAND].resampling_time_range
    cfg.commands = {
        COMMAND: SortCommandCfg(
            entity_names=CUBES, resampling_time_range=again, difficulty="dynamic", debug_vis=True
        )
    }
    _rewards(cfg.rewards)
    noise = cfg.observations["actor"].terms["ee_to_cube"].noise
    hand = {"asset_cfg": SceneEntityCfg("robot", site_names=("grasp_site",))}
    for group in cfg.observations.values():
        del group.terms["ee_to_cube"], group.terms["cube_to_goal"]
        for name in CUBES:
            group.terms[f"ee_to_{name}"] = ObservationTermCfg(
                func=mdp.ee_to_object_distance, params=hand | {"object_name": name}, noise=noise
            )
        group.terms["goal"] = ObservationTermCfg(
            func=mdp.target_position, params=hand | {"command_name": COMMAND}
        )
        group.terms["asked"] = ObservationTermCfg(
            func=requested_material, params={"command_name": COMMAND, "materials": len(MATERIALS)}
        )
        group.terms["voltage"] = ObservationTermCfg(func=voltage, params={"sensor_name": SENSOR})
    cfg.observations["critic"].terms["cube"] = ObservationTermCfg(
        func=requested_cube, params={"command_name": COMMAND}
    )
    return cfg


def _rewards(rewards: dict[str, RewardTermCfg]) -> None:
    lift, precise = rewards["lift"], rewards["lift_precise"]
    lift.func, precise.func = mdp.multi_cube_staged_position_reward, mdp.multi_cube_bring_object_reward
    for term in (lift, precise):
        del term.params["object_name"]
