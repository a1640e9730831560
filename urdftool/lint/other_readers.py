"""Findings and effects that concern no reader which a project uses: off by default, and counted."""

from __future__ import annotations

import re
from dataclasses import replace

from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot
from ..rules.rule import Rule
from .imported_readers import Use
from .libraries import CHAIN, PLANNER, SCENE, TESSERACT

_KNOWN = frozenset(
    (
        *("gz", "gazebo-classic", "mujoco", "pybullet", "drake", "newton", "isaac", "pinocchio"),
        *("urdfdom", "rviz", "moveit", "KDL", "check_urdf", "robot_state_publisher", "tf2"),
        *("controller_manager", "gazebo_ros_control", "gz_ros2_control", "ros2_control"),
        *("joint_trajectory_controller", "gazebo_ros", "image_geometry"),
    )
)
"""Readers and programs of ROS and simulators, as effects name them."""

_OF_ROS = ("gazebo", "control", "moveit")
"""Families of rules about Gazebo, ROS and MoveIt."""

_UNAFFECTED = re.compile(
    r"(accept|read)s? it$|loads? it(: without .*)?$|(load|use)s? .*, and loads the robot$"
    r"|load the robot anyway$|load the same robot|reads? it as intended$|ignores? (<gazebo>"
    r"|the (version|declaration|soft limits|inertia))$|uses the convex hull"
    r"|takes the folder of that name as the package$|load the robot without opening"
)
"""Effect on a reader to which the finding does not matter."""

_UNAFFECTED_UNLESS_INERTIA = re.compile(r"accepts? it( without a message|: the shape is flat)$")
"""The same, except for an inertia, which a reader then computes with."""

_OF_FLAG = re.compile(r"URDF_USE_INERTIA_FROM_FILE")
"""Effect on PyBullet of an inertia that it takes only with this flag."""

_REQUIRED = "takes 0"
"""Effect on PyBullet of an effort or velocity that is not written: both are of the drive."""

_OF_DRIVES = frozenset(
    (
        *("missing-limit", "limit-without-effort-or-velocity", "zero-effort-limit"),
        *("zero-velocity-limit", "negative-limit", "implausible-velocity", "implausible-effort"),
        *("negative-dynamics", "empty-dynamics", "dynamics-as-child-elements", "missing-dynamics"),
        *("incomplete-safety-controller", "soft-limits-lock-joint", "soft-limits-outside-hard"),
        *("soft-limits-far-inside", "mimic-not-simulated"),
    )
)
"""Rules about drives and their limits, which no reader without dynamics takes."""

_LEFT_OUT = {
    TESSERACT: (),
    PLANNER: (),
    SCENE: ("collision",),
    CHAIN: ("collision", "visual", "mesh", "package"),
}
"""Families of rules that concern no reader of a kind, the kind with most uses first."""


_TAKEN = {"drake": frozenset(("zero-effort-limit", "zero-mass"))}
"""Rules about values that a reader takes as meant, in SDF: a joint without a motor, no mass."""

_OF_SRDF = frozenset(
    (
        *("srdf-unknown-link", "srdf-unknown-joint", "srdf-robot-name", "disabled-pair-can-touch"),
        *("group-state-out-of-bounds",),
    )
)
"""Rules about an SRDF that hold for Tesseract, too: what it names, and pairs that touch.

Its chains may lead from one branch to another: they are those of KDL.
"""


def is_for_other_readers(rule: Rule, finding: Finding, used: Use) -> bool:
    """Tell whether a finding has effects only on readers that a project does not use.

    A project without dynamics uses no inertia and no drive. Readers of kinematics are named by no
    effect: what is wrong with the tree, names and joints concerns them, and shapes only some.
    """
    if used.readers and all(rule.name in _TAKEN.get(reader, ()) for reader in used.readers):
        return not finding.effects  # of URDF, they decide
    if TESSERACT in used.readers and rule.name in _OF_SRDF:
        return False
    if rule.family in _OF_ROS:
        return not _is_affected(rule, finding, used)
    if not used.moving and is_of_dynamics(rule):
        return not any("reject" in text for text in _select_effects(finding, used).values())
    if rule.name == "mesh-not-found" and not _is_affected(rule, finding, used):
        return not any(key.startswith("pybullet") for key in finding.effects)  # found from above
    if rule.family == "name" or not _has_readers(finding) or _is_affected(rule, finding, used):
        return False
    for kind, left_out in _LEFT_OUT.items():
        if kind in used.readers:
            if finding.severity is Severity.INFO:
                return True
            return is_of_dynamics(rule) or rule.family in left_out
    takes_as_written = used.keeps_inertia and rule.family == "inertia" and rule.of_motion
    return not (takes_as_written and "pybullet" in used.readers)


def is_of_dynamics(rule: Rule) -> bool:
    """Tell whether a rule concerns only readers that compute motion from masses and forces."""
    is_of_mass = rule.family in ("inertia", "simulation") or rule.of_motion
    return is_of_mass or rule.name in _OF_DRIVES


def _has_readers(finding: Finding) -> bool:
    """Tell whether a finding has effects, all on known readers."""
    keys = [reader for key in finding.effects for reader in key.split(", ")]
    return bool(keys) and _KNOWN.issuperset(keys)


def _is_affected(rule: Rule, finding: Finding, used: Use) -> bool:
    """Tell whether a finding changes what a reader of a project gets."""
    for key, text in _select_effects(finding, used).items():
        if _UNAFFECTED.match(text):
            continue
        if rule.family != "inertia" and _UNAFFECTED_UNLESS_INERTIA.match(text):
            continue
        if key == "pybullet":
            if _OF_FLAG.search(text) and not used.keeps_inertia and rule.name != "missing-inertial":
                continue
            if text == _REQUIRED and rule.name in _OF_DRIVES:
                continue
        return True
    return False


def _select_effects(finding: Finding, used: Use) -> dict[str, str]:
    """Return the effect on each reader that a project uses, and on others than readers."""
    return {
        reader: text
        for key, text in finding.effects.items()
        for reader in key.split(", ")
        if is_used(reader, used)
    }


def is_used(reader: str, used: Use) -> bool:
    """Tell whether a project uses a reader; Pinocchio reads by urdfdom."""
    if reader == "urdfdom":
        return "pinocchio" in used.readers
    return reader in used.readers or reader not in _KNOWN


def drop_other_effects(finding: Finding, used: Use | None) -> Finding:
    """Return a finding without effects on readers that a project does not use.

    The page of its rule has them all.
    """
    if used is None or not finding.effects:
        return finding
    from .moot import convert_to_singular

    effects = {}
    for key, text in finding.effects.items():
        readers = key.split(", ")
        left = [reader for reader in readers if is_used(reader, used)]
        if left:
            is_one = len(left) == 1 < len(readers)
            effects[", ".join(left)] = convert_to_singular(text) if is_one else text
    return replace(finding, effects=effects)


def is_of_unmoved_robot(rule: Rule, finding: Finding, robot: Robot | None) -> bool:
    """Tell whether a remark about motion is about a robot that no simulator moves.

    That is a marker, of which no joint moves and nothing collides, and a robot for kinematics, of
    which no link has an inertial: ``missing-inertial`` reports that once. A single body with
    collision geometry, as a drone or an object to grasp, moves as a whole.
    """
    if robot is None or not rule.of_motion or finding.severity is Severity.ERROR:
        return False
    if not robot.links:
        return False
    if robot.moving_joints:
        return robot.format == "urdf" and all(link.inertial is None for link in robot.links)
    return not any(link.collisions for link in robot.links)
