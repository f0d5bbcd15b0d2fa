"""Our tasks, which mjlab loads by the entry point `mjlab.tasks` when it is imported."""

# mjlab is installed in the environment of make test-mjlab alone, and pyright takes this folder for it
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

from .sort_cubes import sort_cubes_cfg  # before mjlab, whose absence it explains

# isort: split
from mjlab.tasks.manipulation.config.yam.rl_cfg import yam_lift_cube_ppo_runner_cfg
from mjlab.tasks.manipulation.rl import ManipulationOnPolicyRunner
from mjlab.tasks.registry import register_mjlab_task

_LEARNING = yam_lift_cube_ppo_runner_cfg()
_LEARNING.experiment_name = "thermograsp_sort_cube"

register_mjlab_task(
    task_id="Thermograsp-Sort-Cube-Yam",
    env_cfg=sort_cubes_cfg(),
    play_env_cfg=sort_cubes_cfg(play=True),
    rl_cfg=_LEARNING,
    runner_cls=ManipulationOnPolicyRunner,
)
