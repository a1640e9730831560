"""Additions of ``--for rl``, which authors of models for learned policies write by hand.

Values of the description and of the user are kept; the additions fill what neither has.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Dynamics, Joint, Link, Robot
from ...model.kinematics import link_poses
from ...model.mechanism import MountedSensor
from ...model.pose import Pose
from ...model.settings import Settings, Value
from ..common.actuator_config import JointSettings
from ..common.drive_choice import Drive
from ..common.servo_gains import drop_unlimited
from ..common.standing import CLEARANCE, Ground, is_wheel
from ..written import Written
from .joint import get_effort
from .structure import Structure

ARMATURE = 4e-4
"""Armature [kg·m²] relative to the effort limit [N·m] of a hinge: between 0.01 at 24 N·m (Go2) and
0.1 at 200 to 300 N·m (H1) measured in the models of Unitree."""

FRICTION = 0.005
"""Friction loss relative to the effort limit: between 0.2 of 24 N·m (Go2) and 0 (H1),
measured as above."""

CONDIM = 6.0
"""Dimension of the contacts of feet: with torsional and rolling friction, measured in
Unitree's Go2."""

JOINT_KINDS = (("jointpos", "_position"), ("jointvel", "_velocity"))
"""Sensors of a joint that control policies read, with the suffixes of their names."""

DRIVEN_KIND = ("jointactuatorfrc", "_actuator_force")
"""Sensor of a joint with an actuator."""


def replace_motors(
    drives: Iterable[Drive], settings: Mapping[str, JointSettings]
) -> Iterator[Drive]:
    """Yield drives with a position servo in place of each motor of a joint that does not roll."""
    for drive in drives:
        own = settings.get(drive.joint.name, JointSettings())
        if drive.kind == "motor" and drive.joint.type != "continuous" and own.type is None:
            yield Drive(drive.joint, "position")
        else:
            yield drive


def add_rotors(
    structure: Structure, settings: Mapping[str, JointSettings], written: Written
) -> Robot:
    """Return the robot with armature and friction loss of hinges, by their effort limits."""
    changed: list[str] = []
    joints = []
    for joint in structure.robot.joints:
        added = joint
        if structure.get_kind(joint) == "hinge":
            added = _add_rotor(joint, settings.get(joint.name, JointSettings()))
        if added is not joint:
            changed.append(joint.name)
        joints.append(added)
    if changed:
        written.report_loss(
            "rotor",
            f"--for rl gives {len(changed)} joints an armature of {ARMATURE:g} kg·m² and a "
            f"friction loss of {FRICTION:g} N·m for each N·m of their effort limits, where the "
            "description has none; --actuator-config sets others",
            structure.robot.place,
            severity=Severity.INFO,
            data={"joints": changed},
        )
    return replace(structure.robot, joints=joints)


def _add_rotor(joint: Joint, settings: JointSettings) -> Joint:
    effort = drop_unlimited(get_effort(joint))
    before = joint.dynamics or Dynamics(joint.provenance)
    after = before
    if effort and settings.armature is None and not before.armature:
        after = replace(after, armature=_round(ARMATURE * effort))
    if effort and settings.friction is None and not before.friction:
        after = replace(after, friction=_round(FRICTION * effort))
    return joint if after is before else replace(joint, dynamics=after)


def find_feet(
    structure: Structure, ground: Ground | None, root: Pose, positions: Mapping[str, float]
) -> frozenset[str]:
    """Find the links that carry a free robot, without its root and its wheels."""
    if ground is None:
        return frozenset()
    found, poses = set(), link_poses(structure.robot, positions)
    for body in ground.get_near(CLEARANCE):
        joint = structure.robot.tree.get_parent_joint(body)
        if joint is None or (
            joint.type == "continuous" and is_wheel(joint, root @ poses[joint.child], ground)
        ):
            continue
        found.add(ground.feet[body])
    return frozenset(found)


def set_foot_contact(link: Link, feet: Set[str]) -> Link:
    """Return a link; the collisions of a foot get ``condim`` and ``priority`` where it has none."""
    if link.name not in feet:
        return link
    added: Settings = {"condim": Value(None, CONDIM), "priority": Value(None, 1.0)}
    return replace(
        link, collisions=[replace(one, surface=added | one.surface) for one in link.collisions]
    )


def list_joint_sensors(structure: Structure, driven: Set[str]) -> Iterator[MountedSensor]:
    """Yield sensors of position, velocity and actuator force that no joint of the source has."""
    there = {(sensor.type, sensor.joint) for sensor in structure.robot.mounted_sensors}
    for tag, suffix in (*JOINT_KINDS, DRIVEN_KIND):
        for joint in structure.moving:
            if not structure.is_single(joint):
                continue
            if (tag, joint.name) in there or (tag == DRIVEN_KIND[0] and joint.name not in driven):
                continue
            yield MountedSensor(None, joint.name + suffix, tag, "", joint.name)


def _round(value: float) -> float:
    """Round to two digits: a value from a rule has no more."""
    return float(f"{value:.2g}")
