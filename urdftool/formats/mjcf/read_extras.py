"""Sites, cameras, sensors, actuators, equalities, exclusions and keyframes of MJCF."""

from __future__ import annotations

import math
from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Joint, Limit, Mimic, Robot
from ...model.mechanism import (
    Camera,
    Closure,
    Configuration,
    ContactExclusion,
    Frame,
    JointActuator,
    Light,
    MountedSensor,
)
from ...model.pose import IDENTITY, Pose, get_origin_at, rotate, rotation_from_quaternion
from ...model.provenance import Written
from ...model.world_settings import OF_MUJOCO
from .read_compile import Row
from .read_context import Context, read_settings

_CAMERA = Pose(((0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)))
"""Axes of a camera that looks along x with z up, in one that looks along −z with y up."""

_LEFT_OUT = {
    "tendon": ("tendons are not read", Severity.WARNING),
    "flex": ("deformable bodies are not read", Severity.WARNING),
    "plugin": ("plugins are not read", Severity.WARNING),
    "skin": ("skins are not read", Severity.INFO),
}


REFERENCE = "qpos0"
"""Name of the configuration of a model whose joints do not start at zero."""


def add_extras(context: Context, robot: Robot) -> None:
    """Add everything but bodies, joints and geoms."""
    for kind, (text, severity) in _LEFT_OUT.items():
        for row in context.list_rows(kind):
            place = context.get_element(row).place
            context.losses.add(kind, text, row["name"], place, severity)
    (option,) = context.list_rows("option")
    element = context.expanded.root.find_child("option") or context.expanded.root
    robot.world = read_settings(option, OF_MUJOCO, Written(element.place))
    _add_frames(context, robot)
    for row in context.list_rows("actuator"):
        _add_actuator(context, robot, row)
    for row in context.list_rows("equality"):
        _add_equality(context, robot, row)
    for row in context.list_rows("exclude"):
        robot.exclusions.append(
            ContactExclusion(context.get_place(row), row["body1"], row["body2"])
        )
    for row in context.list_rows("sensor"):
        _add_sensor(context, robot, row)
    for row in context.list_rows("light"):
        _add_light(context, robot, row)
    _add_configurations(context, robot)


def _add_frames(context: Context, robot: Robot) -> None:
    for row in context.list_rows("site"):
        written = context.get_place(row)
        if not context.has_link(row):
            text = "sites in the world are not read"
            context.losses.add("world-site", text, row["name"], written.place, Severity.INFO)
            continue
        origin = get_origin_at(context.compute_pose_in_link(row), written)
        link = context.links[row["bodyid"]]
        robot.frames.append(Frame(written, row["name"], link, "site", origin))
    for row in context.list_rows("camera"):
        written = context.get_place(row)
        if row["mode"] != 0:
            text = "cameras that follow a body are fixed to theirs"
            context.losses.add("camera-mode", text, row["name"], written.place, Severity.INFO)
        if not context.has_link(row):
            text = "cameras in the world are scenery"
            context.losses.add("camera", text, row["name"], written.place, Severity.INFO)
            continue
        width, height = row["resolution"]
        camera = Camera(
            written,
            row["name"],
            context.links[row["bodyid"]],
            get_origin_at(context.compute_pose_in_link(row) @ _CAMERA, written),
            math.radians(row["fovy"]),
            (width, height) if width > 1 and height > 1 else None,
        )
        robot.cameras.append(camera)


def _add_light(context: Context, robot: Robot, row: Row) -> None:
    written = context.get_place(row)
    if not context.has_link(row):
        text = "lights in the world are scenery"
        context.losses.add("light", text, row["name"], written.place, Severity.INFO)
        return
    shift = context.shifts[row["bodyid"]]
    kind = {"directional": "directional", "spot": "spot"}.get(row["type"], "point")
    robot.lights.append(
        Light(
            written,
            row["name"],
            context.links[row["bodyid"]],
            kind,
            shift.transform(tuple(row["pos"])),
            None if kind == "point" else rotate(shift.rotation, tuple(row["dir"])),
            tuple(row["diffuse"]),
            tuple(row["specular"]),
            math.radians(row["cutoff"]) if kind == "spot" else None,
            bool(row["castshadow"]),
        )
    )


