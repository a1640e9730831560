"""Links and joints that cannot move, for rules that matter only in motion."""

from __future__ import annotations

from ..model.elements import Robot
from ..source.document import Element

UNUSED_LINK = "does not use it, because the link is fixed to the world"
WELDED = "does not use it: it fixes the root link to the world"
UNUSED_JOINT = "does not use it, because the joint is fixed"


def why_unused(robot: Robot | None, element: Element) -> str:
    """Return why no reader uses the dynamics of a link or joint; empty if some do."""
    name = element.get("name")
    if robot is None or name is None:
        return ""
    if element.tag == "joint":
        joint = robot.joint.get(name)
        return UNUSED_JOINT if joint is not None and joint.is_fixed else ""
    if element.tag != "link":
        return ""
    seen: set[str] = set()
    while name != "world" and name not in seen:
        seen.add(name)
        joint = robot.tree.parent_joint(name)
        if joint is None or not joint.is_fixed:
            return ""
        name = joint.parent
    return UNUSED_LINK if name == "world" else ""


def is_welded_in_mujoco(robot: Robot | None, element: Element) -> bool:
    """Tell whether MuJoCo's URDF parser fixes a link to the world: the root and links fixed to it.

    The ``world`` body of MuJoCo has no mass, so the mass of such a link is lost. A root named
    ``world`` is the world itself.
    """
    name = element.get("name")
    if robot is None or element.tag != "link" or name not in robot.tree.bodies:
        return False
    return robot.tree.parent_joint(robot.tree.bodies[name]) is None
