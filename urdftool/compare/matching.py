"""Joints without a common name, matched by the structure of the tree."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..mechanics.reference import Array, compute_mass_properties
from ..model.elements import Joint
from ..model.kinematics import get_limits
from .bodies import Bodies, Body, compute_axis
from .joints import get_kind

_LIMIT = 8.0
"""Largest cost of a match; beyond it the joints are different. Chosen, no source."""


def match_children(
    a: Bodies, b: Bodies, one: Sequence[Joint], two: Sequence[Joint], frame: Array
) -> list[tuple[Joint, Joint]]:
    """Match joints of two corresponding bodies, the most similar first.

    ``frame`` is the pose of the second body in the first, 4 × 4.
    """
    costs = sorted(
        (
            (cost, i, j)
            for i, x in enumerate(one)
            for j, y in enumerate(two)
            if (cost := _compute_cost(a, b, x, y, frame)) <= _LIMIT
        )
    )
    left, right = set(range(len(one))), set(range(len(two)))
    found = []
    for _, i, j in costs:
        if i in left and j in right:
            left.remove(i)
            right.remove(j)
            found.append((one[i], two[j]))
    return found


def _compute_cost(a: Bodies, b: Bodies, x: Joint, y: Joint, frame: Array) -> float:
    """Compute the dissimilarity of two joints: number and mass of what they move, axis, limits."""
    if get_kind(x) != get_kind(y):
        return math.inf
    below, below2 = (list_below(bodies, joint) for bodies, joint in ((a, x), (b, y)))
    cost = 2.0 * abs(len(below) - len(below2))
    pose, pose2 = a.compute_joint_pose(x), frame @ b.compute_joint_pose(y)
    axis, axis2 = pose[:3, :3] @ compute_axis(x), pose2[:3, :3] @ compute_axis(y)
    cost += 2.0 * (1.0 - abs(float(axis @ axis2)))
    offset = pose2[:3, 3] - pose[:3, 3]
    offset = offset - axis * float(axis @ offset)
    cost += min(4.0, 20.0 * float(np.linalg.norm(offset)))
    mass, mass2 = (
        sum(_get_mass(bodies, body) for body in bodies_below)
        for bodies, bodies_below in ((a, below), (b, below2))
    )
    cost += abs(mass - mass2) / max(mass, mass2, 1e-9)
    ranges = [upper - lower for lower, upper in (get_limits(x), get_limits(y))]
    finite = [value for value in ranges if math.isfinite(value)]
    if len(finite) == 2:
        cost += abs(finite[0] - finite[1]) / max(*finite, 1e-9)
    return cost


def list_below(bodies: Bodies, joint: Joint) -> list[Body]:
    """Return the bodies that a joint moves."""
    found, todo = [], [bodies.get_child(joint)]
    while todo:
        body = todo.pop()
        found.append(body)
        todo += [bodies.get_child(child) for child in body.joints]
    return found


def _get_mass(bodies: Bodies, body: Body) -> float:
    properties = (compute_mass_properties(link, np.eye(4)) for link in bodies.get_links(body))
    return sum(found[0] for found in properties if found is not None)
