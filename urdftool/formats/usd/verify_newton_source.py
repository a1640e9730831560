"""The robot that a stage must hold, as Newton's import of it is compared."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from pxr import Usd, UsdPhysics

from ...mechanics.reference import Mechanics, get_origin_matrix
from ...model.elements import Joint, Link, Robot
from ...model.kinematics import get_limits
from ..common.losses import DeclaredLosses
from .declared_losses import TREE

Array = npt.NDArray[np.float64]

CONFIGURATIONS = 21
"""Random joint positions, in addition to zero. Chosen, no source."""

FLOAT = 1e-6
"""Relative tolerance: most values of a stage are 32-bit floats."""

_REACH = 3.0
"""Largest joint position [rad or m] of a configuration. Chosen, no source."""


@dataclass(frozen=True)
class Source:
    """The robot that a stage must hold.

    Attributes:
        robot: The robot with the choices of the export.
        losses: What the export reported.
        configurations: Joint positions [rad or m] by joint; the first is zero.
        body: Link with mass that carries each link, by name; empty for the world.
    """

    robot: Robot
    losses: DeclaredLosses
    configurations: list[dict[str, float]]
    body: dict[str, str]

    def is_below_changed_joint(self, link: str) -> bool:
        """Tell whether a joint above a link was reported as changed."""
        joint = self.robot.tree.get_parent_joint(link)
        while joint is not None:
            if self.losses.has_for(TREE, joint.name):
                return True
            joint = self.robot.tree.get_parent_joint(joint.parent)
        return False


def make_source(robot: Robot, losses: DeclaredLosses, path: Path) -> Source:
    """Return a robot with what the comparison with its stage needs."""
    return Source(robot, losses, list(_list_configurations(robot)), _find_bodies(path))


def _list_configurations(robot: Robot) -> Iterator[dict[str, float]]:
    """Yield zero, and random positions within the limits, the same in each run."""
    chance = random.Random(27)
    movable = Mechanics(robot).joints
    yield dict.fromkeys((joint.name for joint in movable), 0.0)
    for _ in range(CONFIGURATIONS):
        yield {joint.name: chance.uniform(*_get_range(joint)) for joint in movable}


def _get_range(joint: Joint) -> tuple[float, float]:
    lower, upper = get_limits(joint)
    lower, upper = max(lower, -_REACH), min(upper, _REACH)
    return (lower, upper) if lower <= upper else (0.0, 0.0)


def _find_bodies(path: Path) -> dict[str, str]:
    """Return the link whose body is the prim of each link or above it, by name."""
    found = {}
    stage = Usd.Stage.Open(str(path))
    for prim in stage.Traverse():
        name = prim.GetCustomDataByKey("urdf:link")
        body = prim
        while name and body and not body.HasAPI(UsdPhysics.RigidBodyAPI):
            body = body.GetParent()
        if name:
            found[str(name)] = str(body.GetCustomDataByKey("urdf:link")) if body else ""
    return found


def get_inertial(link: Link) -> tuple[float, Array, Array]:
    """Return mass, center of mass and inertia about it, in the frame of a link."""
    part = link.inertial
    if part is None or not part.mass:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    frame = get_origin_matrix(part.origin)
    tensor = np.zeros((3, 3))
    if part.inertia is not None:
        xx, xy, xz, yy, yz, zz = part.inertia.six
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        tensor = frame[:3, :3] @ local @ frame[:3, :3].T
    return part.mass, frame[:3, 3], tensor


def get_effort(joint: Joint) -> float:
    """Return the effort limit of a joint; infinity without one."""
    effort = joint.get_magnitude("effort")
    return np.inf if effort is None else effort


def get_gains(robot: Robot, joint: Joint) -> tuple[float, float]:
    """Return kp and kd of the drive of a joint [per rad or m]."""
    biases = [one.bias for one in robot.joint_actuators if one.joint == joint.name]
    return (-biases[0][1], -biases[0][2]) if biases else (0.0, 0.0)


def compare_poses(
    ours: Mapping[str, Array], theirs: Mapping[str, Array]
) -> Iterator[tuple[str, float]]:
    """Yield the difference of each pose in both, relative to the first of them."""
    shared = [name for name in ours if name in theirs]
    if not shared:
        return
    first, second = np.linalg.inv(ours[shared[0]]), np.linalg.inv(theirs[shared[0]])
    for name in shared:
        one, other = first @ ours[name], second @ theirs[name]
        size = max(1.0, float(np.abs(one).max()))
        yield name, float(np.abs(one - other).max()) / size


def resolve_mimic(joint: Joint, robot: Robot) -> tuple[float | str, ...]:
    """Return the last leader of a joint, and factor and offset to it."""
    factor, offset, seen = 1.0, 0.0, set()
    leader = joint
    while leader.mimic is not None and leader.name not in seen:
        seen.add(leader.name)
        if leader.mimic.joint not in robot.joint:
            break
        offset += factor * leader.mimic.offset
        factor *= leader.mimic.multiplier
        leader = robot.joint[leader.mimic.joint]
    return leader.name, factor, offset
