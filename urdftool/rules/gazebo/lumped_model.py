"""Find the links and joints of a URDF that remain in the model in Gazebo."""

from __future__ import annotations

from collections.abc import Iterator, Set

from ...model.block_elements import list_model_elements
from ...model.elements import Joint, Robot
from ...source.document import Element
from .lumping import get_lumped_body, is_lumped

_NO_MASS = 1e-6
"""Mass [kg] up to which sdformat 12.3 takes one as 0 (run; gz::math::equal)."""


def find_kept_links(robot: Robot) -> set[str] | None:
    """Find the links that sdformat 12.3 writes: bodies with mass on links with mass.

    A body has the name of its topmost link. sdformat omits all links below a body without mass, and
    all links if the root has no mass. It also omits those below a link that is lumped and has no
    mass with the links lumped into it, though the body has one.

    Returns:
        The names, or None if the robot is not one tree, of which sdformat reads nothing.
    """
    if len(robot.tree.roots) != 1:
        return None
    masses = _compute_masses(robot)
    kept: set[str] = set()
    held: set[str] = set()  # links on which a joint keeps its child
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        has_mass = abs(masses[name]) > _NO_MASS
        if is_lumped(robot, name):
            if has_mass and get_lumped_body(robot, name) in kept:
                held.add(name)
        elif has_mass and (joint is None or joint.parent == "world" or joint.parent in held):
            held.add(name)
            if name != "world":
                kept.add(name)
    return kept


def _compute_masses(robot: Robot) -> dict[str, float]:
    """Compute the mass [kg] of each link with the links that are lumped into it."""
    masses: dict[str, float] = {}
    for name in reversed(robot.tree.order):
        children = (joint.child for joint in robot.tree.get_child_joints(name))
        lumped = (child for child in children if is_lumped(robot, child))
        masses[name] = robot.link[name].mass + sum(masses.get(c, 0.0) for c in lumped)
    return masses


def find_massless_holders(robot: Robot, kept: Set[str]) -> dict[str, list[str]]:
    """Find lumped links without mass for which Gazebo omits bodies with mass whose joint is there.

    Args:
        robot: The robot, which is one tree.
        kept: The links of :func:`find_kept_links`.

    Returns:
        The omitted links, by the link without mass.
    """
    omitted = [joint for joint in robot.joints if not is_lumped(robot, joint.child)]
    omitted = [joint for joint in omitted if joint.child not in kept and joint.parent in robot.link]
    found: dict[str, list[str]] = {}
    masses = _compute_masses(robot) if omitted else {}
    for joint in omitted:
        holder = joint.parent
        if is_lumped(robot, holder) and get_lumped_body(robot, holder) in kept:
            if masses.get(joint.child, 0.0) > _NO_MASS >= abs(masses.get(holder, 0.0)):
                found.setdefault(holder, []).append(joint.child)
    return found


def find_omitted_links(robot: Robot, kept: Set[str]) -> Iterator[str]:
    """List the links that Gazebo omits, with the links of :func:`find_kept_links`."""
    for name in robot.tree.order:
        if name != "world" and get_lumped_body(robot, name) not in kept:
            yield name


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
