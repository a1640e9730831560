"""Whether the base of a robot is free or fixed to the world."""

from __future__ import annotations

from collections.abc import Mapping

from ...diagnostic import Severity
from ...model.drives import drive_plugins
from ...model.settings import is_set
from ...model.world import WORLD
from ..written import Written
from .option import Base
from .rigid_tree import RigidTree
from .shape_box import ShapeBoxes
from .standing import explain_free_base, measure_ground


def decide_base(
    tree: RigidTree,
    base: Base,
    virtual_joint: str | None,
    boxes: ShapeBoxes,
    home: Mapping[str, float],
    written: Written,
) -> tuple[bool, str]:
    """Decide whether the root is free, and why.

    ``auto`` uses the description and the support of the robot.
    """
    free, reason = _find_defined(tree, base, virtual_joint)
    if reason:
        return free, reason
    standing = explain_free_base(tree, boxes, home)
    if standing is None:
        return False, _explain_fixed_base(tree, boxes, home)
    written.report_loss(
        "free-base",
        f"root link '{tree.root.name}' has a free base: {standing}; --base fixed fixes it to the "
        "world",
        tree.root.place,
        kind="link",
        name=tree.root.name,
        severity=Severity.INFO,
    )
    return True, standing


def _explain_fixed_base(tree: RigidTree, boxes: ShapeBoxes, home: Mapping[str, float]) -> str:
    """Explain why nothing shows that the root is free."""
    if not any(link.collisions for link in tree.robot.links):
        return "no link has a collision, so a free one would fall through the ground"
    if measure_ground(tree, boxes, home) is None:
        return "no collision geometry can be read"
    return "the description has no sign of a mobile base"


def _find_defined(tree: RigidTree, base: Base, virtual_joint: str | None) -> tuple[bool, str]:
    """Return whether the root is free, and why; without a reason if nothing defines it."""
    robot = tree.robot
    if tree.root.name == WORLD:
        return False, "the root link is the world"
    if base != "auto":
        return base == "free", f"--base {base}"
    if robot.base is not None:
        return robot.base.is_free, "the base of the source"
    if is_set(robot.settings, "static"):
        return False, "<gazebo> says static"
    if virtual_joint is not None:
        return virtual_joint in ("floating", "planar"), f"virtual joint of type {virtual_joint}"
    for plugin in drive_plugins(robot):
        return True, f"the plugin {plugin.filename or plugin.name} drives it over the ground"
    return False, ""
