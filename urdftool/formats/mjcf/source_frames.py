"""Bodies with the joints, frames and starts that the source of an export has.

The frame of a link is at its only joint. MJCF may have several joints in a body, elsewhere than its
frame (``pos``), and the body drawn where a joint is not at zero (``ref``). What follows the frame
of a body, such as a camera of mode ``track``, and what MuJoCo computes at the start, such as the
length of a tendon's spring, depends on them. Parent and child bodies have no contact.
"""

from __future__ import annotations

from collections.abc import Mapping

from lxml import etree

from ...model.elements import Joint, Robot, Vector
from ...model.kinematics import compute_motion
from ...model.numbers import format_numbers_text, format_pose_text, number_text
from ...model.pose import add, make_pose, rotate
from .body import Bodies
from .copied import get_start
from .frame import read_pose, read_position, set_pose
from .structure import Structure

_PLACED = ("inertial", "geom", "site", "camera", "light", "body")
"""Elements of a body that have a position in its frame."""


def join_bodies(structure: Structure, bodies: Bodies) -> None:
    """Place bodies of an MJCF at the start of their joints, and join those of one source body."""
    robot = structure.robot
    if robot.format != "mjcf":
        return
    start = get_start(robot)
    for joint in structure.moving:
        if start.get(joint.name):
            _turn_to_start(bodies[joint.child], joint, start[joint.name])
    for joint in structure.joints:
        if robot.link[joint.parent].is_virtual:
            _join(bodies[joint.parent], bodies[joint.child])
            bodies[joint.parent] = bodies[joint.child]


def _join(outer: etree._Element, inner: etree._Element) -> None:
    """Move the joints of a body without mass into its child, which takes its place.

    Both have the same axes where their joints start.
    """
    offset = read_position(inner.get("pos"))
    joints = outer.findall("joint")
    for joint in joints:
        _shift(joint, _negate(offset))
    pose = read_pose(outer)
    inner.attrib.pop("quat", "")
    if outer.get("quat"):
        inner.set("quat", outer.get("quat", ""))
    inner.set("pos", format_pose_text(add(pose.translation, rotate(pose.rotation, offset))))
    if outer.get("childclass"):
        inner.set("childclass", outer.get("childclass", ""))
    first = inner.find("joint")
    place = 0 if first is None else inner.index(first)
    inner[place:place] = joints
    parent = outer.getparent()
    assert parent is not None
    parent.replace(outer, inner)


def restore_frames(robot: Robot, bodies: Bodies, sections: Mapping[str, etree._Element]) -> None:
    """Move the frames of bodies to where the source of a robot has them."""
    anchors = list_anchors(robot)
    for link, anchor in anchors.items():
        _move_frame(bodies[link], anchor)
    named = {bodies[link].get("name", ""): anchor for link, anchor in anchors.items()}
    _move_equalities(sections.get("equality"), named, get_start(robot))


def list_anchors(robot: Robot) -> dict[str, Vector]:
    """Return the position [m] of a link's frame in that of its body, where they differ, by link."""
    return {
        frame.link: _negate(make_pose(frame.origin).translation)
        for frame in robot.frames
        if frame.kind == "body"
    }


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
    _shift(body, rotate(read_pose(body).rotation, _negate(anchor)))
    for child in body.iterchildren(*_PLACED):
        _shift(child, anchor)
    for joint in body.iterchildren("joint"):
        _shift(joint, anchor)


def _negate(point: Vector) -> Vector:
    return -point[0], -point[1], -point[2]


def _shift(element: etree._Element, by: Vector) -> None:
    if element.tag == "joint" and element.get("type") == "slide":  # which has no position
        return
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
