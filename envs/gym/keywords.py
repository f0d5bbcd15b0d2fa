"""The keywords that an environment takes, its own and those of what it simulates."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from thermograsp.errors import unknown_keyword

from ..plant import SimulationConfig

_OF_THE_BATCH = {"plant", "observer"}


def keywords_of(environment: type) -> set[str]:
    """Names of all that its class, those above it and a simulated plant take."""
    names = {field.name for field in fields(SimulationConfig)}
    for each in environment.__mro__:
        if each.__module__.partition(".")[0] not in ("gymnasium", "builtins") and "__init__" in vars(each):
            names |= set(inspect.signature(each.__init__).parameters)
    return (names | _OF_THE_BATCH) - {"self", "task", "config"}


def simulates(plant: str) -> bool:
    """Whether a plant's objects and materials are given by keywords, as they are of every simulation of ours."""
    return str(plant).partition(":")[0] in ("simulated", "simulated-pair", "twin", "twin-pair")


def check_keywords(environment: type, given: Mapping[str, Any]) -> None:
    """Raises UnknownKeywordError, which names the nearest, where an environment of a simulated plant is given a keyword
    that nothing takes. Other plants know their own."""
    if not simulates(given.get("plant", "simulated")):
        return
    known = keywords_of(environment)
    for name in given:
        if name not in known:
            raise unknown_keyword(environment.__name__, name, known)
