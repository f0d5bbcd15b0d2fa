"""The reward of a lift: the change of progress, a success and a failure.

Progress p is a number of the present alone, from 0 at the start to its most at a success. A step pays p after it less p
before it, so that nothing is paid twice: what is lost is taken back. Without a discount an episode's steps add up to
the last p. With a discount g a step they add up to the sum over all steps of (1 - g) g^t p(t), where p stays after the
end what it was then; p is nowhere higher than on the straight way to a success, and nothing else gains as much.
A failure leaves p = 0 and costs FAILURE. A success pays SUCCESS, less up to LATE of it for the time that it took, so
that it is worth less later even where nothing is discounted.
"""

from __future__ import annotations

import numpy as np

PRESSED = 0.2  # of progress: both fingertips press
RAISED = 0.3  # at the full height, in proportion below it
HELD = 0.5  # at the end of the hold, in proportion before it
SUCCESS = 1.0
FAILURE = -1.0
LATE = 0.1  # of a success, at the time limit


def lift_progress(pressing: np.ndarray, share: np.ndarray, held: np.ndarray, pressed: float) -> np.ndarray:
    """Progress of a lift, (B,) as all but `pressed`. pressing: whether both fingertips press; without it there is
    none. share: of the height, 0 .. 1. held: of the hold, 0 .. 1. pressed: what the touch itself is worth."""
    return pressing * (pressed + RAISED * share + HELD * held)


def step_reward(
    before: np.ndarray,
    after: np.ndarray,
    ended: np.ndarray,
    failed: np.ndarray,
    elapsed: np.ndarray,
    limit: float,
) -> np.ndarray:
    """(B,), what a step pays that took progress from `before` to `after`. ended: by a success or a failure. elapsed: s
    of the time limit, which is `limit` s."""
    if not np.count_nonzero(ended):  # as in most steps
        return after - before
    success = ended & ~failed
    return np.where(failed, FAILURE, after) - before + success * (SUCCESS * (1 - LATE * (elapsed / limit)))
