"""Check frames with a convention: base, footprint and optical frames of cameras."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.elements import Joint, Robot, Sensor
from ...model.kinematics import get_zero_poses
from ...model.pose import IDENTITY, Pose, Rotation, compute_dot, make_pose, rotation_from_rpy
from ..fix import FixContext, Proposal, set_text, unsafe
from ..gazebo.sensors import get_pose_in_link
from ..rule import GAZEBO, INFO, UNSAFE, WARNING, Problem, rule
from ..shape_changes import set_in_origin

_OPTICAL = rotation_from_rpy((-math.pi / 2, 0.0, -math.pi / 2))
_CAMERAS = ("camera", "depth", "depth_camera", "rgbd_camera", "multicamera", "wideanglecamera")
_FRAME_TAGS = ("frameName", "frame_name", "gz_frame_id", "ignition_frame_id", "optical_frame_id")


@rule(
    WARNING,
    effects={
        "image_geometry": (
            "takes z of the frame as the viewing direction: points and rays are rotated relative "
            "to the robot"
        ),
        "image_geometry (rolled)": (
            "takes x of the frame as right and y as down in the image: points and rays are rotated "
            "about the viewing direction"
        ),
    },
    pedantic="frames that look less than 45° away, as of a camera that is tilted in its frame",
)
def optical_frame_orientation(robot: Robot, *, tolerance: float = 0.01) -> Iterator[Problem]:
    """An optical frame has a wrong orientation relative to its camera's frame.

    A camera frame has x forward and z up; its optical frame has z forward and x to the right
    (REP 103). Between them is ``rpy="-1.5708 0 -1.5708"``. Otherwise point clouds are rotated by
    the angle in the message: often 90° or 180°, or 120° if the rotation was forgotten.
    ``tolerance`` [rad] is the tolerated angle. An optical frame that looks along x of its camera's
    frame may be rolled so that its y axis, the columns of the image, points down with all joints
    at rest, because the camera's frame is mounted upside down or on its side. A roll by 180° about
    x is not reported, because the camera may be mounted upside down in its frame.
    """
    poses: dict[str, Pose] | None = None
    for joint in robot.joints:
        if not joint.is_fixed or not _is_optical_of(joint):
            continue
        rotation = make_pose(joint.origin).rotation
        off = max(
            abs(a - b)
            for row, expected in zip(rotation, _OPTICAL, strict=True)
            for a, b in zip(row, expected, strict=True)
        )
        if off > tolerance:
            looks_ahead = abs(rotation[0][2] - 1) <= tolerance
            if looks_ahead:
                poses = get_zero_poses(robot) if poses is None else poses
                if _is_upright_by_roll(rotation, poses.get(joint.parent)):
                    continue
            turns = sum(
                compute_dot(row, expected) for row, expected in zip(rotation, _OPTICAL, strict=True)
            )
            angle = math.degrees(math.acos(max(-1.0, min(1.0, (turns - 1) / 2))))
            if looks_ahead and angle > 179:
                continue  # mounted upside down in the camera's frame
            tilt = math.degrees(math.acos(max(-1.0, min(1.0, rotation[0][2]))))
            is_tilted = not looks_ahead and tilt < TILT
            remedy = 'write rpy="-1.5708 0 -1.5708"'
            yield Problem(
                joint,
                f"optical frame '{joint.child}' is {_describe_turn(angle, tilt, looks_ahead)} of "
                f"'{joint.parent}'; {'check its rpy' if is_tilted else remedy}",
                at=joint.origin,
                effects=("image_geometry (rolled)" if looks_ahead else "image_geometry",),
                severity=INFO if is_tilted else None,
                pedantic=is_tilted,
                data={"angle": angle, "tilt": tilt},
            )


TILT = 45.0
"""Angle between the viewing directions of a camera and its optical frame [°], below which the
camera may be tilted in its frame. Chosen, no source."""


def _describe_turn(angle: float, tilt: float, looks_ahead: bool) -> str:
    """Describe a rotation from the convention by its angle and that of the direction [°]."""
    if looks_ahead:
        return f"rotated by {angle:.3g}° about the viewing direction"
    if abs(angle - tilt) < 1:
        return f"rotated by {angle:.3g}° from the viewing direction"
    return f"rotated by {angle:.3g}°, and looks {tilt:.3g}° away from the viewing direction"


def _is_upright_by_roll(rotation: Rotation, camera: Pose | None) -> bool:
    """Tell whether the image of a rolled optical frame is upright, and by the convention not."""
    if camera is None:
        return False
    up = camera.rotation[2]  # the root's z axis in the camera's frame
    steep = math.hypot(up[1], up[2])
    written = -(rotation[1][1] * up[1] + rotation[2][1] * up[2])
    return steep > LEVEL and written >= UPRIGHT * steep and up[2] < UPRIGHT * steep


UPRIGHT = math.cos(math.radians(30))
"""Cosine of the roll up to which an image is upright. Chosen, no source."""
LEVEL = math.sin(math.radians(15))
"""Sine of the angle between a viewing direction and the vertical, above which an image has an
upper side. Chosen, no source."""


@optical_frame_orientation.fix(UNSAFE)
def turn_optical_frame(problem: Problem, context: FixContext) -> Proposal | None:
    """Rotate the frame so that z points in the viewing direction."""
    joint = context.get_joint(problem)
    if problem.pedantic or (
        joint.origin is not None and "quat_xyzw" in joint.origin.element.attributes
    ):
        return None
    rpy = "-1.5708 0 -1.5708"
    return unsafe(f'write rpy="{rpy}"', set_in_origin(joint, "rpy", rpy))


def _is_optical_of(joint: Joint) -> bool:
    """Tell whether a joint goes from a camera's frame to its optical frame, by their names."""
    stem, optical, _ = joint.child.partition("_optical")
    if not optical or not stem:
        return False
    parent = joint.parent
    return "optical" not in parent and parent in (stem, f"{stem}_frame", f"{stem}_link")


