"""Refuse robots that no engine can simulate, and make rigid bodies of the others."""

from __future__ import annotations

from collections.abc import Iterator

from ..errors import ModelError
from ..finding import Finding
from ..lint.validate import validate
from ..model.elements import BALL_TYPES, Robot
from ..model.kinematics import check_positions
from ..refusal import FATAL, make_defect, refuse
from ..suggestions import suggest_name
from .rigid_bodies import RigidBodyModel, make_rigid_bodies
from .settings import Settings

_FATAL = FATAL | {
    "not-a-number",
    "unknown-joint-type",
    "zero-axis",
    "mimic-cycle",
    "planar-or-floating",
    "negative-mass",
}


def prepare(robot: Robot, settings: Settings) -> RigidBodyModel:
    """Make rigid bodies of a robot, at the start of a run.

    Raises:
        ModelError: A defect prevents the simulation, or the settings name an unknown joint or link.
        UrdftoolError: A mesh is not found or cannot be read.
    """
    # joints of SDF and MJCF come first: a rule of URDF does not know their types
    refuse(
        [*_report_unsupported_joints(robot), *validate(robot, "export")], force=True, fatal=_FATAL
    )
    check_settings(robot, settings)
    return make_rigid_bodies(robot, settings)


def check_settings(robot: Robot, settings: Settings) -> None:
    """Refuse a pose of an unknown joint, and a payload of an unknown link.

    Raises:
        ModelError: The robot has no such joint or link.
    """
    check_positions(robot, settings.pose)
    for name in settings.payloads:
        if name not in robot.link:
            hint = suggest_name(name, robot.link, 0.5) or "; see 'urdftool graph'"
            raise ModelError(f"--payload: the robot has no link '{name}'{hint}")


def _report_unsupported_joints(robot: Robot) -> Iterator[Finding]:
    """Report joints that no engine simulates; other readers accept them, so this is not a rule.

    A floating joint below a root link without collisions describes a free base.
    """
    root = robot.tree.root
    for joint in robot.joints:
        if joint.type not in ("planar", "floating", "screw", *BALL_TYPES):
            continue
        if (
            joint.type == "floating"
            and root is not None
            and joint.parent == root.name
            and len(robot.tree.get_child_joints(root.name)) == 1
            and not root.collisions
        ):
            continue
        yield make_defect(
            "planar-or-floating",
            f"joint '{joint.name}' is {joint.type}, which is not simulated; replace it by "
            "prismatic and revolute joints"
            + (", or make it the only joint of the root" * (joint.type == "floating")),
            joint.locate_attribute("type"),
            "joint",
            joint.name,
        )
