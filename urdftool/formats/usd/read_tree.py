"""Bodies and joints of a stage as links and joints."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from pxr import Gf, Usd, UsdPhysics

from ...diagnostic import Severity
from ...model.elements import Axis, Joint, Link, Robot
from ...model.mechanism import Base, Closure, Frame
from ...model.pose import (
    IDENTITY,
    Pose,
    compute_dot,
    compute_norm,
    get_origin_at,
    quaternion_from_rotation,
    rotate,
    rotation_from_quaternion,
)
from ...model.world import WORLD
from ..reading import take_name
from .read_joints import JointKind, NamedJoint, add_motion, find_kind, read_actuator
from .read_links import read_inertial
from .read_pairs import add_pairs
from .read_robot import choose_bodies
from .read_stage import NO_TURN, Context, get_targets, scale_point

_NOISE = 1e-7
"""Component of an axis below which it is rounding noise of 32-bit floats."""

_DIRECTIONS = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Axes of a frame."""

_SAME = 1e-5
"""Difference [m] of transforms and joint frames that rounding explains."""


_APART, _TURNED = 1e-4, 1e-3
"""Distance [m] and turn (difference of directions of length 1) of a body from where its joint holds
it, above which it is reported. Chosen: 32-bit floats of coordinates up to 100 m differ by 8e-6 m.
"""


@dataclass(frozen=True)
class _Edge:
    """A joint between two bodies, as the tree uses it: ``first`` is nearer to the root.

    Attributes:
        prim: Prim of the joint.
        kind: Type and axis.
        first: Path of the body toward the root; empty for the world.
        second: Path of the other body.
        first_pose: Joint frame in the first body.
        second_pose: Joint frame in the second body.
        is_reversed: Whether ``body1`` is the first.
    """

    prim: Usd.Prim
    kind: JointKind
    first: str
    second: str
    first_pose: Pose
    second_pose: Pose
    is_reversed: bool = False

    def reverse(self) -> _Edge:
        """Return the edge in the other direction."""
        return _Edge(self.prim, self.kind, self.second, self.first, self.second_pose,
                     self.first_pose, is_reversed=not self.is_reversed)  # fmt: skip


def add_tree(context: Context, robot: Robot) -> list[NamedJoint]:
    """Add links, joints, the base, and connections that close loops; return the joints read."""
    named: list[NamedJoint] = []
    every = [_read_edge(context, prim) for prim in context.joints]
    found = [edge for edge in every if edge is not None]
    choose_bodies(context, ((one.first, one.second, one.kind.type == "fixed") for one in found))
    known = {"", *context.bodies}
    edges = [edge for edge in found if {edge.first, edge.second} <= known]
    _name_links(context)
    tree, loops, root = _build_tree(context, edges)
    _set_shifts(context, tree)
    taken: set[str] = set()
    frames = _find_frames(context)
    stands = {context.names[path] for path, (body, _) in frames.items() if not body}
    if any(
        not edge.first
        and edge.kind.type != "fixed"
        and edge.prim.GetCustomDataByKey("urdf:parent") not in stands
        for edge in tree
    ):
        robot.links.append(Link(context.get_written(context.top), take_name(WORLD, set())))
        context.names[""] = robot.links[0].name
    for path, prim in context.bodies.items():
        link = Link(context.get_written(prim), context.names[path])
        link.inertial = read_inertial(context, prim)
        robot.links.append(link)
    for path in frames:
        prim = context.stage.GetPrimAtPath(path)
        robot.links.append(Link(context.get_written(prim), context.names[path]))
    for edge in tree:
        start = _find_start(context, edge)
        if edge.first or "" in context.names or edge.kind.type != "fixed":
            joint = _make_joint(context, edge, frames, taken)
            named.append(NamedJoint(edge.prim, joint.name, edge.kind, start))
            robot.joints.append(joint)
            if actuator := read_actuator(context, edge.prim, joint, edge.kind.freedom):
                robot.joint_actuators.append(actuator)
    _join_anchored(context, robot, tree, root, taken)
    _join_frames(context, robot, frames, taken)
    _join_free_bodies(context, robot, root, frames, taken)
    _add_base(context, robot, root, frames)
    _drop_world(context, robot, frames)
    for path, shift in context.shifts.items():
        if path and compute_norm(shift.translation) > 0:
            written, name = context.get_written(context.bodies[path]), context.names[path]
            origin = get_origin_at(shift.invert(), written)
            robot.frames.append(Frame(written, name, name, "body", origin))
    for edge in loops:
        named.append(NamedJoint(edge.prim, edge.prim.GetName(), edge.kind))
        robot.closures.append(_make_closure(context, edge))
    add_pairs(context, robot)
    return named