@rule(
    INFO,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "publish images in the frame as named, which looks along x",
    },
)
def camera_sensor_not_optical(robot: Robot) -> Iterator[Problem]:
    """A camera publishes in its own frame although it has an optical frame.

    Consumers of images expect z forward. In the camera's frame, which looks along x, point clouds
    are rotated. Write the optical frame as the frame of the sensor.
    """
    for sensor in robot.sensors:
        if sensor.type not in _CAMERAS or sensor.reference is None:
            continue
        joints = robot.tree.get_child_joints(sensor.reference)
        frames = {joint.child for joint in joints if _is_at(joint, sensor)}
        optical = next((name for name in sorted(frames) if "_optical" in name), None)
        written = _get_frames(sensor)
        if optical is None or not written or any("optical" in text for text in written):
            continue
        yield Problem(
            sensor.element,
            f"camera '{sensor.name}' publishes in frame '{written[0]}', but images require the "
            f"optical frame; write '{optical}'",
            data={"frame": written[0], "optical_frame": optical},
        )


@camera_sensor_not_optical.fix(UNSAFE)
def write_optical_frame(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the optical frame."""
    frame, optical = problem.data["frame"], problem.data["optical_frame"]
    tags = ("frameName", "frame_name", "gz_frame_id", "ignition_frame_id")
    for element in problem.element.walk():
        if element.tag in tags and element.text.strip() == frame:
            return unsafe(f"publish in frame '{optical}'", set_text(element, optical))
    return None


def _is_at(joint: Joint, sensor: Sensor) -> bool:
    """Tell whether the child of a joint may be the frame of a sensor of its parent.

    A sensor with a ``<pose>`` of its own is offset from the frames of its link.
    """
    pose = get_pose_in_link(sensor)
    if pose is None or pose is IDENTITY:
        return pose is not None
    return math.dist(make_pose(joint.origin).translation, pose.translation) < 1e-3


def _get_frames(sensor: Sensor) -> list[str]:
    return [
        e.text.strip() for e in sensor.element.walk() if e.tag in _FRAME_TAGS and e.text.strip()
    ]
