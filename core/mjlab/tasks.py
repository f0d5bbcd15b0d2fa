"""Our tasks, which mjlab loads by the entry point `mjlab.tasks` when it is imported."""

# mjlab is installed in the environment of make test-mjlab alone, and pyright takes this folder for it
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

from .keep_cube import keep_cube_cfg  # before mjlab, whose absence it explains
from .sort_cubes import sort_cubes_cfg

# isort: split
from mjlab.rl import RslRlModelCfg, RslRlOnPolicyRunnerCfg, RslRlPpoAlgorithmCfg
from mjlab.tasks.manipulation.config.yam.rl_cfg import yam_lift_cube_ppo_runner_cfg
from mjlab.tasks.manipulation.rl import ManipulationOnPolicyRunner
from mjlab.tasks.registry import register_mjlab_task

_SMALL = {"hidden_dims": (64, 64), "activation": "elu", "obs_normalization": True}
_KEEPING = RslRlOnPolicyRunnerCfg(
    actor=RslRlModelCfg(
        **_SMALL,
        distribution_cfg={"class_name": "GaussianDistribution", "init_std": 1.0, "std_type": "scalar"},
    ),
    critic=RslRlModelCfg(**_SMALL),
    algorithm=RslRlPpoAlgorithmCfg(
        num_learning_epochs=10, schedule="adaptive", desired_kl=0.02, learning_rate=1e-3
    ),
    experiment_name="thermograsp_keep_cube",
    num_steps_per_env=4,
    max_iterations=60,
)
_LEARNING = yam_lift_cube_ppo_runner_cfg()
_LEARNING.experiment_name = "thermograsp_sort_cube"

register_mjlab_task(
    task_id="Thermograsp-Sort-Cube-Yam",
    env_cfg=sort_cubes_cfg(),
    play_env_cfg=sort_cubes_cfg(play=True),
    rl_cfg=_LEARNING,
    runner_cls=ManipulationOnPolicyRunner,
)

register_mjlab_task(
    task_id="Thermograsp-Keep-Cube-Yam",
    env_cfg=keep_cube_cfg(),
    play_env_cfg=keep_cube_cfg(play=True),
    rl_cfg=_KEEPING,
    runner_cls=ManipulationOnPolicyRunner,
)