def _name_links(context: Context) -> None:
    """Name the links of bodies and stored frames."""
    taken: set[str] = set()
    paths = [*context.bodies, *_find_frames(context)]
    for path in paths:
        prim = context.stage.GetPrimAtPath(path)
        stored = prim.GetCustomDataByKey("urdf:link") or prim.GetDisplayName()
        context.names[path] = take_name(str(stored or prim.GetName()), taken)


def _find_frames(context: Context) -> dict[str, tuple[str, Pose]]:
    """Return the body of each stored frame and its pose there, by path."""
    found = {}
    for prim in context.iterate_prims():
        path = str(prim.GetPath())
        if path in context.bodies or not prim.GetCustomDataByKey("urdf:link"):
            continue
        if context.is_of_other(prim):
            continue
        body = context.find_body(prim)
        at = context.get_pose(context.bodies[body]).invert() if body else IDENTITY
        found[path] = (body, at @ context.get_pose(prim))
    return found


def _read_edge(context: Context, prim: Usd.Prim) -> _Edge | None:
    if not _is_enabled(prim) and not _is_excluded(prim):
        context.report_loss("disabled-joint", "disabled joints are not read", prim, Severity.INFO)
        return None
    if prim.IsA(UsdPhysics.DistanceJoint):
        context.report_loss("joint-type", "joints that limit a distance are not read", prim)
        return None
    ends = []
    for index in (0, 1):
        targets = get_targets(prim, f"physics:body{index}")
        end = context.stage.GetPrimAtPath(targets[0]) if targets else None
        if targets and not end:
            text = "joints of prims that do not exist are not read"
            context.report_loss("joint-body", text, prim)
            return None
        body = context.find_body(end) if end else ""
        scale = context.get_scale(end) if end else None
        pose = _read_frame(context, prim, index, scale)
        if end and not body:
            pose = context.get_pose(end) @ pose
        elif end and body != targets[0]:
            pose = context.get_pose(context.bodies[body]).invert() @ context.get_pose(end) @ pose
        ends.append((body, pose))
    (first, at_first), (second, at_second) = ends
    if first == second:
        context.report_loss("joint", "joints without two bodies are not read", prim)
        return None
    edge = _Edge(prim, find_kind(context, prim), first, second, at_first, at_second)
    return edge if second else edge.reverse()


def _read_frame(context: Context, prim: Usd.Prim, index: int, scale: Gf.Matrix4d | None) -> Pose:
    """Return the frame of a joint in the prim that it connects, without the prim's scale [m]."""
    names = f"physics:localPos{index}", f"physics:localRot{index}"
    position = context.get_vector(prim, names[0], (0.0, 0.0, 0.0))
    quaternion = context.get_vector(prim, names[1], NO_TURN)
    context.check_finite(prim, names[0], position)
    context.check_finite(prim, names[1], quaternion)
    x, y, z = scale_point(scale, position)
    w, i, j, k = quaternion
    turn = rotation_from_quaternion((w, i, j, k))
    return Pose(turn, (x * context.length, y * context.length, z * context.length))


