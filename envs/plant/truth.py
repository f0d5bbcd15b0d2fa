"""What only a simulation knows of a control step.

B: environments, F = 2 fingertips, N: heat samples, O: objects, G: what can be asked.
"""

from __future__ import annotations

from typing import NotRequired, TypedDict

import numpy as np

INFO = ("material", "temperature_drop", "contact_area", "conductance", "rung", "events")
"""What info tells at every step."""


class Truth(TypedDict):
    """Reading.truth of a simulated plant.

    mode: T or O. material, rung (B,): names, of the model that computes the heat. temperature_drop (B, F) K at the
    step's end, temperature_drops (B, N, F) K. contact_area (B, F) m2, conductance (B, F) W/(m2 K), sensor_surface,
    object_surface (B, F), object_temperature and reservoir_temperature (B,) °C, heat_flow and heat_drawn (B, F) W, heat
    (B, 3), heat_imbalance and heat_exchanged (B,) J, over_temperature (B,), events (B,): as in HeatStep. lift (B,) m,
    the object above where it lay. crushing_force (B,) N. randomized: (B,) by name of what differs between episodes.
    failed (B,): the environment broke down.

    Of several objects, values of fingertips are those of the object that each touches or touched last, and heat's last
    column and the books are all objects'. object_temperatures: (B, O) °C. touched: (B, F), the number of the object.
    Of a pair, material and rung are tuples of both, and crushing_force, lift and object_temperature are (B, O).
    object_force: (B, O, F, 3) N. goal: (B, G). asked: (B,) names. right: (B,), the number of the right object.
    """

    mode: str
    material: np.ndarray
    temperature_drop: np.ndarray
    temperature_drops: np.ndarray
    contact_area: np.ndarray
    conductance: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    object_temperature: np.ndarray
    heat_flow: np.ndarray
    heat_drawn: np.ndarray
    heat: np.ndarray
    heat_imbalance: np.ndarray
    heat_exchanged: np.ndarray
    reservoir_temperature: np.ndarray
    over_temperature: np.ndarray
    events: np.ndarray
    rung: np.ndarray
    lift: np.ndarray
    crushing_force: np.ndarray
    randomized: dict[str, np.ndarray]
    failed: np.ndarray
    object_temperatures: NotRequired[np.ndarray]
    touched: NotRequired[np.ndarray]
    object_force: NotRequired[np.ndarray]
    goal: NotRequired[np.ndarray]
    asked: NotRequired[np.ndarray]
    right: NotRequired[np.ndarray]
