"""`thermograsp train`: an agent learns a task; an interrupted run goes on."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from thermograsp.cli.shared import Output, load_mujoco
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.agents.learning.training import Progress

NAME = "train"
HELP = "Train an agent on a task by imitation and then PPO; write checkpoints and a policy that needs only NumPy."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("task", metavar="TASK", help="task: grasp, identify, sort or hotter")
    add("--out", metavar="DIR", help="folder for the checkpoints and the policy (default: out/TASK-SEED)")
    add("--seed", type=int, default=0, help="seed of the training, 0 to 999")
    add(
        "--steps",
        type=int,
        help="number of control steps, of all environments together (default: the recipe's)",
    )
    add("--resume", action="store_true", help="continue from the folder's last checkpoint")
    add("--no-heat", action="store_true", help="train without heat sensing: voltages and thermostats read 0")
    add("--no-load", action="store_true", help="train on a gripper without load cells: forces read 0")
    add(
        "--randomize",
        action="store_true",
        help="draw at random everything that can differ between episodes (envs.EVERYTHING), in half of the practice",
    )


def run(args: argparse.Namespace) -> int:
    """Trains, and says after each evaluation how good the agent is."""
    output = Output(args.json)
    if args.steps is not None and args.steps < 1:
        raise InvalidValueError(f"steps must be at least 1, got {args.steps}")
    load_mujoco(output)
    from thermograsp.agents.learning import Recipe, learning_task

    task = learning_task(args.task)
    from thermograsp.agents.learning import training

    recipe = Recipe() if args.steps is None else replace(Recipe(), steps=args.steps)
    out = args.out or f"out/{task.name}-{args.seed}"
    with output.progress(recipe.steps) as advance:
        before = 0

        def report(progress: Progress) -> None:
            nonlocal before
            advance(progress.doing, progress.steps - before)
            before = progress.steps
            if progress.success is not None:
                output.line(
                    f"{progress.steps:>9} control steps, {progress.doing}: success {100 * progress.success:.1f} %, "
                    f"return {progress.mean_return:.3f}"
                )

        made = training.Training(
            task,
            out,
            seed=args.seed,
            recipe=recipe,
            heat=not args.no_heat,
            load=not args.no_load,
            drawn=args.randomize,
            resume=args.resume,
            report=report,
        )
        best = made.run()
    policy = made.out / training.POLICY
    output.line(f"wrote {policy}; thermograsp score {policy} --task {task.name} counts held-out episodes")
    output.document(
        {"task": task.name, "out": str(made.out), "policy": str(policy), "steps": made.steps, **best}
    )
    return 0
