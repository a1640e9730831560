"""Links and joints that cannot move, for rules that matter only in motion."""

from __future__ import annotations

from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot
from ..rules.mesh.link_extents import get_extents
from ..rules.rule import Problem, Rule

WELDED = "does not use it: it fixes the root link to the world"
UNUSED_JOINT = "does not use it, because the joint is fixed"


def is_joint_unused(robot: Robot | None, problem: Problem) -> bool:
    """Tell whether no reader uses the dynamics of a subject, because it is a fixed joint."""
    if robot is None or problem.kind != "joint":
        return False
    joint = robot.joint.get(problem.name)
    return joint is not None and joint.is_fixed


def is_link_unused(
    robot: Robot | None, problem: Problem, welded: frozenset[str] = frozenset()
) -> bool:
    """Tell whether no reader uses the inertia of a subject: a link that is fixed to the world.

    Args:
        robot: The robot.
        problem: The problem with the subject.
        welded: Links that a program welds to the world.
    """
    name = problem.name
    if robot is None or not name or problem.kind != "link":
        return False
    seen: set[str] = set()
    while name != "world" and name not in welded and name not in seen:
        seen.add(name)
        joint = robot.tree.get_parent_joint(name)
        if joint is None:  # the root, which MJCF fixes to the world unless it is free
            return robot.base is not None and not robot.base.is_free
        if not joint.is_fixed:
            return False
        name = joint.parent
    return name == "world" or name in welded


def is_welded_in_mujoco(robot: Robot | None, problem: Problem) -> bool:
    """Tell whether MuJoCo's URDF parser fixes a link to the world: the root and links fixed to it.

    The ``world`` body of MuJoCo has no mass, so the mass of such a link is lost. A root named
    ``world`` is the world itself.
    """
    name = problem.name
    if robot is None or problem.kind != "link" or name not in robot.tree.bodies:
        return False
    return robot.tree.get_parent_joint(robot.tree.bodies[name]) is None


_SCENERY = 0.8
"""Length [m] of a link from which a model without a moving joint is scenery, as a table or a floor,
and no object to grasp. Chosen, no source.
"""


def is_of_scenery(rule: Rule, finding: Finding, robot: Robot | None) -> bool:
    """Tell whether a remark about motion is about scenery, which code fixes to the world.

    It is a URDF or SDF without a moving joint, of which a link is as long as furniture, or as far
    from its frame.
    """
    if robot is None or finding.severity is Severity.ERROR:
        return False
    if not rule.of_motion and rule.family != "inertia":
        return False
    if robot.format not in ("urdf", "sdf") or robot.moving_joints:
        return False
    reach = get_extents(robot)
    boxes = (reach.get_link_box(link) for link in robot.links)
    return any(
        box is not None and max(*box.size, *map(abs, (*box.low, *box.high))) >= _SCENERY
        for box in boxes
    )


def replace_mujoco(effects: dict[str, str]) -> dict[str, str]:
    """Replace the effect on MuJoCo by ``WELDED`` where it is one of at least three readers."""
    found = {}
    for key, effect in effects.items():
        readers = key.split(", ")
        others = ", ".join(reader for reader in readers if reader != "mujoco")
        if len(readers) < 3 or "mujoco" not in readers:
            found[key] = effect
            continue
        found[others] = effect
        found["mujoco"] = WELDED
    return found
