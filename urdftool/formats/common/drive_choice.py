"""Which joints an export drives, and how: as described, and servos for the rest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.drives import get_actuator_kind, get_plugin_drives
from ...model.elements import Joint, Robot
from ..written import Written
from .actuator_config import JointSettings
from .option import Actuators
from .rigid_tree import RigidTree
from .standing import LEVEL, Ground

AUTO = ("auto", "described")
"""Words of ``--actuators`` that keep the drives of the description."""


@dataclass(frozen=True)
class Drive:
    """Actuator of a joint.

    Attributes:
        joint: The joint.
        kind: ``position``, ``velocity`` or ``motor``.
        reduction: Gear reduction of a motor.
        is_described: Whether the description or the user drives the joint by name.
    """

    joint: Joint
    kind: str
    reduction: float = 1.0
    is_described: bool = True


def list_drives(
    tree: RigidTree,
    joints: Sequence[Joint],
    actuators: Actuators,
    settings: Mapping[str, JointSettings],
    ground: Ground | None,
    written: Written,
) -> list[Drive]:
    """List the drives of the joints that an export drives; a follower has none.

    ``auto`` adds position servos to what the description drives.
    """
    robot = tree.robot
    described = dict(_list_described(robot, written)) if actuators in AUTO else {}
    passive = set(_list_loop_joints(robot)) if actuators == "auto" else set()
    raised: set[str] = set()
    if actuators == "auto" and described:
        passive |= set(_list_casters(tree, described, ground))
        raised = set(_list_limp(described, joints, ground))
    found, left = [], []
    for joint in joints:
        drive = None
        if joint.name in described:
            kind, reduction = described[joint.name]
            drive = Drive(joint, kind, reduction)
            if joint.name in raised:
                drive = Drive(joint, "position", is_described=False)
        elif joint.name in passive:
            left.append(joint.name)
        elif actuators not in ("none", "described"):
            drive = Drive(joint, "position" if actuators == "auto" else actuators,
                          is_described=False)  # fmt: skip
        drive = _choose_kind(joint, drive, settings.get(joint.name, JointSettings()))
        if drive is None:
            continue
        if not _is_follower(robot, joint):
            found.append(drive)
        elif joint.name in described:
            _report_follower(joint, written)
    _report_added(robot, [d for d in found if not d.is_described], left, actuators, written)
    return found


def _choose_kind(joint: Joint, drive: Drive | None, settings: JointSettings) -> Drive | None:
    """Return the drive of a joint after applying the user's settings."""
    kind = settings.type
    if kind is None and settings.kp is not None:
        kind = "position"
    if kind is None and settings.kd is not None and (drive is None or drive.kind == "motor"):
        kind = "velocity"
    if kind is None or (drive is not None and drive.kind == kind):
        return drive
    return Drive(joint, kind) if drive is None else replace(drive, kind=kind, reduction=1.0)


def _is_follower(robot: Robot, joint: Joint) -> bool:
    """Tell whether a joint mimics another one of the robot."""
    leader = None if joint.mimic is None else robot.joint.get(joint.mimic.joint)
    return leader is not None and leader is not joint


def _list_casters(
    tree: RigidTree, described: Mapping[str, tuple[str, float]], ground: Ground | None
) -> Iterator[str]:
    """Yield the continuous joints above the ground that nothing drives, next to driven wheels."""
    if ground is None or "velocity" not in {kind for kind, _ in described.values()}:
        return
    near = set(ground.get_near(LEVEL))
    below: dict[str, set[str]] = {name: {name} for name in tree.members}
    for joint in reversed(tree.moving):
        below[tree.group[joint.parent]] |= below[tree.group[joint.child]]
    for joint in tree.moving:
        is_low = bool(near & below[tree.group[joint.child]])
        if joint.type == "continuous" and is_low and joint.name not in described:
            yield joint.name


