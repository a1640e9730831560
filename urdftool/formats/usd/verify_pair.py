"""What the comparisons of a stage share: the two robots, tolerances, and excuses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...mechanics.reference import get_origin_matrix
from ...model.elements import Joint, Link, Robot
from ..common.actuator_config import JointSettings
from ..common.losses import DeclaredLosses

Array = npt.NDArray[np.float64]

CONFIGURATIONS = 21
"""Random joint positions, in addition to zero. Chosen, no source."""

FLOAT = 1e-6
"""Relative tolerance: most values of a stage are 32-bit floats."""

MASS_LOSSES = ("lossy-massless-body",)
INERTIA_LOSSES = (
    *MASS_LOSSES,
    "lossy-inertia",
    "lossy-inertia-raised",
    "lossy-inertia-without-mass",
    "inertia-triangle-inequality",
)
TREE_LOSSES = ("lossy-joint-type", "lossy-floating-joint")


@dataclass(frozen=True)
class Pair:
    """A robot, and what was read of its export.

    Attributes:
        source: The robot.
        made: The robot of the stage.
        losses: What the export reported.
        configurations: Joint positions [rad or m] by joint of the source; the first is zero.
        body: Link with mass that carries each link, by name; empty for the world.
        settings: Values of joints from an actuator file, by name.
    """

    source: Robot
    made: Robot
    losses: DeclaredLosses
    configurations: list[dict[str, float]]
    body: dict[str, str]
    settings: Mapping[str, JointSettings]

    @property
    def links(self) -> Iterator[tuple[Link, Link]]:
        """Yield the links that both have."""
        for link in self.source.links:
            if link.name in self.made.link:
                yield link, self.made.link[link.name]

    @property
    def joints(self) -> Iterator[tuple[Joint, Joint]]:
        """Yield the joints that both have."""
        for joint in self.source.joints:
            if joint.name in self.made.joint:
                yield joint, self.made.joint[joint.name]


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


def get_effort(joint: Joint, settings: JointSettings) -> float:
    """Return the effort limit of a joint; infinity without one."""
    if settings.force_range is not None:
        return max(map(abs, settings.force_range))
    effort = joint.limit.effort if joint.limit is not None else None
    return np.inf if effort is None else abs(effort)


def get_resistance(joint: Joint, settings: JointSettings) -> tuple[float, float, float]:
    """Return friction, damping and armature of a joint."""
    dynamics = joint.dynamics
    own = JointSettings() if dynamics is None else JointSettings(
        friction=dynamics.friction, damping=dynamics.damping, armature=dynamics.armature
    )  # fmt: skip
    chosen = settings.override(own)
    return chosen.friction or 0.0, chosen.damping or 0.0, chosen.armature or 0.0


def get_gains(robot: Robot, joint: Joint, settings: JointSettings) -> tuple[float, float]:
    """Return stiffness and damping of the drives of a joint [per rad or m]."""
    drives = [a for a in robot.joint_actuators if a.joint == joint.name]
    own = JointSettings(
        kp=max(-sum(a.bias[1] * a.gear**2 for a in drives), 0.0),
        kd=max(-sum(a.bias[2] * a.gear**2 for a in drives), 0.0),
    )
    chosen = settings.override(own)
    return chosen.kp or 0.0, chosen.kd or 0.0


def is_below_changed_joint(pair: Pair, link: str) -> bool:
    """Tell whether a joint above a link was reported as changed."""
    joint = pair.source.tree.get_parent_joint(link)
    while joint is not None:
        if pair.losses.has_for(TREE_LOSSES, joint.name):
            return True
        joint = pair.source.tree.get_parent_joint(joint.parent)
    return False


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
