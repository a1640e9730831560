"""Frames of bodies, and positions at which joints start, as the source of an export has them.

The frame of a link is at its joint. MJCF may have the joint elsewhere in its body (``pos``), and
the body drawn where the joint is not at zero (``ref``). What follows the frame of a body, such as
a camera of mode ``track``, and what MuJoCo computes at the start, such as the length of a tendon's
spring, depends on them.
"""

from __future__ import annotations

from collections.abc import Mapping

from lxml import etree

from ...model.elements import Joint, Vector
from ...model.kinematics import compute_motion
from ...model.pose import add, make_pose, rotate
from ..common.numbers import format_numbers_text, format_pose_text, number_text
from .body import Bodies
from .copied import get_start
from .frame import read_pose, read_position, set_pose
from .structure import Structure

_PLACED = ("inertial", "geom", "site", "camera", "light", "body")
"""Elements of a body that have a position in its frame."""


def restore_frames(
    structure: Structure, bodies: Bodies, sections: Mapping[str, etree._Element]
) -> None:
    """Move the frames of bodies to where the MJCF of a robot has them, and joints to their start.

    Args:
        structure: The kinematic tree.
        bodies: Body of each link, in the frame of the link; modified.
        sections: The model, whose equalities are modified.
    """
    robot = structure.robot
    if robot.format != "mjcf":
        return
    start = get_start(robot)
    for joint in structure.moving:
        if start.get(joint.name):
            _turn_to_start(bodies[joint.child], joint, start[joint.name])
    anchors: dict[str, Vector] = {}
    for frame in robot.frames:
        if frame.kind == "body":
            body = bodies[frame.link]
            x, y, z = make_pose(frame.origin).translation
            anchors[body.get("name", "")] = -x, -y, -z
            _move_frame(body, (-x, -y, -z))
    _move_equalities(sections.get("equality"), anchors, start)


def _turn_to_start(body: etree._Element, joint: Joint, position: float) -> None:
    """Place a body where its joint has a position [rad or m], which becomes the joint's start."""
    pose = read_pose(body) @ compute_motion(joint, position)
    for attribute in ("pos", "quat"):
        body.attrib.pop(attribute, "")
    set_pose(body, pose)
    for element in body.iterchildren("joint"):
        element.set("ref", number_text(position))


def _move_frame(body: etree._Element, anchor: Vector) -> None:
    """Move the frame of a body from its joint, whose position [m] in the new frame is given."""
    x, y, z = anchor
    _shift(body, rotate(read_pose(body).rotation, (-x, -y, -z)))
    for child in body.iterchildren(*_PLACED):
        _shift(child, anchor)
    for joint in body.iterchildren("joint"):
        joint.set("pos", format_numbers_text(anchor))


def _shift(element: etree._Element, by: Vector) -> None:
    position = add(read_position(element.get("pos")), by)
    element.attrib.pop("pos", "")
    if any(position) or element.tag == "inertial":  # whose position is required
        element.set("pos", format_pose_text(position))


def _move_equalities(
    section: etree._Element | None, anchors: Mapping[str, Vector], start: Mapping[str, float]
) -> None:
    """Write the anchors of connections in the moved frames, and couplings relative to the start.

    MuJoCo's coupling is y − y0 = c0 + c1 (x − x0), with the start of both joints.
    """
    for element in section if section is not None else ():
        of = anchors.get(element.get("body1", ""))
        if element.tag == "connect" and of is not None:
            anchor = add(read_position(element.get("anchor")), of)
            element.set("anchor", format_numbers_text(anchor))
        elif element.tag == "joint":
            y0, x0 = (start.get(element.get(name, ""), 0.0) for name in ("joint1", "joint2"))
            c0, c1, *rest = (float(part) for part in element.get("polycoef", "0 1").split())
            if y0 or x0:
                element.set("polycoef", format_numbers_text((c0 - y0 + c1 * x0, c1, *rest)))
