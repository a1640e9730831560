"""Findings and effects that concern no reader which a project uses: off by default, and counted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot
from ..rules.rule import Rule
from .effect_kinds import FLAGGED, INTENDED, REJECTS, WRITTEN
from .imported_readers import Use
from .libraries import CHAIN, OWN, PLANNER, SCENE, TESSERACT

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
    OWN: (),
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


def is_for_other_readers(rule: Rule, finding: Finding, used: Use, kinds: Mapping[str, str]) -> bool:
    """Tell whether a finding has effects only on readers that a project does not use.

    A project without dynamics uses no inertia and no drive. Readers of kinematics are named by no
    effect: what is wrong with the tree, names and joints concerns them, and shapes only some.
    """
    if used.readers and all(rule.name in _TAKEN.get(reader, ()) for reader in used.readers):
        return not finding.effects  # of URDF, they decide
    if TESSERACT in used.readers and rule.name in _OF_SRDF:
        return False
    if rule.family in _OF_ROS:
        return not _is_affected(used, kinds)
    if not used.moving and is_of_dynamics(rule):
        return not any(kind == REJECTS and is_used(one, used) for one, kind in kinds.items())
    if rule.name == "mesh-not-found" and not _is_affected(used, kinds):
        return not any(key.startswith("pybullet") for key in finding.effects)  # found from above
    if rule.family == "name" or not _has_readers(finding) or _is_affected(used, kinds):
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


def _is_affected(used: Use, kinds: Mapping[str, str]) -> bool:
    """Tell whether a finding changes what a reader of a project gets."""
    meant = {INTENDED} if used.keeps_inertia else {INTENDED, FLAGGED}
    return any(kind not in meant for reader, kind in kinds.items() if is_used(reader, used))


def lower_severity(finding: Finding, used: Use, kinds: Mapping[str, str]) -> Finding:
    """Return a finding that is no error if all readers of a project take the robot as it is."""
    found = {kind for reader, kind in kinds.items() if reader in used.readers}
    if finding.severity is not Severity.ERROR or not found or not found <= {INTENDED, WRITTEN}:
        return finding
    return replace(finding, severity=Severity.WARNING)


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
