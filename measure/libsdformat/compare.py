"""Differences of a model in libsdformat and the robot that urdftool reads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from urdftool.mechanics.reference import Array, get_origin_matrix
from urdftool.model.elements import Geometry, Joint, Link, Robot
from urdftool.model.kinematics import link_poses
from urdftool.model.pose import Pose

from .theirs import Model, bound, make_matrix, make_tensor

TOLERANCE = 1e-6
"""Largest difference [m, rad, kg], relative above 1; poses of six decimals are common in SDF."""

_SIZES = {
    "box": ("size",), "cylinder": ("radius", "length"), "capsule": ("radius", "length"),
    "sphere": ("radius",), "ellipsoid": ("radii",), "mesh": ("scale",),
}  # fmt: skip


def compare(robot: Robot, model: Model) -> Iterator[str]:
    """Yield the differences of links, mass properties, collisions, joints and limits.

    Both are compared in the frame of the first link that they share.
    """
    poses = {name: _make_matrix(pose) for name, pose in link_poses(robot).items()}
    shared = next((name for name in model.links if name in poses), None)
    if shared is None:
        yield "no link in common"
        return
    start = make_matrix(model.links[shared]["pose"])
    to_ours = _get_frame(robot, poses, shared) @ np.linalg.inv(start)
    for name, theirs in model.links.items():
        link = robot.link.get(name)
        if link is None or name not in poses:
            yield f"link '{name}' is missing"
            continue
        pose = to_ours @ make_matrix(theirs["pose"])
        yield from _differ(f"{name}: pose", _get_frame(robot, poses, name), pose)
        yield from (f"{name}: {text}" for text in _compare_link(link, theirs, poses[name], pose))
    loops = {loop.name for loop in robot.closures}
    for name, theirs in model.joints.items():
        joint = robot.joint.get(name)
        if joint is not None:
            found = _compare_joint(joint, theirs, poses, to_ours)
            yield from (f"{name}: {text}" for text in found)
        elif name not in loops and "world" not in (theirs["parent"], theirs["child"]):
            yield f"joint '{name}' is missing"


def _get_frame(robot: Robot, poses: Mapping[str, Array], name: str) -> Array:
    """Return the frame that the file gives a link; the reader puts link frames at the joints."""
    for frame in robot.frames:
        if (frame.name, frame.kind) == (name, "body"):
            return poses[frame.link] @ get_origin_matrix(frame.origin)
    return poses[name]


def _compare_link(link: Link, theirs: Mapping[str, Any], ours: Array, pose: Array) -> Iterator[str]:
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        yield "no inertial"
        return
    center, other = ours @ get_origin_matrix(inertial.origin), pose @ make_matrix(theirs["center"])
    yield from _differ("mass", link.mass, theirs["mass"])
    yield from _differ("center of mass", center[:3, 3], other[:3, 3])
    tensor = center[:3, :3] @ make_tensor(inertial.inertia.six) @ center[:3, :3].T
    expected = other[:3, :3] @ make_tensor(theirs["tensor"]) @ other[:3, :3].T
    size = max(np.trace(expected), 1e-12)
    yield from _differ("tensor", tensor / size, expected / size)
    yield from _differ("visuals", len(link.visuals), theirs["visuals"])
    if len(link.collisions) != len(theirs["collisions"]):
        yield f"{len(link.collisions)} collisions, not {len(theirs['collisions'])}"
        return
    for one, two in zip(link.collisions, theirs["collisions"], strict=True):
        place = ours @ get_origin_matrix(one.origin)
        yield from _differ("pose of a collision", place, pose @ make_matrix(two["pose"]))
        yield from _compare_shape(one.geometry, two)


def _compare_shape(shape: Geometry | None, theirs: Mapping[str, Any]) -> Iterator[str]:
    kind = type(shape).__name__.lower()
    if kind != theirs["kind"]:
        yield f"a collision is a {kind}, not a {theirs['kind']}"
        return
    sizes = [np.ravel(getattr(shape, name)) for name in _SIZES.get(kind, ())]
    yield from _differ("size of a collision", np.concatenate([*sizes, []]), theirs["size"])


def _compare_joint(
    joint: Joint, theirs: Mapping[str, Any], poses: Mapping[str, Array], to_ours: Array
) -> Iterator[str]:
    kind = theirs["type"]
    if kind == "revolute" and all(bound(value) is None for value in theirs["limits"][:2]):
        kind = "continuous"
    if joint.type != kind:
        yield f"type {joint.type}, not {kind}"
    if (joint.parent, joint.child) != (theirs["parent"], theirs["child"]):
        yield "other links"
        return
    pose = to_ours @ make_matrix(theirs["pose"])
    yield from _differ("position", poses[joint.child][:3, 3], pose[:3, 3])
    if joint.has_axis and "axis" in theirs:
        axis = np.array(joint.axis.xyz if joint.axis else (1.0, 0.0, 0.0))
        yield from _differ("axis", _unit(poses[joint.child], axis), _unit(to_ours, theirs["axis"]))
        yield from _compare_limits(joint, theirs)


def _compare_limits(joint: Joint, theirs: Mapping[str, Any]) -> Iterator[str]:
    names = ("lower", "upper", "effort", "velocity")
    for name, value in zip(names, theirs["limits"], strict=True):
        ours = bound(getattr(joint.limit, name, None))
        expected = None if name in names[2:] and value < 0 else bound(value)
        if (ours is None) != (expected is None):
            yield f"{name} {ours}, not {expected}"
        elif ours is not None:
            yield from _differ(name, ours, expected)
    for name, value in zip(("damping", "friction"), theirs["dynamics"], strict=True):
        yield from _differ(name, getattr(joint.dynamics, name, None) or 0.0, value)


def _unit(pose: Array, axis: Sequence[float] | Array) -> Array:
    turned: Array = pose[:3, :3] @ np.asarray(axis)
    return turned / np.linalg.norm(turned)


def _differ(what: str, ours: Any, theirs: Any) -> Iterator[str]:
    """Yield a difference that is not within the tolerance; NaN never is."""
    one, two = np.ravel(ours).astype(float), np.ravel(theirs).astype(float)
    largest = abs(one - two).max(initial=0.0) / max(1.0, abs(two).max(initial=0.0))
    if not largest <= TOLERANCE:
        yield f"{what} differs by {largest:.2g}"


def _make_matrix(pose: Pose) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose
    return matrix