def _list_loop_joints(robot: Robot) -> Iterator[str]:
    """Yield the joints of each closed loop except one, which determines the others."""
    for closure in robot.closures:
        if closure.parent not in robot.link or closure.child not in robot.link:
            continue
        chains = [
            [name, *robot.tree.list_ancestors(name)] for name in (closure.parent, closure.child)
        ]
        loop = [n for chain in reversed(chains) for n in reversed(chain)
                if any(n not in other for other in chains)]  # fmt: skip
        joints = [robot.tree.get_parent_joint(name) for name in loop]
        moving = [j.name for j in joints if j is not None and not j.is_fixed]
        yield from moving[1:]


def _list_limp(
    described: Mapping[str, tuple[str, float]], joints: Sequence[Joint], ground: Ground | None
) -> Iterator[str]:
    """Yield the joints with an effort interface that let a robot fall which stands on its legs.

    In ROS, a controller holds such joints by their position; a motor without torque holds nothing.
    Wheels are continuous joints, and a robot with a driven one does not stand on legs.
    """
    if ground is None or "velocity" in {kind for kind, _ in described.values()}:
        return
    for joint in joints:
        if described.get(joint.name, ("", 0.0))[0] == "motor" and joint.type != "continuous":
            yield joint.name


def _list_described(robot: Robot, written: Written) -> Iterator[tuple[str, tuple[str, float]]]:
    """Yield kind and reduction of each joint that the description drives; the last wins."""
    for name, kind in get_plugin_drives(robot).items():
        yield name, (kind, 1.0)
    for transmission in robot.transmissions:
        reductions = [a.mechanical_reduction for a in transmission.actuators]
        reduction = next((r for r in reductions if r), 1.0)
        for joint in transmission.joints:
            if joint.name not in robot.joint:
                written.report_loss(
                    "transmission",
                    f"transmission '{transmission.name}' is of joint '{joint.name}', which "
                    "does not exist",
                    joint.place,
                    kind="transmission",
                    name=transmission.name,
                )
                continue
            names = [*joint.hardware_interfaces]
            names += [name for a in transmission.actuators for name in a.hardware_interfaces]
            kind = get_actuator_kind(names)
            if "simple" not in transmission.type.lower() and transmission.type:
                written.report_loss(
                    "transmission",
                    f"transmission '{transmission.name}' of type {transmission.type} is written as "
                    "one actuator a joint",
                    transmission.place,
                    kind="transmission",
                    name=transmission.name,
                )
            yield joint.name, (kind, reduction if kind == "motor" else 1.0)
    for block in robot.ros2_controls:
        for component in block.joints:
            names = [interface.name for interface in component.command_interfaces]
            if names and component.name in robot.joint:
                yield component.name, (get_actuator_kind(names), 1.0)


def _report_follower(joint: Joint, written: Written) -> None:
    assert joint.mimic is not None
    written.report_loss(
        "mimic-actuator",
        f"joint '{joint.name}' mimics '{joint.mimic.joint}' and gets no actuator",
        joint.place,
        kind="joint",
        name=joint.name,
        severity=Severity.INFO,
    )


def _report_added(
    robot: Robot, added: list[Drive], left: list[str], actuators: Actuators, written: Written
) -> None:
    """Report the servos that the description does not have, and the joints that get none."""
    if actuators != "auto":
        return
    if added:
        names = [drive.joint.name for drive in added]
        written.report_loss(
            "added-servo",
            "position servos that the description does not have hold "
            f"{len(added)} {'joint' if len(added) == 1 else 'joints'}: {quote_first(names, 4)}; "
            "--actuators described writes only what transmissions, ros2_control and drive plugins "
            "describe",
            robot.place,
            severity=Severity.INFO,
            data={"joints": names},
        )
    if left:
        written.report_loss(
            "passive-joint",
            "casters next to driven wheels, and joints that a closed loop moves, get no servo: "
            f"{quote_first(left, 4)}",
            robot.place,
            severity=Severity.INFO,
            data={"joints": left},
        )
