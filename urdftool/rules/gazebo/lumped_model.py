"""Find the links and joints of a URDF that remain in the model in Gazebo."""

from __future__ import annotations

from collections.abc import Iterator, Set

from ...model.block_elements import list_model_elements
from ...model.elements import Joint, Robot
from ...source.document import Element
from ..inertia.bodies import compute_mass, find_rigid_bodies
from .lumping import is_lumped


def find_kept_links(robot: Robot) -> set[str] | None:
    """Find the links that sdformat 12.3 writes: bodies with mass on bodies with mass.

    A body has the name of its topmost link. sdformat omits all links below a body without mass, and
    all links if the root has no mass.

    Returns:
        The names, or None if the robot is not one tree, of which sdformat reads nothing.
    """
    if len(robot.tree.roots) != 1:
        return None
    kept: set[str] = set()
    owner: dict[str, str] = {}
    for top, links in find_rigid_bodies(robot).items():
        owner.update((link.name, top) for link in links)
        joint = robot.tree.get_parent_joint(top)
        held = joint is None or joint.parent == "world" or owner.get(joint.parent) in kept
        if held and top != "world" and compute_mass(links) > 0:
            kept.add(top)
    return kept


def is_joint_kept(robot: Robot, joint: Joint, kept: Set[str]) -> bool:
    """Tell whether a joint stays one in Gazebo, with the links of :func:`find_kept_links`."""
    return joint.child in kept and not is_lumped(robot, joint.child)


def is_named_as_link(robot: Robot, joint: Joint, kept: Set[str]) -> bool:
    """Tell whether Gazebo rejects the model because a joint and a link have the same name."""
    if joint.name not in robot.link or not is_joint_kept(robot, joint, kept):
        return False
    return joint.name in kept or joint.name == "world"


def find_sdf_joints(robot: Robot) -> Iterator[Element]:
    """List the ``<joint>`` elements of SDF in ``<gazebo>`` blocks without a reference."""
    yield from (element for element in list_model_elements(robot) if element.tag == "joint")