def _add_actuator(context: Context, robot: Robot, row: Row) -> None:
    written = context.get_place(row)
    target = row["trnid"][0]
    joint = None
    if row["trntype"] in ("joint", "jointinparent"):
        joint = robot.joint[context.joints[target]]
    kinds = row["gaintype"] in ("fixed", "affine"), row["biastype"] in ("none", "affine")
    if joint is None or joint.type in ("ball", "floating") or not all(kinds):
        text = "actuators of other things than one joint, or of a nonlinear law, are not read"
        context.losses.add("actuator", text, row["name"], written.place)
        return
    if row["gaintype"] == "affine" and any(row["gainprm"][1:3]):
        text = "gains that depend on the position or velocity are not read"
        context.losses.add("gain", text, row["name"], written.place)
    if row["dyntype"] != "none":
        text = "activation dynamics of actuators are not read"
        context.losses.add("activation", text, row["name"], written.place)
    gain = row["gainprm"][0]
    a, b, c = row["biasprm"][:3] if row["biastype"] == "affine" else (0.0, 0.0, 0.0)
    robot.joint_actuators.append(
        JointActuator(
            written,
            row["name"],
            joint.name,
            _get_mode(gain, (a, b, c)),
            row["gear"][0],
            gain,
            (a, b, c),
            tuple(row["ctrlrange"]) if row["ctrllimited"] else None,
            tuple(row["forcerange"]) if row["forcelimited"] else None,
            row["dampratio"],
        )
    )


def _get_mode(gain: float, bias: tuple[float, float, float]) -> str:
    """Return the kind of an actuator by its law."""
    constant, position, velocity = bias
    if constant:
        return "general"
    if not position and not velocity:
        return "motor"
    if position:
        return "position" if gain == -position else "general"
    return "velocity" if gain == -velocity else "general"


def _add_equality(context: Context, robot: Robot, row: Row) -> None:
    written = context.get_place(row)
    if row["type"] == "joint":
        _couple(context, robot, row, written)
    elif row["type"] in ("connect", "weld"):
        _close(context, robot, row, written)
    else:
        text = f"equality constraints of type {row['type']} are not read"
        context.losses.add(f"equality-{row['type']}", text, row["name"], written.place)


def _couple(context: Context, robot: Robot, row: Row, written: Written) -> None:
    """Add a ``Mimic`` for a linear coupling; equal limits for a joint that is held.

    MuJoCo's is y − y0 = c0 + c1 (x − x0) + c2 (x − x0)² + c3 (x − x0)³ + c4 (x − x0)⁴.
    """
    follower = robot.joint[context.joints[row["obj1id"]]]
    polynomial = row["data"][:5]
    joints = context.list_rows("joint")
    y0 = joints[row["obj1id"]]["ref"]
    if row["obj2id"] < 0 and row["active0"] and follower.type != "ball":
        held = polynomial[0] + y0
        limit = replace(follower.limit or Limit(written), lower=held, upper=held)
        kind = "prismatic" if follower.type == "prismatic" else "revolute"
        _replace(robot, follower, replace(follower, type=kind, limit=limit))
        return
    linear = row["obj2id"] >= 0 and not any(polynomial[2:]) and row["active0"]
    if not linear or follower.mimic is not None:
        text = "couplings of joints that are not linear or not active are not read"
        context.losses.add("coupling", text, row["name"] or follower.name, written.place)
        return
    x0 = joints[row["obj2id"]]["ref"]
    offset = polynomial[0] + y0 - polynomial[1] * x0
    mimic = Mimic(written, context.joints[row["obj2id"]], polynomial[1], offset)
    _replace(robot, follower, replace(follower, mimic=mimic))


