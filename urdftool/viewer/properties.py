"""Properties of links and joints as HTML, with all text from files escaped."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Iterator

from ..control_characters import escape_controls
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Joint,
    Link,
    Mesh,
    Origin,
    Plane,
    Robot,
    Sphere,
    Visual,
)
from ..model.pose import Pose, make_pose, rpy_from_rotation
from ..model.settings import OF_LIMITS, RESISTANCE_OF_URDF, split_unit
from ..model.shapes import get_shape_name
from .sliders import format_value

_MISSING = "not specified"

LONGEST = 60
"""Maximum length of a displayed name; a longer one is shortened in its middle. Chosen, no
source."""

Row = tuple[str, str]


def shorten_name(name: str, longest: int = LONGEST) -> str:
    """Escape unprintable characters of a name and shorten it in its middle."""
    text = escape_controls(name)
    if len(text) <= longest:
        return text
    half = (longest - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def escape_html(text: str) -> str:
    """Escape text for HTML."""
    return html.escape(shorten_name(text, 2000), quote=True)


def format_table(rows: Iterable[Row]) -> str:
    """Format rows of a label and a text as an HTML table."""
    cells = "".join(
        f"<tr><td>{escape_html(label)}</td><td>{escape_html(text)}</td></tr>"
        for label, text in rows
    )
    return f"<table>{cells}</table>"


def link_rows(robot: Robot, link: Link, pose: Pose | None = None) -> Iterator[Row]:
    """Yield the properties of a link."""
    joint = robot.tree.get_parent_joint(link.name)
    below = robot.tree.get_child_joints(link.name)
    if joint is None:
        yield "parent", "none (root link)"
    else:
        yield "parent", f"{joint.parent} by {joint.name} ({joint.type})"
    if below:
        yield "children", ", ".join(child.child for child in below)
    if pose is not None:
        yield (
            "current pose",
            (
                f"{_format_lengths(pose.translation)}, rpy "
                f"{_format_angles(rpy_from_rotation(pose.rotation))}"
            ),
        )
    yield from _list_mass_rows(link)
    for label, shapes in (("visual", link.visuals), ("collision", link.collisions)):
        for shape in shapes:
            yield label, format_shape(shape)
    if link.is_frame:
        yield "note", "frame without geometry and mass"


def _list_mass_rows(link: Link) -> Iterator[Row]:
    inertial = link.inertial
    if inertial is None:
        yield "mass", _MISSING
        return
    yield "mass", _MISSING if inertial.mass is None else f"{inertial.mass:.6g} kg"
    yield "center of mass", _format_lengths(make_pose(inertial.origin).translation)
    if inertial.origin is not None and any(inertial.origin.rpy):
        yield "inertia frame", f"rpy {_format_angles(inertial.origin.rpy)}"
    if inertial.inertia is None:
        yield "inertia", _MISSING
        return
    yield "ixx iyy izz", f"{_format_numbers(inertial.inertia.moments)} kg·m²"
    yield "ixy ixz iyz", f"{_format_numbers(inertial.inertia.products)} kg·m²"


def list_joint_rows(joint: Joint) -> Iterator[Row]:
    """Yield the properties of a joint."""
    turns = joint.type != "prismatic"
    yield "type", joint.type or _MISSING
    yield "parent", joint.parent or _MISSING
    yield "child", joint.child or _MISSING
    yield "origin", _format_origin(joint.origin)
    if joint.has_axis:
        yield "axis", _format_numbers(joint.axis.xyz) if joint.axis else "1 0 0 (default)"
    limit = joint.limit
    if limit is not None and joint.is_limited:
        low, high = limit.lower or 0.0, limit.upper or 0.0
        unit = "rad" if turns else "m"
        yield (
            "limits",
            f"{low:g} … {high:g} {unit} ({format_value(low, turns)} … {format_value(high, turns)})",
        )
    elif joint.is_limited:
        yield "limits", _MISSING
    for row in OF_LIMITS:
        value = getattr(limit, row.name, None)
        if value is not None:
            yield row.name, f"{value:g} {split_unit(row.unit)[not turns]}"
    if joint.dynamics is not None:
        for label in RESISTANCE_OF_URDF:
            value = getattr(joint.dynamics, label)
            if value is not None:
                yield label, f"{value:g}"
    if joint.mimic is not None:
        mimic = joint.mimic
        yield "mimics", f"{mimic.joint} × {mimic.multiplier:g} + {mimic.offset:g}"


def format_shape(shape: Visual | Collision) -> str:
    """Format a shape with its dimensions and its name, if any."""
    geometry = shape.geometry
    if isinstance(geometry, Box):
        text = f"box {_format_lengths(geometry.size)}"
    elif isinstance(geometry, Sphere):
        text = f"sphere, radius {format_value(geometry.radius, False)}"
    elif isinstance(geometry, Ellipsoid):
        text = f"ellipsoid, radii {_format_lengths(geometry.radii)}"
    elif isinstance(geometry, Plane):
        text = "plane"
    elif isinstance(geometry, Cylinder | Capsule | Cone):
        text = f"{get_shape_name(geometry)}, radius {format_value(geometry.radius, False)}"
        text += f", length {format_value(geometry.length, False)}"
    elif isinstance(geometry, Mesh):
        text = geometry.filename or "mesh without a file"
        if geometry.scale != (1.0, 1.0, 1.0):
            text += f", scale {_format_numbers(geometry.scale)}"
    else:
        text = "unknown geometry"
    return f"{text} ({shape.name})" if shape.name else text


def _format_origin(origin: Origin | None) -> str:
    if origin is None:
        return "0 0 0 m (default)"
    turn = rpy_from_rotation(make_pose(origin).rotation) if origin.quaternion else origin.rpy
    return _format_lengths(origin.xyz) + (f", rpy {_format_angles(turn)}" if any(turn) else "")


def _format_lengths(values: Iterable[float]) -> str:
    return f"{_format_numbers(values)} m"


def _format_angles(values: Iterable[float]) -> str:
    return " ".join(
        f"{round(math.degrees(v), 1) + 0.0:g}°" if math.isfinite(v) else "?" for v in values
    )


def _format_numbers(values: Iterable[float]) -> str:
    return " ".join(f"{round(value, 9) + 0.0:.4g}" for value in values)
