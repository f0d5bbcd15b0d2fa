"""Joined heat whose fingertips stay where they are, as arrays."""

from .networks import FixedNetworks
from .places import FixedPlaces, network_tables
from .world import JoinedWorld, world_networks, world_places

__all__ = ["FixedNetworks", "FixedPlaces", "JoinedWorld", "network_tables", "world_networks", "world_places"]
