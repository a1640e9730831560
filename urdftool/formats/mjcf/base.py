"""Choice between a fixed and a floating base."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ...diagnostic import Severity
from ...rules.gazebo.keywords import is_true
from ..written import Written
from .drives import drive_plugins
from .options import Base
from .shape_box import ShapeBoxes
from .standing import explain_free_base
from .structure import Structure


def decide_base(
    structure: Structure,
    base: Base,
    virtual_joint: str | None,
    boxes: ShapeBoxes,
    home: Mapping[str, float],
    written: Written,
) -> Structure:
    """Decide whether the root is free, and return the structure with the decision.

    Args:
        structure: The kinematic tree.
        base: ``fixed``, ``free``, or ``auto``, which uses the description and the support of the
            robot.
        virtual_joint: Type of the SRDF's virtual joint, if there is one.
        boxes: Boxes of the robot's shapes.
        home: Joint positions at home [rad, m].
        written: Receives a note if the root is free because of what supports the robot.
    """
    free, reason = _decide(structure, base, virtual_joint)
    if not reason:
        standing = explain_free_base(structure, boxes, home)
        free, reason = (
            standing is not None,
            standing or "the description has no sign of a mobile base",
        )
        if free:
            written.report_loss(
                "free-base",
                (
                    f"root link '{structure.root.name}' has a free base: {reason}; --base fixed "
                    "fixes "
                    "it to the world"
                ),
                structure.root.place,
                kind="link",
                name=structure.root.name,
                severity=Severity.INFO,
            )
    return replace(structure, free=free, reason=reason)


def _decide(structure: Structure, base: Base, virtual_joint: str | None) -> tuple[bool, str]:
    """Return whether the root is free, and why; without a reason if nothing defines it."""
    robot = structure.robot
    if structure.in_world:
        return False, "the root link is the world"
    if base != "auto":
        return base == "free", f"--base {base}"
    if any(is_true(block.get_value("static")) for block in robot.extensions.get(None, ())):
        return False, "<gazebo> says static"
    if virtual_joint is not None:
        return virtual_joint in ("floating", "planar"), f"virtual joint of type {virtual_joint}"
    for plugin in drive_plugins(robot):
        return True, f"the plugin {plugin.filename or plugin.name} drives it over the ground"
    return False, ""