def _build_tree(context: Context, edges: list[_Edge]) -> tuple[list[_Edge], list[_Edge], str]:
    """Return the joints of the tree, parents first, those that close loops, and the root."""
    excluded = [edge for edge in edges if _is_excluded(edge.prim)]
    used = [edge for edge in edges if not _is_excluded(edge.prim)]
    root = _find_root(context, used)
    at: dict[str, list[_Edge]] = {}
    for edge in used:
        at.setdefault(edge.first, []).append(edge)
        at.setdefault(edge.second, []).append(edge)
    tree: list[_Edge] = []
    loops: list[_Edge] = list(excluded)
    done: set[int] = set()
    seen: set[str] = set()
    for start in ("", root, *context.bodies):
        queue = deque(() if start in seen else (start,))
        seen.add(start)
        while queue:
            path = queue.popleft()
            for edge in at.get(path, ()):
                if id(edge) in done:
                    continue
                done.add(id(edge))
                directed = edge if edge.first == path else edge.reverse()
                if directed.second in seen:
                    loops.append(directed)
                else:
                    seen.add(directed.second)
                    tree.append(directed)
                    queue.append(directed.second)
    return tree, loops, root


def _is_excluded(prim: Usd.Prim) -> bool:
    return bool(UsdPhysics.Joint(prim).GetExcludeFromArticulationAttr().Get())


def _find_root(context: Context, edges: list[_Edge]) -> str:
    """Return the path of the base: held by the world, or the root of the articulation."""
    for edge in edges:
        if edge.first == "" and edge.kind.type == "fixed":
            return edge.second
    for path, prim in context.bodies.items():
        if prim.HasAPI(UsdPhysics.ArticulationRootAPI):
            return path
    for edge in edges:
        if edge.first == "":
            return edge.second
    children = {edge.second for edge in edges}
    tops = [path for path in context.bodies if path not in children]
    return next(iter(tops or context.bodies), "")


def _set_shifts(context: Context, tree: list[_Edge]) -> None:
    """Choose the frame of each link: that of its prim, moved to the axis of its joint."""
    context.shifts = dict.fromkeys([*context.bodies, ""], IDENTITY)
    for edge in tree:
        turns = edge.kind.type in ("revolute", "continuous", "ball", "planar")
        if turns and compute_norm(edge.second_pose.translation) > 0:
            context.shifts[edge.second] = Pose(translation=edge.second_pose.translation)


def _make_joint(
    context: Context, edge: _Edge, frames: dict[str, tuple[str, Pose]], taken: set[str]
) -> Joint:
    prim, written = edge.prim, context.get_written(edge.prim)
    joint = Joint(written, take_name(_get_joint_name(prim), taken), edge.kind.type)
    parent, at = edge.first, context.shifts[edge.first]
    parent_name = prim.GetCustomDataByKey("urdf:parent")
    for path, (body, pose) in frames.items():
        if body == edge.first and context.names[path] == parent_name:
            parent, at = path, pose
    joint.parent, joint.child = context.names.get(parent, ""), context.names[edge.second]
    child = _compute_child_pose(context, edge) @ context.shifts[edge.second]
    joint.origin = get_origin_at(at.invert() @ child, written)
    if edge.kind.type not in ("fixed", "ball", "floating"):
        turn = edge.second_pose.rotation
        x, y, z = rotate(turn, edge.kind.axis)
        sign = -1.0 if edge.is_reversed else 1.0
        xyz = [0.0 if abs(part) < _NOISE else sign * part for part in (x, y, z)]
        joint.axis = Axis(written, (xyz[0], xyz[1], xyz[2]))
    add_motion(context, prim, joint, edge.kind.freedom)
    return joint


def _compute_child_pose(context: Context, edge: _Edge) -> Pose:
    """Return the pose of the second body in the first at zero.

    The transforms of the prims are double, those of the joint are not; they are used if they
    agree, that is, if the stage shows the joint at zero.
    """
    at_zero = edge.first_pose @ edge.second_pose.invert()
    shown = _get_shown_pose(context, edge)
    difference = at_zero.invert() @ shown
    turned = max(abs(difference.rotation[i][i] - 1.0) for i in range(3))
    return shown if compute_norm(difference.translation) < _SAME and turned < _SAME else at_zero