def _replace(robot: Robot, old: Joint, new: Joint) -> None:
    index = next(i for i, joint in enumerate(robot.joints) if joint is old)
    robot.joints[index] = robot.joint[new.name] = new


def _close(context: Context, robot: Robot, row: Row, written: Written) -> None:
    one, other = row["obj1id"], row["obj2id"]
    x, y, z = row["data"][:3]
    if row["objtype"] == "site":
        first, second = (context.list_rows("site")[i] for i in (one, other))
        one, other = first["bodyid"], second["bodyid"]
        origin, child_origin = (
            context.compute_pose_in_link(first),
            context.compute_pose_in_link(second),
        )
    elif row["type"] == "connect":
        u, v, w = row["data"][3:6]
        origin = context.shifts[one] @ Pose(translation=(x, y, z))
        child_origin = context.shifts[other] @ Pose(translation=(u, v, w))
    else:
        u, v, w = row["data"][3:6]
        q0, q1, q2, q3 = row["data"][6:10]
        # both positions are those of the anchor, in the first and the second body
        origin = context.shifts[one] @ Pose(rotation_from_quaternion((q0, q1, q2, q3)), (u, v, w))
        child_origin = context.shifts[other] @ Pose(translation=(x, y, z))
    robot.closures.append(
        Closure(
            written,
            row["name"],
            row["type"],
            context.links[one],
            context.links[other],
            get_origin_at(origin, written),
            get_origin_at(child_origin, written),
            is_active=bool(row["active0"]),
        )
    )


def _add_sensor(context: Context, robot: Robot, row: Row) -> None:
    written, target = context.get_place(row), row["objid"]
    kind = row["objtype"]
    tag = context.get_element(row).tag if row["line"] else row["type"]
    sensor = MountedSensor(written, row["name"], tag)
    if kind == "joint":
        robot.mounted_sensors.append(replace(sensor, joint=context.joints[target]))
        return
    body, at = -1, IDENTITY
    if kind in ("site", "geom", "camera"):
        holder = context.list_rows(kind)[target]
        body, at = holder["bodyid"], context.compute_pose_in_link(holder)
    elif kind == "xbody":
        body, at = target, context.shifts[target]
    elif kind == "body":  # at its center of mass
        center = Pose(translation=tuple(context.list_rows("body")[target]["ipos"]))
        body, at = target, context.shifts[target] @ center
    if body < 0 or not context.links[body]:
        text = "sensors of other things than a link or joint are not read"
        context.losses.add("sensor", text, row["name"], written.place, Severity.INFO)
        return
    origin = get_origin_at(at, written)
    site = context.list_rows(kind)[target]["name"] if kind == "site" else ""
    robot.mounted_sensors.append(
        replace(sensor, link=context.links[body], origin=origin, site=site)
    )


def _add_configurations(context: Context, robot: Robot) -> None:
    elements = [e for e in context.expanded.lines.values() if e.tag == "key"]
    named = {element.get("name") or "": element for element in elements}
    joints = [
        (context.joints[i], row["qposadr"], row["ref"])
        for i, row in enumerate(context.list_rows("joint"))
        if row["type"] in ("hinge", "slide")
    ]
    if any(reference for _, _, reference in joints):
        drawn = {name: reference for name, _, reference in joints if reference}
        written = Written(context.expanded.root.place)
        robot.configurations.append(Configuration(written, REFERENCE, drawn))
    for number, (name, positions) in enumerate(context.compiled.keys):
        default = elements[number] if number < len(elements) else context.expanded.root
        element = named.get(name, default) if name else default
        robot.configurations.append(
            Configuration(
                Written(element.place),
                name or f"key{number}",
                {joint: positions[address] for joint, address, _ in joints},
            )
        )
