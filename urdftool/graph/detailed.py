"""The detailed figure: joint properties, mass and geometry of links, attached parts."""

from __future__ import annotations

from typing import Any

from ..control_characters import escape_controls
from ..model.elements import (
    Collision,
    ControlComponent,
    Geometry,
    Joint,
    Link,
    Mesh,
    Plugin,
    Robot,
    Ros2Control,
    Sensor,
    Transmission,
    UnknownShape,
    Visual,
)
from ..model.mechanism import Camera, MountedSensor
from ..model.references import list_blocks
from ..model.settings import LIMIT_NAMES, OF_LIMITS, split_unit
from ..model.shapes import get_shape_name
from .figure import Edge, Figure, Node
from .formatting import format_numbers, number
from .links import find_ends
from .traversal import walk

_AXES = {
    (1.0, 0.0, 0.0): "x",
    (0.0, 1.0, 0.0): "y",
    (0.0, 0.0, 1.0): "z",
    (-1.0, 0.0, 0.0): "-x",
    (0.0, -1.0, 0.0): "-y",
    (0.0, 0.0, -1.0): "-z",
}
_MOST_SHAPES = 4
"""Number of kinds of shapes that a node names. Chosen, no source."""


def create_detailed_figure(robot: Robot) -> Figure:
    """Create the detailed figure of a robot."""
    figure = Figure(robot.name, "detailed")
    found = walk(robot)
    transmissions = _group_transmissions(robot)
    keys: dict[str, str] = {}
    for link in found.links:
        keys[link.name] = figure.add(_make_link_node(link)).key
    joints: dict[str, str] = {}
    for joint in found.joints:
        node = figure.add(_make_joint_node(joint, transmissions.get(joint.name, [])))
        joints.setdefault(joint.name, node.key)
        _add_edges(figure, joint, node, keys)
    for joint in found.joints:
        if joint.mimic is not None and joint.mimic.joint in joints:
            figure.edges.append(Edge(joints[joint.mimic.joint], joints[joint.name], "mimic"))
    for closure in robot.closures:
        text = (
            f"{escape_controls(closure.type)} to {escape_controls(closure.parent)}, closing a loop"
        )
        figure.nodes[keys[closure.child]].lines.append(text)
    add_attached(figure, robot, keys, joints)
    return figure


def _add_edges(figure: Figure, joint: Joint, node: Node, keys: dict[str, str]) -> None:
    parent, child = find_ends(figure, joint, keys)
    xyz = rpy = ""
    if joint.origin is not None:
        xyz = format_numbers(joint.origin.xyz) if any(joint.origin.xyz) else ""
        if joint.origin.quaternion is not None:
            rpy = f"{format_numbers(joint.origin.quaternion)} (quaternion)"
        elif any(joint.origin.rpy):
            rpy = format_numbers(joint.origin.rpy)
    figure.edges.append(Edge(parent, node.key, xyz=xyz, rpy=rpy))
    figure.edges.append(Edge(node.key, child))


def _group_transmissions(robot: Robot) -> dict[str, list[Transmission]]:
    transmissions: dict[str, list[Transmission]] = {}
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            transmissions.setdefault(joint.name, []).append(transmission)
    return transmissions


def _make_link_node(link: Link) -> Node:
    node = Node(f"link:{link.name}", "link", link.name, elements=link.sources)
    node.facts = {
        "mass": link.inertial.mass if link.inertial is not None else None,
        "visuals": [_describe_shape(shape) for shape in link.visuals],
        "collisions": [_describe_shape(shape) for shape in link.collisions],
    }
    if link.is_frame:
        node.lines.append("frame")
        return node
    mass = node.facts["mass"]
    node.lines.append("no mass" if mass is None else f"{number(mass)} kg")
    for kind, shapes in (("visual", link.visuals), ("collision", link.collisions)):
        node.lines.append(f"{kind}: {_format_shapes(shapes)}" if shapes else f"no {kind}")
    return node


