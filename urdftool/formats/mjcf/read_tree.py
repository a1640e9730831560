"""Bodies and joints of MJCF as links and joints.

A body of MJCF may turn about any point and have several joints. Here the frame of a link is at its
last joint, as in URDF, so it may be shifted from that of the body; a link without mass stands
between two joints of a body.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Axis, Dynamics, Inertia, Inertial, Joint, Limit, Link, Robot, Vector
from ...model.kinematics import UNLIMITED, compute_motion
from ...model.mechanism import Base, Frame
from ...model.part import ZERO
from ...model.pose import IDENTITY, Pose, get_origin_at
from ...model.provenance import Written
from ...model.settings import JOINTS_OF_MUJOCO, LINKS_OF_MUJOCO, RESISTANCE, Settings, Value
from ...model.world import WORLD
from ..reading import take_name
from .read_compile import Row
from .read_context import Context, name_bodies, name_joints, read_pose, read_settings

VELOCITY = "_velocity_limit"
"""End of the name of a number in ``<custom>``: the velocity limit of a joint, which MJCF lacks."""


def add_tree(context: Context, robot: Robot) -> None:
    """Add links and joints.

    The root is the only body in the world, or a link ``world`` if there are several or if a joint
    other than a free one connects it to the world.
    """
    bodies = context.list_rows("body")
    joints: dict[int, list[int]] = {}
    for index, row in enumerate(context.list_rows("joint")):
        joints.setdefault(row["bodyid"], []).append(index)
    name_bodies(context, _needs_world(context, joints))
    taken = name_joints(context)
    if context.links[0]:
        robot.links.append(Link(Written(context.expanded.root.place), WORLD))
    context.shifts = [IDENTITY]
    for index, row in enumerate(bodies[1:], 1):
        own = joints.get(index, [])
        parent = context.links[row["parentid"]]
        anchor = _anchor(context.list_rows("joint")[own[-1]]) if own else ZERO
        shift = Pose(translation=_negate(anchor))
        context.shifts.append(shift)
        link = Link(
            context.get_place(row), context.links[index], _read_inertial(context, row, shift)
        )
        if parent:
            made = list(_read_joints(context, row, index, own, taken))
            robot.joints += made
            robot.links += [
                Link(joint.provenance, joint.child, is_virtual=True) for joint in made[:-1]
            ]
        else:
            base = get_origin_at(read_pose(row), context.get_place(row))
            robot.base = Base(context.get_place(row), bool(own), base)
            for joint in (context.list_rows("joint")[number] for number in own):
                _report_dynamics(context, joint)
        robot.links.append(link)
        if any(anchor):
            origin = get_origin_at(shift, context.get_place(row))
            robot.frames.append(Frame(context.get_place(row), link.name, link.name, "body", origin))
        if row["mocapid"] >= 0:
            text = "bodies that the program moves are fixed"
            context.losses.add("mocap", text, row["name"], link.place, Severity.INFO)
        if row["gravcomp"] == 1.0:
            link.settings["gravity"] = Value(link.provenance, False)
        else:
            link.settings = read_settings(row, LINKS_OF_MUJOCO, context.get_place(row))


def _needs_world(context: Context, joints: dict[int, list[int]]) -> bool:
    """Tell whether the world is a link of the robot."""
    top = [i for i, row in enumerate(context.list_rows("body")) if i and row["parentid"] == 0]
    kinds = [context.list_rows("joint")[i]["type"] for body in top for i in joints.get(body, [])]
    closes = any(
        0 in (row["obj1id"], row["obj2id"])
        for row in context.list_rows("equality")
        if row["type"] in ("connect", "weld") and row["objtype"] == "body"
    )
    return len(top) != 1 or kinds not in ([], ["free"]) or closes


def _read_inertial(context: Context, row: Row, shift: Pose) -> Inertial | None:
    if not row["mass"]:
        return None
    written = context.get_element(row).find_child("inertial")
    at = context.get_place(row) if written is None else Written(written.place)
    a, b, c = row["inertia"]
    tensor = Inertia(at, a, 0.0, 0.0, b, 0.0, c)
    return Inertial(
        at, get_origin_at(shift @ read_pose(row, "ipos", "iquat"), at), row["mass"], tensor
    )


def _anchor(row: Row) -> Vector:
    """Return the point about which a joint turns, in the frame of its body [m]."""
    x, y, z = row["pos"] if row["type"] in ("hinge", "ball") else ZERO
    return x, y, z


def _negate(point: Vector) -> Vector:
    x, y, z = point
    return -x, -y, -z


def _read_joints(
    context: Context, body: Row, index: int, own: list[int], taken: set[str]
) -> Iterator[Joint]:
    """Yield the joints between a body and its parent, the first of them first."""
    name, parent = context.links[index], context.links[body["parentid"]]
    at = context.shifts[body["parentid"]] @ read_pose(body)
    if not own:
        written = context.get_place(body)
        fixed = take_name(f"{name}_fixed", taken)
        origin = get_origin_at(at @ context.shifts[index].invert(), written)
        yield Joint(written, fixed, "fixed", parent, name, origin=origin)
        return
    before = ZERO
    links = set(context.links)
    for count, number in enumerate(own, 1):
        row = context.list_rows("joint")[number]
        child = name if count == len(own) else take_name(f"{name}~{count}", links)
        anchor = _anchor(row)
        step = Pose(translation=tuple(a - b for a, b in zip(anchor, before, strict=True)))  # type: ignore[arg-type]
        joint = _read_joint(context, row, number, parent, child)
        if row["ref"] and joint.type not in ("ball", "floating"):
            step = step @ compute_motion(replace(joint, limit=None), -row["ref"])
        yield replace(joint, origin=get_origin_at(at @ step, joint.provenance))
        at, before, parent = IDENTITY, anchor, child


def _read_joint(context: Context, row: Row, number: int, parent: str, child: str) -> Joint:
    """Return a joint without its origin."""
    written = _place(context, row)
    lower, upper = (
        end if abs(end) < UNLIMITED else math.copysign(math.inf, end) for end in row["range"]
    )
    limited = bool(row["limited"]) and (lower, upper) != (-math.inf, math.inf)
    kind = {"hinge": "revolute", "slide": "prismatic", "ball": "ball", "free": "floating"}[
        row["type"]
    ]
    joint = Joint(written, context.joints[number], kind, parent, child)
    if kind in ("revolute", "prismatic"):
        x, y, z = row["axis"]
        joint.axis = Axis(written, (x, y, z))
        joint.type = "continuous" if kind == "revolute" and not limited else kind
    if kind == "floating":
        _report_dynamics(context, row)
    else:
        joint.dynamics = _read_dynamics(context, row, written)
    joint.settings = _read_spring(context, row, written) | read_settings(
        row, JOINTS_OF_MUJOCO, written
    )
    effort = _compute_effort(context, row, number)
    velocity = _read_velocity(context, joint.name)
    if limited:
        joint.limit = Limit(written, lower, upper, effort, velocity)
    elif effort is not None or velocity is not None:
        bound = math.inf if kind == "prismatic" else None
        low = None if bound is None else -bound
        joint.limit = Limit(written, low, bound, effort, velocity)
    return joint


def _report_dynamics(context: Context, row: Row) -> None:
    """Report the dynamics of a free joint, which the robot does not hold."""
    if any(row[one.mjcf_attribute] for one in RESISTANCE):
        text = "damping, friction and armature of free joints are not read"
        context.losses.add("base-dynamics", text, row["name"], _place(context, row).place)


def _read_velocity(context: Context, joint: str) -> float | None:
    """Return the limit of velocity [rad/s or m/s] that exporters keep as a number."""
    for row in context.list_rows("numeric"):
        if row["name"] == joint + VELOCITY and row["data"]:
            return float(row["data"][0])
    return None


def _place(context: Context, row: Row) -> Written:
    """Return the place of a joint; MuJoCo gives no line of a ``<freejoint>``."""
    if row["line"]:
        return context.get_place(row)
    body = context.get_element(context.list_rows("body")[row["bodyid"]])
    element = body.find_child("freejoint")
    return Written((body if element is None else element).place)


def _read_dynamics(context: Context, row: Row, written: Written) -> Dynamics | None:
    if row["poly"]:
        text = "damping that is not proportional to velocity is not read"
        context.losses.add("damping", text, row["name"], written.place)
    values = {one.name: row[one.mjcf_attribute] or None for one in RESISTANCE}
    return Dynamics(written, **values) if any(values.values()) else None


def _read_spring(context: Context, row: Row, written: Written) -> Settings:
    if row["spring_poly"] or row["springyield"]:
        text = "a spring whose force is not proportional to its deflection is not read"
        context.losses.add("spring", text, row["name"], written.place)
    if not row["stiffness"]:
        return {}
    found = {"spring_stiffness": Value(written, row["stiffness"])}
    if row["type"] in ("hinge", "slide") and row["springref"]:
        found["spring_reference"] = Value(written, row["springref"])
    return found


def _compute_effort(context: Context, row: Row, number: int) -> float | None:
    """Return the largest force of the actuators of a joint [N or N·m]; None if not bounded."""
    bounds: list[float] = []
    for actuator in context.list_rows("actuator"):
        if actuator["trntype"] in ("joint", "jointinparent") and actuator["trnid"][0] == number:
            bounds.append(_bound(actuator))
    total = math.fsum(bounds) if bounds else math.inf
    if row["actfrclimited"] and row["type"] in ("hinge", "slide"):
        total = min(total, *(abs(value) for value in row["actfrcrange"]))
    return total if total < UNLIMITED else None


def _bound(actuator: Row) -> float:
    """Return the largest force of an actuator at its joint [N or N·m]."""
    bound = math.inf
    gear = abs(actuator["gear"][0])
    if actuator["forcelimited"]:
        bound = gear * max(map(abs, actuator["forcerange"]))
    is_motor = actuator["gaintype"] == "fixed" and actuator["biastype"] == "none"
    if actuator["ctrllimited"] and is_motor:
        control = max(map(abs, actuator["ctrlrange"]))
        bound = min(bound, gear * abs(actuator["gainprm"][0]) * control)
    return bound
