"""A robot in the conventions of another, as a correspondence declares them.

The arithmetic is of 4 × 4 matrices, and shares nothing with the code that edits descriptions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import copy
from dataclasses import replace
from typing import TypeVar

import numpy as np

from ..errors import ConfigError
from ..mechanics.reference import Array, get_origin_matrix, turn
from ..model.elements import (
    Axis,
    Calibration,
    Inertia,
    Inertial,
    Joint,
    Limit,
    Link,
    Mesh,
    Mimic,
    Origin,
    Robot,
    SafetyController,
)
from ..model.settings import Settings
from ..model.urdf_schema import BLOCKS
from ..source.document import Element
from .bodies import HINGES, compute_axis
from .correspondence import PLANES, Correspondence, FrameMove, JointValue
from .frames import invert
from .shifted_blocks import shift_blocks

_ONE_POSITION = (*HINGES, "prismatic")


def express_pair(a: Robot, b: Robot, declared: Correspondence) -> tuple[Robot, Robot]:
    """Return both robots in the conventions of the second, without undeclared parts.

    Args:
        a: The first robot.
        b: The second.
        declared: How the second was made of the first.

    Raises:
        ConfigError: A declared link or joint does not exist, or cannot be what is declared.
    """
    for name in declared.removed:
        a = drop_branch(a, name)
    for name in declared.added:
        b = drop_branch(b, name)
    if declared.branch[0]:
        a = take_branch(a, declared.branch[0])
    if declared.branch[1]:
        b = take_branch(b, declared.branch[1])
    if declared.root:
        a = take_root(a, declared.root)
    if declared.mirror:
        a = mirror_robot(a, declared.mirror)
    for move in declared.frames:
        a = move_frame(a, move)
    return shift_positions(a, declared.values), b


def _find_link(robot: Robot, name: str) -> Link:
    if name not in robot.link:
        raise ConfigError(f"link '{name}' of the correspondence is not in robot '{robot.name}'")
    return robot.link[name]


def make_origin(pose: Array, part: Origin | None) -> Origin:
    """Return a pose as an origin with a quaternion, at the place of the given one."""
    r = pose[:3, :3]
    four = np.array(  # 4 q qᵀ of the quaternion q = x, y, z, w
        [
            [
                1 + r[0, 0] - r[1, 1] - r[2, 2],
                r[0, 1] + r[1, 0],
                r[0, 2] + r[2, 0],
                r[2, 1] - r[1, 2],
            ],
            [
                r[0, 1] + r[1, 0],
                1 - r[0, 0] + r[1, 1] - r[2, 2],
                r[1, 2] + r[2, 1],
                r[0, 2] - r[2, 0],
            ],
            [
                r[0, 2] + r[2, 0],
                r[1, 2] + r[2, 1],
                1 - r[0, 0] - r[1, 1] + r[2, 2],
                r[1, 0] - r[0, 1],
            ],
            [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], 1 + np.trace(r)],
        ]
    )
    row = four[int(np.argmax(np.diag(four)))]
    qx, qy, qz, qw = (float(value) for value in row / np.linalg.norm(row))
    x, y, z = (float(value) for value in pose[:3, 3])
    place = None if part is None else part.provenance
    return Origin(place, (x, y, z), (0.0, 0.0, 0.0), (qx, qy, qz, qw))


def drop_branch(robot: Robot, name: str) -> Robot:
    """Return the robot without a link and all below it."""
    _find_link(robot, name)
    gone = {name, *robot.tree.list_descendants(name)}
    return _keep(robot, gone.__contains__)


def take_branch(robot: Robot, name: str) -> Robot:
    """Return a link and all below it as a robot."""
    _find_link(robot, name)
    kept = {name, *robot.tree.list_descendants(name)}
    robot = _keep(robot, lambda link: link not in kept)
    return replace(robot, base=None)


def _keep(robot: Robot, is_gone: Callable[[str], bool]) -> Robot:
    links = [link for link in robot.links if not is_gone(link.name)]
    if not links:
        raise ConfigError(f"the correspondence leaves no link of robot '{robot.name}'")
    joints = [j for j in robot.joints if not is_gone(j.child) and not is_gone(j.parent)]
    lost = set(robot.link) - {link.name for link in links}
    gone = set(robot.joint) - {joint.name for joint in joints}
    sensors = [s for s in robot.mounted_sensors if s.link not in lost and s.joint not in gone]
    return replace(
        robot,
        links=links,
        joints=joints,
        cameras=[camera for camera in robot.cameras if camera.link not in lost],
        mounted_sensors=sensors,
        provenance=robot.xml and _drop_blocks(robot.xml, lost, gone),
    )


def _drop_blocks(root: Element, links: set[str], joints: set[str]) -> Element:
    """Return a description without the blocks about links and joints that are gone.

    A ``<ros2_control>`` that is about other joints, too, keeps these.
    """
    made = copy(root)
    made.children = []
    for block in root.children:
        cut = [e for e in block.list_children("joint") if e.get("name") in joints]
        rest = [e for e in block.list_children("joint") if e not in cut]
        if block.tag == "ros2_control" and cut and rest:
            part = copy(block)
            part.children = [e for e in block.children if e not in cut]
            made.children.append(part)
            continue
        is_gone = bool(cut) or (block.tag == "gazebo" and block.get("reference") in links | joints)
        if block.tag not in BLOCKS or not is_gone:
            made.children.append(block)
    return made


def take_root(robot: Robot, name: str) -> Robot:
    """Return the robot as a tree from another link; link frames and positions are the same.

    A joint that is turned round gets a virtual link at its axis, to which the old parent is fixed.
    """
    _find_link(robot, name)
    turned: dict[str, list[Joint]] = {}
    virtual: list[Link] = []
    link = name
    while (joint := robot.tree.get_parent_joint(link)) is not None:
        turned[joint.name], extra = _turn_round(joint)
        virtual += extra
        link = joint.parent
    joints = [part for joint in robot.joints for part in turned.get(joint.name, [joint])]
    return replace(robot, links=[*robot.links, *virtual], joints=joints)


def _turn_round(joint: Joint) -> tuple[list[Joint], list[Link]]:
    """Return the joints that connect the parent to the child, and the link between them."""
    if joint.type != "fixed" and joint.type not in _ONE_POSITION:
        raise ConfigError(f"{joint.type} joint '{joint.name}' is on the way to the declared root")
    pose = invert(get_origin_matrix(joint.origin))
    at = make_origin(pose, joint.origin)
    if joint.is_fixed:
        return [replace(joint, parent=joint.child, child=joint.parent, origin=at)], []
    middle = f"{joint.parent} at {joint.name}"
    moving = replace(
        joint, parent=joint.child, child=middle, origin=None, axis=_scale_axis(joint, -1.0)
    )
    fixed = Joint(joint.provenance, f"{middle} (fixed)", "fixed", middle, joint.parent, origin=at)
    return [moving, fixed], [Link(joint.provenance, middle, is_virtual=True)]


def _scale_axis(joint: Joint, sign: float) -> Axis:
    x, y, z = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    place = joint.provenance if joint.axis is None else joint.axis.provenance
    return Axis(place, (sign * x, sign * y, sign * z))


def mirror_robot(robot: Robot, plane: str) -> Robot:
    """Return the mirror image; each link frame R becomes S R S, with the reflection S.

    Positions of joints keep their values: the axis of a rotation is a pseudovector.
    """
    flip = np.eye(4)
    index = PLANES[plane]
    flip[index, index] = -1.0
    links = [mirror_link(link, flip, index) for link in robot.links]
    joints = [mirror_joint(joint, flip) for joint in robot.joints]
    sensors = [replace(s, origin=_mirror_origin(s.origin, flip)) for s in robot.mounted_sensors]
    cameras = [replace(c, origin=_mirror_origin(c.origin, flip)) for c in robot.cameras]
    return replace(robot, links=links, joints=joints, mounted_sensors=sensors, cameras=cameras)


T = TypeVar("T")


def _mirror_origin(origin: Origin | None, flip: Array) -> Origin | None:
    if origin is None:
        return None
    return make_origin(flip @ get_origin_matrix(origin) @ flip, origin)


def mirror_link(link: Link, flip: Array, index: int) -> Link:
    """Return the mirror image of a link, whose frame R becomes S R S.

    Args:
        link: The link.
        flip: S, 4 × 4.
        index: Coordinate that S negates.
    """
    visuals = [
        replace(v, origin=_mirror_origin(v.origin, flip), geometry=_mirror_mesh(v.geometry, index))
        for v in link.visuals
    ]
    collisions = [
        replace(c, origin=_mirror_origin(c.origin, flip), geometry=_mirror_mesh(c.geometry, index))
        for c in link.collisions
    ]
    inertial = link.inertial
    if inertial is not None:
        tensor = inertial.inertia and _mirror_tensor(inertial.inertia, index)
        inertial = replace(inertial, origin=_mirror_origin(inertial.origin, flip), inertia=tensor)
    return replace(link, visuals=visuals, collisions=collisions, inertial=inertial)


def _mirror_mesh(geometry: T, index: int) -> T:
    if not isinstance(geometry, Mesh):
        return geometry
    scale = [*(geometry.scale or (1.0, 1.0, 1.0))]
    scale[index] = -scale[index]
    return replace(geometry, scale=(scale[0], scale[1], scale[2]))


def _mirror_tensor(tensor: Inertia, index: int) -> Inertia:
    """Return the tensor with the two products of the negated coordinate negated."""
    signs = [-1.0 if index in pair else 1.0 for pair in ((0, 1), (0, 2), (1, 2))]
    ixy, ixz, iyz = (sign * value for sign, value in zip(signs, tensor.products, strict=True))
    return replace(tensor, ixy=ixy, ixz=ixz, iyz=iyz)


def mirror_joint(joint: Joint, flip: Array) -> Joint:
    """Return the mirror image of a joint, with the same positions; see :func:`mirror_link`."""
    sign = 1.0 if joint.type == "prismatic" else -1.0
    x, y, z = (float(v) for v in sign * flip[:3, :3] @ np.array(_scale_axis(joint, 1.0).xyz))
    axis = replace(_scale_axis(joint, 1.0), xyz=(x, y, z)) if joint.has_direction else joint.axis
    pitch = joint.thread_pitch and -joint.thread_pitch  # a right-handed thread becomes left-handed
    origin = _mirror_origin(joint.origin, flip)
    return replace(joint, origin=origin, axis=axis, thread_pitch=pitch)


def move_frame(robot: Robot, move: FrameMove) -> Robot:
    """Return the robot with a link frame at another pose in its body, where all else stays."""
    _find_link(robot, move.link)
    pose = get_origin_matrix(Origin(None, move.xyz, move.rpy))
    back = invert(pose)
    links = [_move_link(link, back) if link.name == move.link else link for link in robot.links]
    joints = [_move_joint(joint, move.link, pose, back) for joint in robot.joints]
    cameras = [
        replace(c, origin=_move_origin(c.origin, back, np.eye(4))) if c.link == move.link else c
        for c in robot.cameras
    ]
    sensors = [
        replace(s, origin=_move_origin(s.origin, back, np.eye(4))) if s.link == move.link else s
        for s in robot.mounted_sensors
    ]
    return replace(robot, links=links, joints=joints, cameras=cameras, mounted_sensors=sensors)


def _move_origin(origin: Origin | None, before: Array, after: Array) -> Origin:
    return make_origin(before @ get_origin_matrix(origin) @ after, origin)


def _move_link(link: Link, back: Array) -> Link:
    one = np.eye(4)
    inertial: Inertial | None = link.inertial
    if inertial is not None:
        inertial = replace(inertial, origin=_move_origin(inertial.origin, back, one))
    visuals = [replace(v, origin=_move_origin(v.origin, back, one)) for v in link.visuals]
    collisions = [replace(c, origin=_move_origin(c.origin, back, one)) for c in link.collisions]
    return replace(link, inertial=inertial, visuals=visuals, collisions=collisions)


def _move_joint(joint: Joint, link: str, pose: Array, back: Array) -> Joint:
    if joint.parent == link:
        joint = replace(joint, origin=_move_origin(joint.origin, back, np.eye(4)))
    if joint.child != link:
        return joint
    axis = compute_axis(joint)
    if joint.type in HINGES and np.linalg.norm(np.cross(axis, pose[:3, 3])) > 1e-9:
        raise ConfigError(f"the declared frame of link '{link}' is not on its joint's axis")
    x, y, z = (float(value) for value in back[:3, :3] @ axis)
    moved = replace(_scale_axis(joint, 1.0), xyz=(x, y, z)) if joint.has_direction else joint.axis
    return replace(joint, origin=_move_origin(joint.origin, np.eye(4), pose), axis=moved)


def shift_positions(robot: Robot, values: Iterable[JointValue]) -> Robot:
    """Return the robot with positions of joints that have another sign and zero.

    Raises:
        ConfigError: There is no such joint, or it does not have one position.
    """
    known = {value.joint: value for value in values if value.sign != 1.0 or value.zero != 0.0}
    for name in known:
        if name not in robot.joint or robot.joint[name].type not in _ONE_POSITION:
            raise ConfigError(f"joint '{name}' of the correspondence does not have one position")
    joints = [_shift_joint(joint, known) for joint in robot.joints]
    return shift_blocks(replace(robot, joints=joints), known)


def _shift_joint(joint: Joint, known: dict[str, JointValue]) -> Joint:
    mimic = joint.mimic and _shift_mimic(joint.name, joint.mimic, known)
    if joint.name not in known:
        return replace(joint, mimic=mimic)
    _, sign, zero = known[joint.name]
    motion = np.eye(4)
    if joint.type in HINGES:
        motion[:3, :3] = turn(compute_axis(joint), -sign * zero)
    else:
        motion[:3, 3] = -sign * zero * compute_axis(joint)
    moved = make_origin(get_origin_matrix(joint.origin) @ motion, joint.origin)
    return replace(
        joint,
        origin=joint.origin if not zero else moved,
        axis=_scale_axis(joint, sign),
        limit=joint.limit and _shift_limit(joint, joint.limit, sign, zero),
        mimic=mimic,
        safety_controller=joint.safety_controller
        and _shift_safety(joint.safety_controller, sign, zero),
        calibration=joint.calibration and _shift_calibration(joint.calibration, sign, zero),
        settings=_shift_settings(joint, sign, zero),
    )


def _shift_limit(joint: Joint, limit: Limit, sign: float, zero: float) -> Limit:
    if joint.turns_freely:
        return limit
    low, high = sorted(sign * (value or 0.0) + zero for value in (limit.lower, limit.upper))
    if (limit.lower or 0.0) > (limit.upper or 0.0):
        low, high = high, low
    return replace(limit, lower=low, upper=high)


def _shift_mimic(name: str, mimic: Mimic, known: dict[str, JointValue]) -> Mimic:
    """Return follower = multiplier · leader + offset in the new positions of both."""
    _, sign, zero = known.get(name, JointValue(name, 1.0, 0.0))
    _, sign2, zero2 = known.get(mimic.joint, JointValue(mimic.joint, 1.0, 0.0))
    factor = sign * mimic.multiplier * sign2
    return replace(mimic, multiplier=factor, offset=sign * mimic.offset + zero - factor * zero2)


def _shift_safety(part: SafetyController, sign: float, zero: float) -> SafetyController:
    low, high = sorted(sign * v + zero for v in (part.soft_lower_limit, part.soft_upper_limit))
    return replace(part, soft_lower_limit=low, soft_upper_limit=high)


def _shift_calibration(part: Calibration, sign: float, zero: float) -> Calibration:
    """Return the reference positions; a flag that rises then falls along an opposite axis."""

    def shift(value: float | None) -> float | None:
        return None if value is None else sign * value + zero

    rising, falling = shift(part.rising), shift(part.falling)
    if sign < 0:
        rising, falling = falling, rising
    return replace(
        part,
        rising=rising,
        falling=falling,
        reference_position=shift(part.reference_position),
    )


def _shift_settings(joint: Joint, sign: float, zero: float) -> Settings:
    rest = joint.settings.get("spring_reference")
    if rest is None or isinstance(rest.content, tuple | str):
        return joint.settings
    return {**joint.settings, "spring_reference": replace(rest, content=sign * rest.content + zero)}