def _format_shapes(shapes: list[Visual] | list[Collision]) -> str:
    counts: dict[str, int] = {}
    for shape in shapes:
        name = _format_shape(shape.geometry)
        counts[name] = counts.get(name, 0) + 1
    texts = [name if count == 1 else f"{count} × {name}" for name, count in counts.items()]
    more = [f"{len(texts) - _MOST_SHAPES + 1} more"] if len(texts) > _MOST_SHAPES else []
    return ", ".join([*texts[: _MOST_SHAPES - len(more)], *more])


def _format_shape(geometry: Geometry | None) -> str:
    if geometry is None:
        return "nothing"
    if isinstance(geometry, Mesh):
        return escape_controls(geometry.filename.replace("\\", "/").rpartition("/")[2] or "mesh")
    if isinstance(geometry, UnknownShape):
        return f"<{escape_controls(geometry.tag)}>"
    return get_shape_name(geometry)


def _describe_shape(shape: Visual | Collision) -> dict[str, Any]:
    geometry = shape.geometry
    facts: dict[str, Any] = {"shape": None if geometry is None else get_shape_name(geometry)}
    if isinstance(geometry, Mesh):
        facts["filename"] = geometry.filename
    return facts


def _make_joint_node(joint: Joint, transmissions: list[Transmission]) -> Node:
    node = Node(f"joint:{joint.name}", "joint", joint.name, elements=joint.sources)
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    limit, mimic = joint.limit, joint.mimic
    node.facts = {
        "type": joint.type,
        "parent": joint.parent,
        "child": joint.child,
        "axis": list(axis) if joint.has_axis else None,
        "limit": None if limit is None else {name: getattr(limit, name) for name in LIMIT_NAMES},
        "mimic": None
        if mimic is None
        else {"joint": mimic.joint, "multiplier": mimic.multiplier, "offset": mimic.offset},
        "transmissions": [transmission.name for transmission in transmissions],
    }
    kind = escape_controls(joint.type) or "no type"
    verb = "along" if joint.type == "prismatic" else "normal to" if kind == "planar" else "about"
    node.lines.append(
        f"{kind} {verb} {_AXES.get(axis) or format_numbers(axis)}" if joint.has_axis else kind
    )
    node.lines += _format_limits(joint)
    if mimic is not None:
        offset = f" {mimic.offset:+.4g}" if mimic.offset else ""
        node.lines.append(
            f"mimics {number(mimic.multiplier)} × {escape_controls(mimic.joint)}{offset}"
        )
    for transmission in transmissions:
        node.elements += transmission.sources
        interfaces = [name for member in transmission.joints for name in member.hardware_interfaces]
        for actuator in transmission.actuators:
            interfaces += actuator.hardware_interfaces
        texts = ", ".join(
            escape_controls(name.rpartition("/")[2]) for name in dict.fromkeys(interfaces)
        )
        node.lines.append(
            f"transmission {escape_controls(transmission.name)}" + (f" ({texts})" if texts else "")
        )
    return node


def _format_limits(joint: Joint) -> list[str]:
    limit = joint.limit
    if limit is None:
        return ["no limit"] if joint.is_limited else []
    slides = joint.type == "prismatic"
    lines = []
    if joint.is_limited:
        unit = "m" if slides else "rad"
        lines.append(f"{number(limit.lower or 0.0)} … {number(limit.upper or 0.0)} {unit}")
    written = [(getattr(limit, row.name), split_unit(row.unit)[slides]) for row in OF_LIMITS]
    rates = [f"{number(value)} {unit}" for value, unit in written if value is not None]
    if rates and not joint.is_fixed:
        lines.append("at most " + ", ".join(rates))
    return lines


