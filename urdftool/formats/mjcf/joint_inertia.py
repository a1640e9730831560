"""The inertia that each joint moves at home, which bounds its gains."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...model.kinematics import link_poses
from .joint import get_axis
from .link_inertia import LinkInertia
from .structure import Structure


def compute_joint_inertias(
    structure: Structure, masses: Mapping[str, LinkInertia], positions: Mapping[str, float]
) -> dict[str, float]:
    """Compute the diagonal of the joint-space mass matrix.

    Args:
        structure: The kinematic tree.
        masses: Mass properties of the links, as exported.
        positions: Joint positions by name [rad or m].

    Returns:
        The inertia that each hinge [kg·m²] and slide [kg] moves while the others are held.
    """
    poses = link_poses(structure.robot, positions)
    names = [name for name in masses if name in poses]
    row = {name: index for index, name in enumerate(names)}
    weights = np.array([masses[name].mass for name in names])
    centers = np.array([poses[name].transform(masses[name].com) for name in names]).reshape(-1, 3)
    tensors = np.array([masses[name].body.transform(poses[name]).inertia for name in names])
    below = _get_links_below(structure)
    found = {}
    for joint in structure.moving:
        kind = structure.get_kind(joint)
        if kind not in ("hinge", "slide"):
            continue
        rows = [row[name] for name in below[joint.child] if name in row]
        if kind == "slide":
            found[joint.name] = float(weights[rows].sum())
            continue
        pose = poses[joint.child]
        axis = np.array(pose.rotation) @ np.array(get_axis(joint))
        axis /= np.linalg.norm(axis)
        arms = np.cross(axis, centers[rows] - np.array(pose.translation))
        about = np.einsum("i,nij,j->n", axis, tensors[rows].reshape(-1, 3, 3), axis)
        found[joint.name] = float((about + weights[rows] * (arms**2).sum(axis=1)).sum())
    return found


def _get_links_below(structure: Structure) -> dict[str, list[str]]:
    """Return for each link itself and the links that move with it; floating bodies do not."""
    below: dict[str, list[str]] = {name: [name] for name in structure.group}
    for joint in reversed(structure.joints):
        if structure.get_kind(joint) != "free":
            below[joint.parent] += below[joint.child]
    return below
