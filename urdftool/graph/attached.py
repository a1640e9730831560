"""Nodes for sensors, plugins and controllers, attached to their link or joint."""

from __future__ import annotations

from ..model.elements import ControlComponent, GazeboExtension, Robot, Ros2Control, Sensor
from .figure import Edge, Figure, Node
from .formatting import escape_controls


def add_attached(
    figure: Figure, robot: Robot, links: dict[str, str], joints: dict[str, str]
) -> None:
    """Add sensors, plugins and controllers, attached to their link or joint.

    Those of the whole robot are attached to its root, or to its first link if it has no root.

    Args:
        figure: Figure to extend.
        robot: The robot.
        links: Node keys by link name.
        joints: Node keys by joint name.
    """
    tops = [*robot.tree.roots, *robot.links]
    top = links.get(tops[0].name) if tops else None
    for block in robot.gazebo:
        name = block.reference
        holder = top if name is None else links.get(name) or joints.get(name)
        if holder is None and (block.sensors or block.plugins):
            element = block.element
            missing = Node(f"missing:{name}", "missing", name or "", elements=[element])
            missing.faults.append("missing link or joint")
            holder = figure.add(missing).key
        if holder is not None:
            if name is not None:
                figure.nodes[holder].elements.append(block.element)
            _attach_block(figure, block, holder)
    for control in robot.ros2_controls:
        _attach_control(figure, control, top, links, joints)


def _attach(figure: Figure, node: Node, holder: str) -> Node:
    figure.add(node)
    figure.edges.append(Edge(holder, node.key, "holds"))
    return node


def _attach_block(figure: Figure, block: GazeboExtension, holder: str) -> None:
    for sensor in block.sensors:
        _attach(figure, _make_sensor_node(sensor), holder)
    for plugin in block.plugins:
        node = Node(f"plugin:{plugin.name}", "plugin", plugin.name, elements=[plugin.element])
        node.facts = {"filename": plugin.filename}
        node.lines.append(escape_controls(plugin.filename) or "no library")
        _attach(figure, node, holder)


def _make_sensor_node(sensor: Sensor) -> Node:
    node = Node(f"sensor:{sensor.name}", "sensor", sensor.name, elements=[sensor.element])
    node.facts = {
        "type": sensor.type,
        "plugins": [plugin.filename for plugin in sensor.plugins],
    }
    node.lines.append(
        f"{escape_controls(sensor.type)} sensor" if sensor.type else "sensor without a type"
    )
    node.lines += [escape_controls(plugin.filename) for plugin in sensor.plugins]
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
