"""Conversion of an XML document to a robot.

It never fails: values that cannot be parsed are omitted or get their default.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from ..model.link import COMPONENTS
from ..source.document import Element
from .appearance import add_appearance
from .blocks import add_blocks
from .elements import (
    Actuator,
    Axis,
    Box,
    Calibration,
    Capsule,
    Collision,
    ControlComponent,
    Cylinder,
    Dynamics,
    GazeboExtension,
    Geometry,
    Inertia,
    Inertial,
    Interface,
    Joint,
    Limit,
    Link,
    Material,
    Mesh,
    Mimic,
    Origin,
    Plugin,
    Robot,
    Ros2Control,
    SafetyController,
    Sensor,
    Sphere,
    Transmission,
    TransmissionJoint,
    UnknownShape,
    Vector,
    Visual,
)
from .mujoco_values import list_rejected
from .native import list_block_elements
from .numbers import number as number
from .numbers import parse_numbers as parse_numbers
from .read_settings import add_settings
from .settings import LIMIT_NAMES, RESISTANCE_OF_URDF
from .shapes import collect_content
from .world_settings import read_options

_T = TypeVar("_T")


def _parse_vector(text: str | None, default: Vector = (0.0, 0.0, 0.0)) -> Vector:
    values = parse_numbers(text, 3) if text is not None else None
    return default if values is None else values  # type: ignore[return-value]


def _number(element: Element, name: str, default: float = 0.0) -> float:
    value = number(element.attributes.get(name))
    return default if value is None else value


def _read_optional(element: Element | None, read: Callable[[Element], _T]) -> _T | None:
    return None if element is None else read(element)


def read_robot(root: Element) -> Robot:
    """Return the robot of a ``<robot>`` element."""
    robot = Robot(root, root.get("name") or "", root.get("version"))
    readers: dict[str, Callable[[Element], None]] = {
        "link": lambda e: robot.links.append(_link(e)),
        "joint": lambda e: robot.joints.append(_read_joint(e)),
        "material": lambda e: robot.materials.append(_read_material(e)),
        "transmission": lambda e: robot.transmissions.append(_read_transmission(e)),
        "gazebo": lambda e: robot.gazebo.append(_read_gazebo(e)),
        "ros2_control": lambda e: robot.ros2_controls.append(_read_ros2_control(e)),
    }
    for child in root.children:
        reader = readers.get(child.tag)
        if reader is not None:
            reader(child)
    robot.world = read_options(root.list_children("mujoco"))
    add_settings(robot)
    robot.rejected_settings += list_rejected(robot)
    add_blocks(robot)
    add_appearance(robot)
    robot.native = list(list_block_elements(robot))
    robot.memo.clear()  # callers may change the parts
    return robot


def _link(element: Element) -> Link:
    link = Link(element, element.attributes.get("name", ""))
    for child in element.children:
        tag = child.tag
        if tag == "visual":
            link.visuals.append(_read_visual(child))
        elif tag == "collision":
            link.collisions.append(_read_collision(child))
        elif tag == "inertial" and link.inertial is None:
            link.inertial = _read_inertial(child)
    return link


def _read_inertial(element: Element) -> Inertial:
    inertial = Inertial(element)
    for child in element.children:
        tag = child.tag
        if tag == "mass" and inertial.mass is None:
            inertial.mass = number(child.attributes.get("value"))
        elif tag == "inertia" and inertial.inertia is None:
            inertial.inertia = Inertia(
                child,
                *(_number(child, n) for n in COMPONENTS),
            )
        elif tag == "origin" and inertial.origin is None:
            inertial.origin = _read_origin(child)
    return inertial


def _read_origin(element: Element) -> Origin:
    attributes = element.attributes
    origin = Origin(
        element, _parse_vector(attributes.get("xyz")), _parse_vector(attributes.get("rpy"))
    )
    if "quat_xyzw" in attributes:
        origin.quaternion = parse_numbers(attributes["quat_xyzw"], 4)  # type: ignore[assignment]
    return origin


def _read_visual(element: Element) -> Visual:
    return Visual(
        element,
        element.attributes.get("name"),
        _read_optional(element.find_child("origin"), _read_origin),
        _read_geometry(element.find_child("geometry")),
        _read_optional(element.find_child("material"), _read_material),
    )


def _read_collision(element: Element) -> Collision:
    return Collision(
        element,
        element.attributes.get("name"),
        _read_optional(element.find_child("origin"), _read_origin),
        _read_geometry(element.find_child("geometry")),
    )


_SHAPES: dict[str, Callable[[Element], Geometry]] = {
    "box": lambda e: Box(e, _parse_vector(e.get("size"))),
    "cylinder": lambda e: Cylinder(e, _number(e, "radius"), _number(e, "length")),
    "sphere": lambda e: Sphere(e, _number(e, "radius")),
    "capsule": lambda e: Capsule(e, _number(e, "radius"), _number(e, "length")),
    "mesh": lambda e: Mesh(
        e, e.get("filename") or "", _parse_vector(e.get("scale"), (1.0, 1.0, 1.0))
    ),
}


def _read_geometry(element: Element | None) -> Geometry | None:
    """Return the first shape of a ``<geometry>``, as URDF readers do."""
    if element is None or not element.children:
        return None
    shape = element.children[0]
    read = _SHAPES.get(shape.tag)
    return UnknownShape(shape, shape.tag, collect_content(shape)) if read is None else read(shape)


def _read_material(element: Element) -> Material:
    material = Material(element, element.attributes.get("name", ""))
    color, texture = element.find_child("color"), element.find_child("texture")
    if color is not None:
        material.color = parse_numbers(color.get("rgba"), 4)  # type: ignore[assignment]
    if texture is not None:
        material.texture = texture.get("filename")
    return material


def _read_joint(element: Element) -> Joint:
    attributes = element.attributes
    joint = Joint(element, attributes.get("name", ""), attributes.get("type", ""))
    for child in element.children:
        reader = _JOINT_READERS.get(child.tag)
        if reader is not None:
            reader(joint, child)
    return joint


def _set_parent(joint: Joint, element: Element) -> None:
    if joint.parent_element is None:
        joint.parent_element = element
        joint.parent = element.get("link") or ""


def _set_child(joint: Joint, element: Element) -> None:
    if joint.child_element is None:
        joint.child_element = element
        joint.child = element.get("link") or ""


def _limit(element: Element) -> Limit:
    return Limit(element, *(number(element.attributes.get(name)) for name in LIMIT_NAMES))


def _set_once(name: str, read: Callable[[Element], object]) -> Callable[[Joint, Element], None]:
    def setter(joint: Joint, element: Element) -> None:
        if getattr(joint, name) is None:
            setattr(joint, name, read(element))

    return setter


_JOINT_READERS: dict[str, Callable[[Joint, Element], None]] = {
    "parent": _set_parent,
    "child": _set_child,
    "origin": _set_once("origin", _read_origin),
    "axis": _set_once("axis", lambda e: Axis(e, _parse_vector(e.get("xyz"), (1.0, 0.0, 0.0)))),
    "limit": _set_once("limit", _limit),
    "dynamics": _set_once(
        "dynamics",
        lambda e: Dynamics(e, **{name: number(e.get(name)) for name in RESISTANCE_OF_URDF}),
    ),
    "mimic": _set_once(
        "mimic",
        lambda e: Mimic(
            e, e.get("joint") or "", _number(e, "multiplier", 1.0), _number(e, "offset")
        ),
    ),
    "safety_controller": _set_once(
        "safety_controller",
        lambda e: SafetyController(
            e,
            _number(e, "soft_lower_limit"),
            _number(e, "soft_upper_limit"),
            _number(e, "k_position"),
            number(e.get("k_velocity")),
        ),
    ),
    "calibration": _set_once(
        "calibration",
        lambda e: Calibration(
            e, *(number(e.get(name)) for name in ("rising", "falling", "reference_position"))
        ),
    ),
}


def _read_transmission(element: Element) -> Transmission:
    kind = element.find_child("type")
    return Transmission(
        element,
        element.get("name") or "",
        (element.get("type") or (kind.text if kind is not None else "")).strip(),
        [
            TransmissionJoint(e, e.get("name") or "", _list_texts(e, "hardwareInterface"))
            for e in element.list_children("joint")
        ],
        [
            Actuator(
                e,
                e.get("name") or "",
                number(next(iter(_list_texts(e, "mechanicalReduction")), None)),
                _list_texts(e, "hardwareInterface"),
            )
            for e in element.list_children("actuator")
        ],
    )


def _list_texts(element: Element, tag: str) -> list[str]:
    return [child.text.strip() for child in element.list_children(tag)]


def _read_gazebo(element: Element) -> GazeboExtension:
    reference = element.get("reference")
    return GazeboExtension(
        element,
        reference,
        [
            Sensor(
                e,
                e.get("name") or "",
                (e.get("type") or "").strip(),
                _read_plugins(e, reference),
                reference,
            )
            for e in element.list_children("sensor")
        ],
        _read_plugins(element, reference),
    )


def _read_plugins(element: Element, reference: str | None) -> list[Plugin]:
    return [
        Plugin(e, e.get("name") or "", (e.get("filename") or "").strip(), reference)
        for e in element.list_children("plugin")
    ]


def _read_ros2_control(element: Element) -> Ros2Control:
    hardware = element.find_child("hardware")
    plugin = hardware.find_child("plugin") if hardware is not None else None
    return Ros2Control(
        element,
        element.get("name") or "",
        element.get("type") or "",
        plugin.text.strip() if plugin is not None else None,
        [
            ControlComponent(
                e,
                e.tag,
                e.get("name") or "",
                e.get("mimic"),
                _read_interfaces(e, "command_interface"),
                _read_interfaces(e, "state_interface"),
                _read_parameters(e),
            )
            for e in element.children
            if e.tag in ("joint", "sensor", "gpio")
        ],
    )


def _read_interfaces(element: Element, tag: str) -> list[Interface]:
    return [
        Interface(e, e.get("name") or "", _read_parameters(e)) for e in element.list_children(tag)
    ]


def _read_parameters(element: Element) -> dict[str, str]:
    return {e.get("name") or "": e.text.strip() for e in element.list_children("param")}
