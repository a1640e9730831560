"""Joints of SDF as a tree of joints and closed loops.

The frame of a link is put at its joint, as in URDF. Joints with two axes become two joints with a
link without mass between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ...errors import ModelError
from ...model.blocks import add_parts
from ...model.elements import Axis, Dynamics, Joint, Limit, Link, Mimic, Robot, Vector
from ...model.mechanism import Closure, Frame
from ...model.native import TWO_AXES
from ...model.pose import IDENTITY, Pose, get_origin_at, rotate
from ...model.provenance import Written
from ...model.read_settings import read_sdf_settings
from ...model.sensors import read_sensor
from ...model.settings import MAGNITUDES, OF_JOINTS, RESISTANCE_OF_URDF, Settings
from ...model.world import WORLD
from ...source.document import Element
from .read_links import Context, normalize_direction
from .read_scope import MODEL, Item, Scope
from .read_values import number, read_flag, read_pose, read_vector

UNLIMITED = 1e16
"""Limit of a joint that has none, before SDF 1.10."""

_NOISE = 1e-15
"""Parts of an axis this close to a whole number are rounding."""

_TURNING = ("revolute", "continuous", "ball", "universal", "revolute2", "screw", "gearbox")
_TYPES = (*_TURNING, "prismatic", "fixed")


@dataclass
class Found:
    """A joint with its ends.

    Attributes:
        element: Its element.
        scope: Its model.
        name: Name with the prefix of the model.
        parent: Name of the parent link.
        child: Name of the child link.
        pose: Pose of the joint frame in the top model.
    """

    element: Element
    scope: Scope
    name: str
    parent: str
    child: str
    pose: Pose

    @property
    def type(self) -> str:
        """Return the type as written."""
        return self.element.get("type") or ""


def find_joints(top: Scope) -> list[Found]:
    """Return all joints of a model with their ends.

    Raises:
        ModelError: An end is missing or does not exist, or the type is unknown.
    """
    found = []
    for prefix, scope in top.list_scopes():
        path = prefix.removesuffix("::")
        base = top.compute_pose(path, top.element) if path else IDENTITY
        for item in scope.joints.values():
            element = item.element
            if element.get("type") not in _TYPES:
                text = f"joint '{item.name}' has the type '{element.get('type')}', unknown in SDF"
                raise ModelError(text, at=element.place)
            parent, child = (_end(scope, top, prefix, item, tag) for tag in ("parent", "child"))
            if parent == child:
                raise ModelError(f"joint '{item.name}' joins a link to itself", at=element.place)
            pose = base @ scope.compute_pose(item.name, element)
            found.append(Found(element, scope, prefix + item.name, parent, child, pose))
    return found


def _end(scope: Scope, top: Scope, prefix: str, item: Item, tag: str) -> str:
    """Return the name of the link at an end of a joint."""
    element = item.element.find_child(tag)
    name = "" if element is None else element.text.strip()
    if element is None or not name:
        raise ModelError(f"joint '{item.name}' has no <{tag}>", at=item.element.place)
    name = item.home if name == MODEL else name
    if name == WORLD and WORLD not in scope.links:
        if tag == "child":
            text = f"the child of joint '{item.name}' is the world; write it as the parent"
            raise ModelError(text, at=element.place)
        return WORLD
    path = scope.link_of(name, element)
    return WORLD if path is None else prefix + "::".join(path)


def order(joints: list[Found]) -> tuple[list[Found], list[Found]]:
    """Return the joints of the tree, and those that close loops.

    The first joint of a link is that of the tree; joints of nested models come before those around
    them, so that a nested model keeps its tree.
    """
    parent_of: dict[str, str] = {}
    tree, loops = [], []
    for joint in sorted(joints, key=lambda joint: -joint.name.count("::")):
        above: str | None = joint.parent
        while above is not None and above != joint.child:
            above = parent_of.get(above)
        if joint.child in parent_of or above is not None:
            loops.append(joint)
        else:
            parent_of[joint.child] = joint.parent
            tree.append(joint)
    places = {joint.name: number for number, joint in enumerate(joints)}
    return sorted(tree, key=lambda joint: places[joint.name]), loops


def set_shifts(context: Context, tree: list[Found]) -> None:
    """Put the frames of links at the joints about which they turn."""
    for joint in tree:
        if joint.type in _TURNING:
            anchor = (context.poses[joint.child].invert() @ joint.pose).translation
            if math.dist(anchor, (0.0, 0.0, 0.0)) > 1e-12:
                x, y, z = anchor
                context.shifts[joint.child] = Pose(translation=(-x, -y, -z))


def add_joint(context: Context, found: Found) -> None:
    """Add a joint of the tree to the robot."""
    written, robot = Written(found.element.place), context.robot
    at = get_link_pose(context, found.parent).invert() @ get_link_pose(context, found.child)
    joint = Joint(
        written,
        found.name,
        _read_type(found),
        found.parent,
        found.child,
        origin=get_origin_at(at, written),
    )
    joint.settings = _read_settings(context, found, "axis")
    turn = Pose(context.poses[found.child].invert().rotation)
    if found.type in TWO_AXES:
        middle = f"{found.child}~1"
        robot.links.append(Link(written, middle, is_virtual=True))
        second = replace(
            joint, name=f"{found.name}~2", parent=middle, origin=get_origin_at(IDENTITY, written)
        )
        for one, tag in ((replace(joint, child=middle), "axis"), (second, "axis2")):
            _set_axis(context, found, one, tag, turn)
            robot.joints.append(one)
    else:
        if found.type not in ("fixed", "ball"):
            _set_axis(context, found, joint, "axis", turn)
        robot.joints.append(joint)
    if found.type == "gearbox":
        context.record_loss("gearbox", "ratios of gearboxes are not read", found.element)
    frame = get_link_pose(context, found.child).invert() @ found.pose  # of the joint, in the child
    for sensor in found.element.list_children("sensor"):
        pose, place = frame @ read_pose(sensor)[0], Written(sensor.place, sensor)
        add_parts(robot, sensor, read_sensor(sensor, pose, joint=found.name, provenance=place))


def get_link_pose(context: Context, link: str) -> Pose:
    """Return the pose of the shifted frame of a link in the top model."""
    return context.poses[link] @ context.shifts[link].invert()


def _read_type(found: Found) -> str:
    return "revolute" if found.type in (*TWO_AXES, "gearbox") else found.type


def _read_settings(context: Context, found: Found, axis: str) -> Settings:
    part, rejected = ("joint", found.name), context.robot.rejected_settings
    return read_sdf_settings(found.element, OF_JOINTS, rejected, part, axis=axis)


def _set_axis(context: Context, found: Found, joint: Joint, tag: str, turn: Pose) -> None:
    """Set axis, limits, dynamics and coupling of a joint."""
    element = found.element.find_child(tag)
    holder = found.element if element is None else element
    xyz = (0.0, 0.0, 1.0) if element is None else read_vector(element, "xyz", (0.0, 0.0, 1.0))
    frame = _find_axis_frame(context, found, element)
    written = Written(holder.place)
    along = rotate(turn.rotation, rotate(frame.rotation, normalize_direction(holder, xyz)))
    joint.axis = Axis(written, _without_noise(along))
    joint.limit = _limit(element, joint.type, written)
    if joint.type == "revolute" and _is_unlimited(joint.limit) and found.type != "gearbox":
        joint.type = "continuous"
    if joint.type == "continuous" and joint.limit is not None:
        joint.limit = replace(joint.limit, lower=None, upper=None)
        if (joint.limit.effort, joint.limit.velocity) == (None, None):
            joint.limit = None
    joint.dynamics = _read_dynamics(element)
    joint.settings = _read_settings(context, found, tag)
    if found.type == "screw":
        joint.thread_pitch = _read_pitch(found)
    mimic = None if element is None else element.find_child("mimic")
    if mimic is not None:
        multiplier = number(mimic, "multiplier", 1.0)
        offset = number(mimic, "offset", 0.0) - multiplier * number(mimic, "reference", 0.0)
        prefix = found.name.removesuffix(found.element.get("name") or "")
        leader = prefix + (mimic.get("joint") or "")
        if mimic.get("axis") == "axis2":
            leader += "~2"
        joint.mimic = Mimic(Written(mimic.place), leader, multiplier, offset)


def _without_noise(axis: Vector) -> Vector:
    """Return a unit vector without the rounding errors of rotations."""
    x, y, z = (float(round(part)) if abs(part - round(part)) < _NOISE else part for part in axis)
    return x, y, z


def _find_axis_frame(context: Context, found: Found, element: Element | None) -> Pose:
    """Return the pose of the frame in which an axis is written, in the top model."""
    name = found.element.get("name") or ""
    top = found.pose @ found.scope.compute_pose(name, found.element).invert()  # of the model
    if element is None:
        return found.pose
    xyz = element.find_child("xyz")
    named = None if xyz is None else xyz.get("expressed_in")
    if named:
        return top @ found.scope.compute_pose(named, element)
    if found.scope.version < (1, 5) or (
        found.scope.version < (1, 7) and read_flag(element, "use_parent_model_frame")
    ):
        return top
    return found.pose


def _limit(element: Element | None, kind: str, written: Written) -> Limit | None:
    """Return the limits; None if there are none."""
    holder = None if element is None else element.find_child("limit")
    if holder is None:
        return None
    lower, upper = number(holder, "lower", -math.inf), number(holder, "upper", math.inf)
    effort, velocity = (number(holder, tag, -1.0) for tag in MAGNITUDES)
    limit = Limit(
        Written(holder.place),
        lower if lower > -UNLIMITED else -math.inf,
        upper if upper < UNLIMITED else math.inf,
        effort if 0 <= effort < UNLIMITED else None,
        velocity if 0 <= velocity < UNLIMITED else None,
    )
    bounded = not _is_unlimited(limit) or limit.effort is not None or limit.velocity is not None
    return limit if bounded else None


def _is_unlimited(limit: Limit | None) -> bool:
    return limit is None or (limit.lower, limit.upper) == (-math.inf, math.inf)


def _read_dynamics(element: Element | None) -> Dynamics | None:
    holder = None if element is None else element.find_child("dynamics")
    if holder is None:
        return None
    written = [name for name in RESISTANCE_OF_URDF if holder.find_child(name) is not None]
    return Dynamics(Written(holder.place), **{name: number(holder, name, 0.0) for name in written})


def _read_pitch(found: Found) -> float:
    """Return the translation of a screw for each turn [m].

    ``thread_pitch`` is the left-handed angle for each meter; since 1.10 ``screw_thread_pitch`` is
    the right-handed distance for each turn.
    """
    if found.element.find_child("screw_thread_pitch") is not None:
        return number(found.element, "screw_thread_pitch", 1.0)
    thread = number(found.element, "thread_pitch", 1.0)
    return -math.tau / thread if thread else 0.0


def check_mimics(robot: Robot) -> None:
    """Check that the leader of each mimic joint exists.

    Raises:
        ModelError: One does not.
    """
    for joint in robot.joints:
        if joint.mimic is not None and joint.mimic.joint not in robot.joint:
            text = f"joint '{joint.name}' mimics '{joint.mimic.joint}', which does not exist"
            raise ModelError(text, at=joint.mimic.place)


def add_closure(context: Context, found: Found) -> None:
    """Add a joint that closes a loop."""
    written = Written(found.element.place)
    ends = [
        get_origin_at(get_link_pose(context, link).invert() @ found.pose, written)
        for link in (found.parent, found.child)
    ]
    element = found.element.find_child("axis")
    axis: Vector | None = None
    if found.type not in ("fixed", "ball"):
        xyz = (0.0, 0.0, 1.0) if element is None else read_vector(element, "xyz", (0.0, 0.0, 1.0))
        frame = found.pose.invert() @ _find_axis_frame(context, found, element)
        axis = rotate(frame.rotation, normalize_direction(found.element, xyz))
    kind = "weld" if found.type == "fixed" else found.type
    closure = Closure(written, found.name, kind, found.parent, found.child, ends[0], ends[1], axis)
    context.robot.closures.append(closure)


def add_world(context: Context, robot: Robot, roots: list[str], is_static: bool) -> None:
    """Connect links to the world, each by its own joint."""
    taken = {joint.name for joint in robot.joints}
    for root in roots:
        kind = "fixed" if is_static else "floating"
        name = f"{root}_{kind}"
        while name in taken:
            name += "_"
        taken.add(name)
        link = robot.link[root]
        origin = get_origin_at(
            get_link_pose(context, WORLD).invert() @ get_link_pose(context, root)
        )
        robot.joints.append(Joint(link.provenance, name, kind, WORLD, root, origin=origin))


def add_frames(context: Context, top: Scope) -> None:
    """Add the frames of a model, and those of links that were shifted."""
    robot = context.robot
    for name, shift in context.shifts.items():
        if shift is not IDENTITY and name in robot.link:
            place = robot.link[name].provenance
            robot.frames.append(Frame(place, name, name, "body", get_origin_at(shift)))
    for prefix, scope in top.list_scopes():
        path = prefix.removesuffix("::")
        base = top.compute_pose(path, top.element) if path else IDENTITY
        for item in scope.frames.values():
            link = scope.link_of(item.name, item.element)
            owner = WORLD if link is None else prefix + "::".join(link)
            if owner not in robot.link:
                continue
            pose = base @ scope.compute_pose(item.name, item.element)
            written = Written(item.element.place)
            origin = get_origin_at(get_link_pose(context, owner).invert() @ pose, written)
            robot.frames.append(Frame(written, prefix + item.name, owner, "frame", origin))
