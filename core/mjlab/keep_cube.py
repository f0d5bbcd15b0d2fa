"""A small task of mjlab's arm: keep the cube in the hand if it is of the material that is asked for, else let it go."""

# mjlab is installed in the environment of make test-mjlab alone, and pyright takes this folder for it
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportGeneralTypeIssues=false
# pyright: reportIndexIssue=false, reportInvalidTypeForm=false, reportCallIssue=false

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .sensor import ThermalTouchCfg, torch  # before mjlab, whose absence it explains

# isort: split
from mjlab.envs.mdp.actions import JointPositionAction, JointPositionActionCfg
from mjlab.managers.command_manager import CommandTerm, CommandTermCfg
from mjlab.managers.metrics_manager import MetricsTermCfg
from mjlab.managers.observation_manager import ObservationTermCfg
from mjlab.managers.reward_manager import RewardTermCfg
from mjlab.managers.scene_entity_config import SceneEntityCfg
from mjlab.tasks.manipulation.config.yam.env_cfgs import yam_lift_cube_env_cfg

from .sort_cubes import FINGERTIPS, MATERIALS, SENSOR, requested_material
from .terms import voltage

COMMAND = "keep"
LOOK, SAMPLES = 0.12, 6  # s of a control step, and the voltages in it
_EPISODE = 2  # control steps: one to feel, and one in which the cube falls or not
_FINGER, _TOUCHING = "left_finger", 0.0201  # m, of the joint: the pads 0.2 mm inside a cube of 40 mm
_REACH = 0.07  # m from a pad's body to the middle of what touches
_LOST = 0.03  # m of the cube from the hand, which holds it at 15 mm
_FOR_EVER = 1e9  # s


class KeepCommand(CommandTerm):
    """At every reset a cube between the pads, its material and the material that is asked for, both drawn.

    asked: (worlds,) number of the material to keep."""

    def __init__(self, cfg: KeepCommandCfg, env: Any) -> None:
        super().__init__(cfg, env)
        self._robot, self._cube, self._touch = map(env.scene.__getitem__, ("robot", "cube", cfg.sensor_name))
        self._pads, _ = self._robot.find_bodies([name.split("/")[1] for name in FINGERTIPS.values()])
        self._fingers, _ = self._robot.find_joints((_FINGER, "right_finger"), preserve_order=True)
        self._hand, _ = self._robot.find_sites("grasp_site")
        self.requested = torch.zeros(self.num_envs, dtype=torch.long, device=self.device)

    @property
    def command(self) -> torch.Tensor:
        """(worlds,) the same as `requested`."""
        return self.requested

    @property
    def right(self) -> torch.Tensor:
        """(worlds,) whether the hand has the cube if it is of that material, and else has not."""
        hand = self._robot.data.site_pos_w[:, self._hand[0]]
        held = (self._cube.data.root_link_pos_w - hand).norm(dim=-1) < _LOST
        return held == (self._touch.material[:, 0] == self.requested)

    def _resample_command(self, env_ids: torch.Tensor) -> None:
        count, several = len(env_ids), len(MATERIALS)
        self._touch.set_material("cube/cube", torch.randint(several, (count,), device=self.device), env_ids)
        self.requested[env_ids] = torch.randint(several, (count,), device=self.device)
        robot = self._robot
        joints = robot.data.default_joint_pos[env_ids].clone()
        joints[:, self._fingers] = torch.tensor((_TOUCHING, -_TOUCHING), device=self.device)
        robot.write_joint_position_to_sim(joints, env_ids=env_ids)
        robot.set_joint_position_target(joints, env_ids=env_ids)  # of the arm; the fingers have the action
        self._env.sim.forward()
        left, right = (robot.data.body_link_pos_w[env_ids, pad] for pad in self._pads)
        turn = robot.data.body_link_quat_w[env_ids, self._pads[0]]
        w, x, y, z = turn.unbind(-1)
        along = torch.stack((2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)), -1)
        pose = torch.cat(((left + right) / 2 + _REACH * along, turn), -1)
        self._cube.write_root_link_pose_to_sim(pose, env_ids=env_ids)
        self._cube.write_root_link_velocity_to_sim(torch.zeros(count, 6, device=self.device), env_ids=env_ids)

    def _update_metrics(self) -> None:
        pass

    def _update_command(self, env_ids: torch.Tensor | None = None) -> None:
        pass