def add_attached(
    figure: Figure, robot: Robot, links: dict[str, str], joints: dict[str, str]
) -> None:
    """Add sensors, plugins and controllers, attached to their link or joint.

    Those of the whole robot are attached to its root, or to its first link if it has no root.
    """
    tops = [*robot.tree.roots, *robot.links]
    top = links.get(tops[0].name) if tops else None
    parts = _group_parts(robot)
    for name, element in list_blocks(robot):
        holder = top if name is None else links.get(name) or joints.get(name)
        if holder is None and parts.get(id(element)):
            missing = Node(f"missing:{name}", "missing", name or "", elements=[element])
            missing.faults.append("missing link or joint")
            holder = figure.add(missing).key
        if holder is not None:
            if name is not None:
                figure.nodes[holder].elements.append(element)
            for node in parts.get(id(element), []):
                _attach(figure, node, holder)
    mounted: list[MountedSensor | Camera] = [*robot.mounted_sensors, *robot.cameras]
    for sensor in mounted if robot.xml is None else ():
        joint = sensor.joint if isinstance(sensor, MountedSensor) else ""
        holder = joints.get(joint) or links.get(sensor.link) or top
        if holder is not None:
            _attach(figure, _make_sensor_node(sensor, []), holder)
    for control in robot.ros2_controls:
        _attach_control(figure, control, top, links, joints)


def _attach(figure: Figure, node: Node, holder: str) -> Node:
    figure.add(node)
    figure.edges.append(Edge(holder, node.key, "holds"))
    return node


def _group_parts(robot: Robot) -> dict[int, list[Node]]:
    """Return nodes of the sensors, then the plugins, of a URDF by the identity of their parent."""
    nodes: dict[int, list[Node]] = {}
    for sensor in robot.sensors:
        node = _make_sensor_node(sensor, sensor.plugins)
        nodes.setdefault(id(sensor.element.parent), []).append(node)
    for plugin in robot.plugins:
        node = Node(f"plugin:{plugin.name}", "plugin", plugin.name, elements=[plugin.element])
        node.facts = {"filename": plugin.filename}
        node.lines.append(escape_controls(plugin.filename) or "no library")
        nodes.setdefault(id(plugin.element.parent), []).append(node)
    return nodes


def _make_sensor_node(sensor: Sensor | MountedSensor | Camera, plugins: list[Plugin]) -> Node:
    node = Node(f"sensor:{sensor.name}", "sensor", sensor.name, elements=sensor.sources)
    node.facts = {"type": sensor.type, "plugins": [plugin.filename for plugin in plugins]}
    node.lines.append(
        f"{escape_controls(sensor.type)} sensor" if sensor.type else "sensor without a type"
    )
    node.lines += [escape_controls(plugin.filename) for plugin in plugins]
    return node


def _attach_control(
    figure: Figure,
    control: Ros2Control,
    top: str | None,
    links: dict[str, str],
    joints: dict[str, str],
) -> None:
    node = Node(f"controller:{control.name}", "controller", control.name)
    node.elements.append(control.element)
    node.facts = {
        "type": control.type,
        "plugin": control.plugin,
        "joints": [joint.name for joint in control.joints],
    }
    node.lines.append(f"ros2_control {escape_controls(control.type) or 'hardware'}")
    if control.plugin:
        node.lines.append(escape_controls(control.plugin))
    # hardware of a single joint is attached to it; for several joints the edges would cross
    driven = [joints[joint.name] for joint in control.joints if joint.name in joints]
    holder = driven[0] if len(set(driven)) == 1 and len(control.joints) == 1 else top
    figure.add(node)
    if holder is not None:
        figure.edges.append(Edge(holder, node.key, "holds"))
    for component in control.components:
        summary = _format_interfaces(component)
        key = joints.get(component.name) if component.kind == "joint" else None
        if key is not None:
            figure.nodes[key].lines.append(summary)
            figure.nodes[key].elements.append(component.element)
        else:
            where = "" if component.kind != "joint" else " (missing joint)"
            node.lines.append(f"{component.kind} {escape_controls(component.name)}{where}")


def _format_interfaces(component: ControlComponent) -> str:
    parts = []
    for kind, interfaces in (
        ("command", component.command_interfaces),
        ("state", component.state_interfaces),
    ):
        if interfaces:
            parts.append(
                f"{kind} {', '.join(escape_controls(interface.name) for interface in interfaces)}"
            )
    return "; ".join(parts) or "no interfaces"