def _get_shown_pose(context: Context, edge: _Edge) -> Pose:
    """Return the pose of the second body in the first, as the transforms of the stage have it."""
    shown = context.get_pose(context.bodies[edge.second])
    if edge.first:
        shown = context.get_pose(context.bodies[edge.first]).invert() @ shown
    return shown


def _find_start(context: Context, edge: _Edge) -> str:
    """Return where the stage shows a body, and report a place that its joint does not allow."""
    kind, axis = edge.kind.type, edge.kind.axis
    moved = edge.first_pose.invert() @ _get_shown_pose(context, edge) @ edge.second_pose
    if kind not in ("fixed", "revolute", "continuous", "prismatic", "ball"):
        return _format_start(moved)
    along = compute_dot(moved.translation, axis) if kind == "prismatic" else 0.0
    off = [part - along * a for part, a in zip(moved.translation, axis, strict=True)]
    kept = {"ball": (), "revolute": (axis,), "continuous": (axis,)}.get(kind, _DIRECTIONS)
    turned = max((math.dist(rotate(moved.rotation, one), one) for one in kept), default=0.0)
    if math.hypot(*off) > _APART or turned > _TURNED:
        text = "bodies are not where their joint holds them, to which a simulator moves them"
        context.report_loss("joint-apart", text, edge.prim)
    return _format_start(moved)


def _format_start(moved: Pose) -> str:
    """Return a pose as text; empty if it is the identity but for the rounding of 32-bit floats."""
    turned = max(math.dist(rotate(moved.rotation, axis), axis) for axis in _DIRECTIONS)
    if compute_norm(moved.translation) <= _APART and turned <= _TURNED:
        return ""
    numbers = (*moved.translation, *quaternion_from_rotation(moved.rotation))
    return " ".join(f"{number:.6g}" for number in numbers)


def _join_frames(
    context: Context, robot: Robot, frames: dict[str, tuple[str, Pose]], taken: set[str]
) -> None:
    """Add a fixed joint for each stored frame, as in the description that was exported."""
    poses = {path: (path, context.shifts[path]) for path in context.bodies} | frames
    by_name = {context.names[path]: path for path in poses}
    for path, (body, pose) in poses.items():
        prim = context.stage.GetPrimAtPath(path)
        parent = by_name.get(str(prim.GetCustomDataByKey("urdf:parent") or ""), "")
        if not prim.GetCustomDataByKey("urdf:fixed_joint"):
            if path in frames and body and not _is_root(context, path):
                parent = body
            else:
                continue
        if not parent or poses[parent][0] != body:
            continue
        written = context.get_written(prim)
        name = str(prim.GetCustomDataByKey("urdf:fixed_joint") or f"{context.names[path]}_joint")
        joint = Joint(written, take_name(name, taken), "fixed")
        joint.parent, joint.child = context.names[parent], context.names[path]
        joint.origin = get_origin_at(poses[parent][1].invert() @ pose, written)
        robot.joints.append(joint)


def _join_free_bodies(
    context: Context,
    robot: Robot,
    root: str,
    frames: dict[str, tuple[str, Pose]],
    taken: set[str],
) -> None:
    """Add a floating joint for each body that no joint holds, except the base."""
    held = {joint.child for joint in robot.joints}
    known = {context.names[key]: key for key in (*context.bodies, *frames)}
    for path, prim in context.bodies.items():
        name = context.names[path]
        if path == root or name in held:
            continue
        written = context.get_written(prim)
        stored = str(prim.GetCustomDataByKey("urdf:floating_joint") or f"{name}_floating")
        parent = str(prim.GetCustomDataByKey("urdf:parent") or "")
        start = known.get(parent, root)
        joint = Joint(written, take_name(stored, taken), "floating")
        joint.parent, joint.child = context.names[start], name
        at = context.get_pose(context.stage.GetPrimAtPath(start)) @ context.shifts.get(
            start, IDENTITY
        )
        pose = context.get_pose(prim) @ context.shifts[path]
        joint.origin = get_origin_at(at.invert() @ pose, written)
        robot.joints.append(joint)