@dataclass(kw_only=True)
class KeepCommandCfg(CommandTermCfg):
    """Configuration of KeepCommand. sensor_name: of a ThermalTouchCfg whose only object is the cube, of MATERIALS."""

    sensor_name: str = SENSOR

    def build(self, env: Any) -> KeepCommand:
        return KeepCommand(self, env)


class KeepAction(JointPositionAction):
    """One number: from 0 on the hand keeps the cube, below it lets go. In an episode's first step it keeps, to feel."""

    def process_actions(self, actions: torch.Tensor) -> None:
        opens = (actions < 0) & (self._env.episode_length_buf > 0)[:, None]
        super().process_actions(torch.where(opens, 1.0, -1.0))


@dataclass(kw_only=True)
class KeepActionCfg(JointPositionActionCfg):
    def build(self, env: Any) -> KeepAction:
        return KeepAction(self, env)


def right(env: Any, command_name: str) -> torch.Tensor:
    """(worlds,) 1 for a KeepCommand that is met, else 0, for a MetricsTermCfg."""
    return env.command_manager.get_term(command_name).right.float()


def right_at_last(env: Any, command_name: str) -> torch.Tensor:
    """(worlds,) the same in an episode's last step and else 0, for a RewardTermCfg: until then the hand feels whatever
    it is told, and to be paid for that would be chance."""
    return right(env, command_name) * (env.episode_length_buf >= env.max_episode_length)


def keep_cube_cfg(play: bool = False) -> Any:
    """A ManagerBasedRlEnvCfg: mjlab's task Mjlab-Lift-Cube-Yam, but the cube is in the hand and the arm rests.

    play: without noise of what is observed besides the voltages."""
    cfg = yam_lift_cube_env_cfg()
    physics = cfg.sim.mujoco  # for a CPU: half the steps, and room for what one cube touches
    physics.timestep, physics.iterations, physics.ls_iterations = 0.01, 4, 8
    cfg.sim.njmax, cfg.sim.nconmax = 100, 24
    step = physics.timestep
    cfg.decimation = round(LOOK / step)
    cfg.episode_length_s = _EPISODE * cfg.decimation * step
    cfg.is_finite_horizon, cfg.scale_rewards_by_dt = True, False
    cfg.scene.sensors = (ThermalTouchCfg(SENSOR, FINGERTIPS, {"cube/cube": MATERIALS}, samples=SAMPLES),)
    cfg.commands = {COMMAND: KeepCommandCfg(resampling_time_range=(_FOR_EVER, _FOR_EVER))}
    scale = cfg.actions["joint_pos"].scale[_FINGER]
    cfg.actions = {"keep": KeepActionCfg(entity_name="robot", actuator_names=(_FINGER,), scale=scale)}
    cfg.events = {name: cfg.events[name] for name in ("reset_base", "reset_robot_joints")}
    cfg.terminations = {"time_out": cfg.terminations["time_out"]}
    cfg.curriculum = {}
    command = {"command_name": COMMAND}
    cfg.rewards = {"right": RewardTermCfg(func=right_at_last, weight=1.0, params=command)}
    cfg.metrics = {"right": MetricsTermCfg(func=right, params=command, reduce="last")}
    for group in cfg.observations.values():
        group.terms = {name: group.terms[name] for name in ("joint_pos", "ee_to_cube")}
        group.terms["joint_pos"].params["asset_cfg"] = SceneEntityCfg("robot", joint_names=(_FINGER,))
        group.terms["asked"] = ObservationTermCfg(
            func=requested_material, params=command | {"materials": len(MATERIALS)}
        )
        group.terms["voltage"] = ObservationTermCfg(func=voltage, params={"sensor_name": SENSOR})
    cfg.observations["actor"].enable_corruption = not play
    return cfg
