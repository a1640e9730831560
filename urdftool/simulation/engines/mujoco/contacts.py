"""Read contacts and overlaps from MuJoCo, by the links of the file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...recording import GROUND, Contact
from ...rigid_bodies import RigidBodyModel

_TOUCH = 1e-6
"""M: a smaller depth is a contact, not an overlap. Chosen, no source."""


class ContactReader:
    """Contacts of one robot."""

    def __init__(
        self,
        mj: Any,
        model: Any,
        data: Any,
        bodies: RigidBodyModel,
        number_of: dict[str, int],
        plane: int,
    ) -> None:
        """Store a model and its state, the body of each link, and the geom of the plane."""
        self.mj, self.model, self.data, self.plane = mj, model, data, plane
        self._rigid: dict[int, int] = {}
        self._name: dict[int, str] = {}
        for row, body in enumerate(bodies.bodies):
            for link in body.links:
                self._rigid[number_of[link]] = row
                self._name.setdefault(number_of[link], link)
        solid = np.flatnonzero((model.geom_contype != 0) & (np.arange(model.ngeom) != plane))
        self._solid = [int(g) for g in solid if int(model.geom_bodyid[g]) in self._rigid]

    def link(self, geom: int) -> str:
        """Return the link of a geom."""
        return GROUND if geom == self.plane else self._name[int(self.model.geom_bodyid[geom])]

    def measure_deepest(self) -> float:
        """Measure the depth of the deepest contact with the plane [m]; -inf without one."""
        touching = self.data.contact
        one, other = touching.geom1, touching.geom2
        depths = -touching.dist[(one == self.plane) | (other == self.plane)]
        return float(depths.max()) if len(depths) else -math.inf

    def list_contacts(self) -> list[Contact]:
        """List the contacts with the plane."""
        found, force = [], np.zeros(6)
        for number in range(self.data.ncon):
            contact = self.data.contact[number]
            if self.plane not in (contact.geom1, contact.geom2):
                continue
            self.mj.mj_contactForce(self.model, self.data, number, force)
            up = contact.geom1 == self.plane  # the normal is from the first to the second
            normal = contact.frame[:3] if up else -contact.frame[:3]
            found.append(
                Contact(
                    self.link(int(contact.geom2 if up else contact.geom1)),
                    GROUND,
                    float(-contact.dist),
                    float(force[0]),
                    _convert_vector(contact.pos),
                    _convert_vector(normal),
                )
            )
        return found

    def find_overlaps(self, *, ground: bool = True) -> list[Contact]:
        """Find the interpenetration of each pair of bodies, whether or not contacts are enabled."""
        deepest: dict[tuple[int, int], Contact] = {}
        model, data = self.model, self.data
        others = [*self._solid, self.plane] if ground else self._solid
        for position, one in enumerate(self._solid):
            rest = np.array(others[position + 1 :], dtype=int)
            if not len(rest):
                continue
            distances = np.linalg.norm(data.geom_xpos[rest] - data.geom_xpos[one], axis=1)
            near = distances < model.geom_rbound[rest] + model.geom_rbound[one]
            near |= rest == self.plane
            for other in rest[near]:
                pair = self._pair(one, int(other))
                if pair[0] == pair[1]:
                    continue
                contact = self._make_overlap(one, int(other))
                if contact is not None:
                    known = deepest.get(pair)
                    if known is None or contact.depth > known.depth:
                        deepest[pair] = contact
        return list(deepest.values())

    def _pair(self, one: int, other: int) -> tuple[int, int]:
        a = self._rigid[int(self.model.geom_bodyid[one])]
        if other == self.plane:
            return a, -1
        b = self._rigid[int(self.model.geom_bodyid[other])]
        return max(a, b), min(a, b)

    def _make_overlap(self, one: int, other: int) -> Contact | None:
        ends = np.zeros(6)
        # the bound must be above zero, or nothing is measured
        distance = self.mj.mj_geomDistance(self.model, self.data, one, other, 1e-9, ends)
        if distance > -_TOUCH:
            return None
        way = ends[:3] - ends[3:]
        length = float(np.linalg.norm(way))
        normal = -way / length if length > 0 else np.array([0.0, 0.0, 1.0])
        if (
            other != self.plane
            and self._pair(one, other)[0] != self._rigid[int(self.model.geom_bodyid[one])]
        ):
            one, other, normal = other, one, -normal
        return Contact(
            self.link(one), self.link(other), -float(distance), 0.0, _convert_vector(ends[3:]),
            _convert_vector(normal),
        )  # fmt: skip


def _convert_vector(vector: Any) -> tuple[float, float, float]:
    x, y, z = (float(part) for part in vector)
    return x, y, z
