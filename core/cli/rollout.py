"""`thermograsp rollout`: episodes of a registered environment, checked step by step where that is asked."""

from __future__ import annotations

import argparse
from contextlib import closing

from thermograsp.cli.shared import Output, add_seed, load_mujoco
from thermograsp.errors import InvalidValueError, ThermograspError

NAME = "rollout"
HELP = "Run episodes of an environment; report success, speed and a digest of all observations."

_VIOLATED = 1
_SHOWN = 10


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("env_id", metavar="ENV_ID", help="id of the environment, such as thermograsp/Grasp-v0")
    add("--episodes", type=int, default=20, help="number of episodes")
    add(
        "--num-envs",
        type=int,
        default=4,
        help="number of environments that run at once; only the speed depends on it",
    )
    add_seed(parser, "seed of the first episode; episode k uses seed + k")
    add(
        "--stakes",
        action="store_true",
        help="draw from materials that need different forces (envs.STAKES)",
    )
    add(
        "--policy",
        default="scripted",
        help="policy: scripted, feeling, trained, random, zero, or a policy's .npz file",
    )
    add(
        "--max-steps",
        type=int,
        help="number of control steps after which episodes are cut off (default: none are)",
    )
    add(
        "--check",
        action="store_true",
        help="check values, bounds, temperatures and the heat balance after every step",
    )


def run(args: argparse.Namespace) -> int:
    """Runs the episodes. 1 where a check found something or a simulation broke down."""
    for name in ("episodes", "num_envs", "max_steps"):
        value = getattr(args, name)
        if value is not None and value < 1:
            raise InvalidValueError(f"{name.replace('_', '-')} must be at least 1, got {value}")
    if args.stakes and not args.env_id.endswith("thermograsp/Grasp-v0"):
        raise InvalidValueError(f"--stakes are those of thermograsp/Grasp-v0, not of {args.env_id}")
    output = Output(args.json)
    load_mujoco(output)
    import gymnasium

    from thermograsp.agents import rollout
    from thermograsp.envs import STAKES

    at_once = min(args.num_envs, args.episodes)
    try:
        env = gymnasium.make_vec(
            args.env_id,
            num_envs=at_once,
            vectorization_mode="vector_entry_point",
            **(STAKES if args.stakes else {}),
        )
        with closing(env), output.progress(args.episodes) as advance:
            result = rollout(env, args.episodes, args.seed, args.policy, args.max_steps, args.check, advance)
    except gymnasium.error.Error as error:
        raise ThermograspError(f"cannot run {args.env_id!r}: {error}") from error
    output.line(f"{args.env_id}: {args.episodes} episodes, {result.steps} steps, policy {args.policy}")
    output.line(f"success  {result.successes} of {args.episodes}")
    output.line(f"return   {result.mean_return:.3f} (mean)")
    output.line(f"speed    {result.steps_per_second:.0f} steps/s with {at_once} at once")
    output.line(f"digest   {result.digest}")
    if args.check:
        output.line(
            f"checks   {len(result.violations) or 'no'} violation{'s' * (len(result.violations) != 1)}"
        )
    for violation in result.violations[:_SHOWN]:
        output.line(f"  {violation}")
    if len(result.violations) > _SHOWN:
        output.line(f"  and {len(result.violations) - _SHOWN} more")
    output.document(
        {
            "env_id": args.env_id,
            "episodes": args.episodes,
            "num_envs": at_once,
            "seed": args.seed,
            "policy": args.policy,
            "steps": result.steps,
            "successes": result.successes,
            "success_rate": result.successes / args.episodes,
            "mean_return": result.mean_return,
            "steps_per_s": result.steps_per_second,
            "digest": result.digest,
            "checked": args.check,
            "violations": [str(violation) for violation in result.violations],
        }
    )
    return _VIOLATED if result.violations else 0
