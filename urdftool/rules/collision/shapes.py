"""Check the shapes themselves."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.bounds import has_extent
from ...model.elements import Collision, Geometry, Link, Robot, UnknownShape, Visual
from ...model.millimeters import find_shapes_in_millimeters
from ...model.read import number, parse_numbers
from ...model.urdf_schema import VOCABULARY
from ...suggestions import find_nearest
from ..fix import (
    FixContext,
    Proposal,
    find_element,
    get_suggestion,
    is_computed,
    rename_element,
    set_attribute,
    unsafe,
)
from ..mujoco import keeps_visuals
from ..rule import ANY_FORMAT, ERROR, INFO, UNSAFE, WARNING, Problem, rule
from ..xml.from_sdf import move_out_of_geometry

_SILENT = "urdfdom, gz, gazebo-classic, pybullet, pinocchio"
_SIZES = {
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "capsule": ("radius", "length"),
}


@rule(
    ERROR,
    effects={
        "mujoco": "rejects the file: size must be positive",
        "drake": "aborts",
        _SILENT: "accept it without a message",
    },
    group="robot",
    formats=ANY_FORMAT,
    pedantic="visuals that no reader rejects: spheres of radius 0",
)
def non_positive_dimension(robot: Robot) -> Iterator[Problem]:
    """A shape has a length of zero or less.

    Usually it is the 0 0 0 of a placeholder, or a negative difference in a macro. Readers that
    accept it neither show it nor make contact with it. MuJoCo rejects a robot with such a
    collision; for a visual it does so only with ``<compiler discardvisual="false"/>``, and without
    that a visual is a warning, or an info for a size of 0 0 0 on a frame without mass. Drake
    accepts a sphere of radius 0, but no other shape.
    """
    keeps = keeps_visuals(robot)
    for link, shape in robot.shapes:
        if shape.geometry is None:
            continue
        geometry = shape.geometry
        kind = "collision" if isinstance(shape, Collision) else "visual"
        for name in _SIZES.get(geometry.tag, ()):
            text = _get_size(geometry, name)
            one = number(text)
            values = parse_numbers(text, 3) if name == "size" else None if one is None else (one,)
            if values is None or min(values) > 0:
                continue
            rejected = kind == "collision" or keeps
            shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
            is_frame = not link.mass and not any(map(_has_extent, shapes))
            aborts = geometry.tag != "sphere" or min(values) < 0
            yield Problem(
                link,
                f"{name} of a <{geometry.tag}> in a {kind} of link '{link.name}' is {text}; "
                "lengths must be positive",
                at=geometry.locate_attribute(name),
                data={"attribute": name, "value": text, "collides": kind == "collision"},
                alike=(name, geometry.tag, kind),
                severity=ERROR if rejected else INFO if is_frame else WARNING,
                pedantic=not rejected and not aborts,
                effects=[*["mujoco"] * rejected, *["drake"] * aborts, _SILENT],
            )


def _has_extent(shape: Visual | Collision) -> bool:
    return shape.geometry is not None and has_extent(shape.geometry)


def _get_size(geometry: Geometry, name: str) -> str | None:
    """Get a length or the size of a shape as text, as written in URDF."""
    if geometry.xml is not None:
        return geometry.xml.get(name)
    value: float | tuple[float, ...] = getattr(geometry, name)
    return " ".join(f"{part:g}" for part in (value if isinstance(value, tuple) else (value,)))


_UNKNOWN_SHAPE = "urdfdom, gz, gazebo-classic, pinocchio"
_KNOWN = ("box", "cylinder", "sphere", "mesh")
_INSTEAD = {
    "plane": "a flat <box>",
    "ellipsoid": "a <sphere> or a <mesh>",
    "cone": "a <mesh>",
    "cdf": "a <mesh>",
}


@rule(
    ERROR,
    effects={
        _UNKNOWN_SHAPE: (
            "load the link without its geometry, at least from this shape on, with an error in "
            "the log"
        ),
        "pybullet": "rejects the file, except for a <plane> with a normal, which it loads",
        "drake": "rejects the file",
        "mujoco": "rejects the file",
    },
)
def unsupported_shape(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A geometry has a shape that URDF does not define.

    URDF defines box, cylinder, sphere and mesh (and capsule from version 1.1). urdfdom reports one
    line, continues, and drops all visuals and collisions of the link. A ``<plane>`` with a normal
    is an extension of PyBullet: it is an info if PyBullet is the only target, a warning without
    known targets, and an error otherwise.
    """
    keeps = keeps_visuals(robot)
    for link, shape in robot.shapes:
        geometry = shape.geometry
        if isinstance(geometry, UnknownShape) and not geometry.element.tag.startswith("drake:"):
            tag = geometry.element.tag
            rejected = keeps or isinstance(shape, Collision)
            effects = [_UNKNOWN_SHAPE, "pybullet", *["mujoco"] * rejected]
            effects += ["drake"] * (":" not in tag)
            if tag in VOCABULARY:
                message = _describe_unknown_shape(link, shape, geometry)
                yield Problem(link, message, at=geometry, effects=effects)
                continue
            if tag == "plane" and parse_numbers(geometry.element.get("normal"), 3):
                others = targets - {"pybullet"}
                yield Problem(
                    link,
                    f"only PyBullet reads the <plane> of link '{link.name}'; "
                    f"write {_INSTEAD[tag]} for other readers",
                    at=geometry,
                    severity=ERROR if others else INFO if targets else WARNING,
                    effects=effects,
                )
                continue
            yield Problem(
                link,
                _describe_unknown_shape(link, shape, geometry),
                at=geometry,
                effects=effects,
                data={"tag": tag, "suggestion": find_nearest(tag, _KNOWN)},
            )


