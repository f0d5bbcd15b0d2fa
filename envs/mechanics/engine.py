"""MuJoCo's own batches of simulations, which came with 4.0."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import mujoco

from thermograsp.errors import MissingDependencyError

try:
    from mujoco.batch import MODEL_FIELDS, Batch
except ImportError as error:
    raise MissingDependencyError(
        f"the environments need MuJoCo 4.0 or newer, this is {mujoco.__version__}: pip install 'mujoco>=4.0' "
        "(thermograsp.ThermalTouch gives a scene of your own the sense of heat with MuJoCo 3.3, too)"
    ) from error

__all__ = ["MODEL_FIELDS", "Batch"]