def _join_anchored(
    context: Context, robot: Robot, tree: list[_Edge], root: str, taken: set[str]
) -> None:
    """Fix further bodies that are fixed to the world to the base, which is fixed, too."""
    if "" in context.names:
        return
    anchored = [edge for edge in tree if not edge.first]
    poses = {
        edge.second: _compute_child_pose(context, edge) @ context.shifts[edge.second]
        for edge in anchored
    }
    for edge in anchored:
        if edge.second == root or root not in poses:
            continue
        text = "bodies that are fixed to the world are fixed to the base"
        context.report_loss("anchor", text, edge.prim, Severity.INFO)
        written = context.get_written(edge.prim)
        joint = Joint(written, take_name(_get_joint_name(edge.prim), taken), "fixed")
        joint.parent, joint.child = context.names[root], context.names[edge.second]
        joint.origin = get_origin_at(poses[root].invert() @ poses[edge.second], written)
        robot.joints.append(joint)


def _get_joint_name(prim: Usd.Prim) -> str:
    return str(prim.GetCustomDataByKey("urdf:joint") or prim.GetDisplayName() or prim.GetName())


def _is_root(context: Context, path: str) -> bool:
    return context.names[path] == str(context.exported.GetCustomDataByKey("urdf:root") or "")


def _add_base(
    context: Context, robot: Robot, root: str, frames: dict[str, tuple[str, Pose]]
) -> None:
    """Set the base: free, unless a joint holds it in the world."""
    held = not context.bodies or any(_is_anchor(context, prim) for prim in context.joints)
    top = next((path for path in frames if _is_root(context, path)), root)
    pose = (
        context.get_pose(context.stage.GetPrimAtPath(top))
        if context.names.get("") is None
        else (IDENTITY)
    )
    written = context.get_written(context.top)
    turn = IDENTITY
    if context.is_y_up:
        turn = Pose(((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)))
    robot.base = Base(written, not held, get_origin_at(turn @ pose, written))


def _drop_world(context: Context, robot: Robot, frames: dict[str, tuple[str, Pose]]) -> None:
    """Remove a stored link ``world`` to which no active joint of the stage holds the base."""
    joints = [joint for joint in robot.joints if joint.parent == WORLD]
    path = next((path for path in frames if context.names[path] == WORLD), None)
    if robot.base is None or not robot.base.is_free or path is None:
        return
    prim = context.stage.GetPrimAtPath(path)
    if [joint.type for joint in joints] != ["fixed"] or prim.GetChildren():
        return
    context.report_loss("world", "no active joint holds the base at the world: it is free", prim)
    robot.links = [link for link in robot.links if link.name != WORLD]
    robot.joints.remove(joints[0])


def _is_anchor(context: Context, prim: Usd.Prim) -> bool:
    """Tell whether a joint connects a body and the world."""
    ends = [get_targets(prim, f"physics:body{index}") for index in (0, 1)]
    bodies = [context.find_body(context.stage.GetPrimAtPath(end[0])) if end else "" for end in ends]
    return "" in bodies and any(bodies) and _is_enabled(prim) and not _is_excluded(prim)


def _is_enabled(prim: Usd.Prim) -> bool:
    return bool(UsdPhysics.Joint(prim).GetJointEnabledAttr().Get())


def _make_closure(context: Context, edge: _Edge) -> Closure:
    written = context.get_written(edge.prim)
    kinds = {"fixed": "weld", "ball": "connect"}
    closure = Closure(written, edge.prim.GetName(), kinds.get(edge.kind.type, edge.kind.type))
    closure.is_active = _is_enabled(edge.prim)
    closure.parent = context.names.get(edge.first, "")
    closure.child = context.names.get(edge.second, "")
    first = context.shifts.get(edge.first, IDENTITY).invert() @ edge.first_pose
    second = context.shifts.get(edge.second, IDENTITY).invert() @ edge.second_pose
    closure.origin, closure.child_origin = (
        get_origin_at(first, written),
        get_origin_at(second, written),
    )
    if closure.type not in ("weld", "connect"):
        closure.axis = edge.kind.axis
    return closure