@unsupported_shape.full
def report_every_unsupported_shape(robot: Robot) -> Iterator[Problem]:
    """Report each shape that URDF does not define, also with a namespace, and planes."""
    for link, shape in robot.shapes:
        if isinstance(shape.geometry, UnknownShape):
            message = _describe_unknown_shape(link, shape, shape.geometry)
            in_drake = shape.geometry.element.tag in ("drake:ellipsoid", "drake:capsule")
            yield Problem(link, message, at=shape.geometry, data={"is_in_drake": in_drake})


def _describe_unknown_shape(link: Link, shape: Visual | Collision, geometry: UnknownShape) -> str:
    tag = geometry.element.tag
    if tag in VOCABULARY:
        return (
            f"<geometry> in a {shape.element.tag} of link '{link.name}' begins with <{tag}>, which "
            "urdfdom reads as the shape; move it out of <geometry>"
        )
    near = find_nearest(tag, _KNOWN)
    right = _INSTEAD.get(tag, "<box>, <cylinder>, <sphere> or <mesh>")
    remedy = f"did you mean '{near}'?" if near else f"write {right}"
    return f"URDF does not define the shape <{tag}> of link '{link.name}'; {remedy}"


@unsupported_shape.fix(UNSAFE)
def write_known_shape(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested shape; move what is not a shape out of the geometry."""
    element = find_element(problem)
    if element is None:
        return None
    if element.tag in VOCABULARY and element.parent is not None:
        return move_out_of_geometry(element, element.parent)
    name = get_suggestion(problem, element.tag)
    return unsafe(f"write <{name}>", rename_element(element, name)) if name else None


_GROUND = re.compile(r"ground|floor|plane|terrain|(^|_)world(_|$)", re.IGNORECASE)


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, pybullet": "take the numbers as meters",
        "mujoco": "takes the numbers of a collision as meters; ignores a visual by default",
    },
    formats=ANY_FORMAT,
)
def shape_in_millimeters(robot: Robot) -> Iterator[Problem]:
    """A primitive shape is a thousand times too large: its lengths are in millimeters.

    URDF lengths are in meters. Shapes above ten meters may be intended; it is reported if
    another shape of the link has a thousandth of its lengths, or if the mass of the link fits a
    thousandth of the lengths and would be lighter than air in meters. Not reported is a ground,
    by its name, of a scene without a moving joint.
    """
    for link in robot.links:
        if not robot.moving_joints and _GROUND.search(link.name):
            continue
        for shape in find_shapes_in_millimeters(link):
            if shape.geometry is None:
                continue
            geometry = shape.geometry
            kind = "collision" if isinstance(shape, Collision) else "visual"
            sizes = {name: _get_size(geometry, name) or "" for name in _SIZES[geometry.tag]}
            lengths = " and ".join(f"{name} {text} m" for name, text in sizes.items())
            right = " ".join(
                f'{name}="{_divide_by_thousand(text)}"' for name, text in sizes.items()
            )
            yield Problem(
                link,
                f"<{geometry.tag}> in a {kind} of link '{link.name}' has {lengths}, probably in "
                f"millimeters; write {right}",
                at=shape.geometry,
                data=sizes,
            )


def _divide_by_thousand(text: str | None) -> str:
    """Divide numbers by a thousand."""
    return " ".join(f"{float(word) / 1000:.12g}" for word in (text or "").split())


@shape_in_millimeters.fix(UNSAFE)
def write_lengths_in_meters(problem: Problem, context: FixContext) -> Proposal | None:
    """Write a thousandth of each length."""
    element = find_element(problem)
    if element is None or is_computed(element):
        return None
    changes = [
        set_attribute(element, name, _divide_by_thousand(element.get(name)))
        for name in ("size", "radius", "length")
        if name in element.attributes
    ]
    return unsafe("write the lengths in meters", *changes)
