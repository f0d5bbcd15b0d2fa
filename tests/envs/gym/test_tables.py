"""However many sizes and places are drawn, caches of functions hold no more than they say."""

import gc
import importlib
import inspect
import pkgutil
from contextlib import suppress
from functools import _lru_cache_wrapper

import thermograsp.envs
import thermograsp.thermal
import thermograsp.touch
from thermograsp.errors import MissingDependencyError


def test_every_cache_of_functions_has_a_limit_or_few_arguments() -> None:
    """Those without one are of names and of files, of which there are few. In every module, whatever was imported."""
    for package in (thermograsp.envs, thermograsp.thermal, thermograsp.touch):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            with suppress(MissingDependencyError):
                importlib.import_module(module.name)
    unlimited = {
        f"{one.__module__.removeprefix('thermograsp.')}.{one.__qualname__}"
        for one in gc.get_objects()
        if type(one) is _lru_cache_wrapper  # a weak proxy of what is gone raises when asked for its class
        and one.__module__.startswith("thermograsp")
        and one.cache_info().maxsize is None
        and inspect.signature(one).parameters
    }
    named = (
        "doors.",
        "sources.",
        "dataset.",
        "thermal.matter.",
        "thermal.stack.presets.",
        "envs.bodies.library.",
    )
    of_shape = {
        "thermal.numerics.laplace._hyperbola",
        "thermal.plates.section._bessel_zeros",
        "envs.grippers.shipped._parsed",
        "envs.grippers.fingertip._shipped",
    }
    assert {name for name in unlimited if not name.startswith(named)} <= of_shape
