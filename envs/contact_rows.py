"""Area and conductance of every environment's contacts, all at once.

B: environments, S: substeps, F = 2 fingertips.
"""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from ..thermal import Joint, contact_conductance
from .things import Thing

_FIELDS = tuple(field.name for field in fields(Joint))


class ContactRows:
    """The contact laws of `num_envs` environments. Flat contacts have a constant area and share of the force; curved
    ones follow the force, object by object."""

    def __init__(self, num_envs: int) -> None:
        self._joint = {name: np.ones(num_envs) for name in _FIELDS}
        self._area, self._share = np.zeros(num_envs), np.zeros(num_envs)
        self._curved: list[Thing | None] = [None] * num_envs
        self._groups: list[tuple[Thing, np.ndarray]] | None = []

    def place(self, row: int, thing: Thing) -> None:
        """The row's object from now on."""
        for name, values in self._joint.items():
            values[row] = getattr(thing.joint, name)
        flat = thing.contact_shape == "flat"
        if flat:
            newton = thing.contact(np.array(1.0))
            self._area[row], self._share[row] = float(newton.face), float(newton.face_force)
        self._curved[row] = None if flat else thing
        self._groups = None

    def mean_contact(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Conductance W/(m2 K) and area m2, both (B, F), whose product is the mean of their products over the
        substeps of the normal forces (B, S, F) N; both 0 where nothing presses. The area is the mean over the
        pressing substeps."""
        conductance, mean_area = np.zeros(force.shape[::2]), np.zeros(force.shape[::2])
        rows = np.flatnonzero(np.any(force > 0, axis=(1, 2)))
        if not len(rows):
            return conductance, mean_area
        pressing = np.ascontiguousarray(force[rows])
        area = np.where(pressing > 0, self._area[rows, None, None], 0.0)
        on_face = pressing * self._share[rows, None, None]
        for thing, members in self._curved_groups():
            chosen = np.flatnonzero(np.isin(rows, members))
            if len(chosen):
                contact = thing.contact(pressing[chosen])
                area[chosen], on_face[chosen] = contact.face, contact.face_force
        pressure = np.divide(on_face, area, out=np.zeros_like(area), where=area > 0)
        joint = Joint(**{name: values[rows, None, None] for name, values in self._joint.items()})
        product = contact_conductance(joint, pressure) * area
        total, total_area, touching = (np.zeros((len(rows), force.shape[2])) for _ in range(3))
        for k in range(force.shape[1]):  # in fixed order: a row's bits must not depend on the others
            total += product[:, k]
            total_area += area[:, k]
            touching += area[:, k] > 0
        mean = np.divide(total_area, touching, out=np.zeros_like(total), where=touching > 0)
        mean_area[rows] = mean
        conductance[rows] = np.divide(total / force.shape[1], mean, out=np.zeros_like(total), where=mean > 0)
        return conductance, mean_area

    def _curved_groups(self) -> list[tuple[Thing, np.ndarray]]:
        """Rows by curved object, found anew after a change."""
        if self._groups is None:
            groups: dict[Thing, list[int]] = {}
            for row, thing in enumerate(self._curved):
                if thing is not None:
                    groups.setdefault(thing, []).append(row)
            self._groups = [(thing, np.array(rows)) for thing, rows in groups.items()]
        return self._groups
