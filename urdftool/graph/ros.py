"""The figure of ROS's ``urdf_to_graphiz``, with identical text.

Links are boxes, joints ellipses, and the edge to a joint shows its origin. The joints of a link are
sorted by name, the order in which urdfdom stores them.
"""

from __future__ import annotations

import math

from ..model.elements import Joint, Origin, Robot, Vector
from ..model.pose import quaternion_from_rpy
from .figure import Edge, Figure, Node
from .links import find_ends
from .traversal import sort_by_name, walk


def make_ros_figure(robot: Robot) -> Figure:
    """Create the figure of a robot in the style of ROS."""
    figure = Figure(robot.name, "ros")
    found = walk(robot, sort_by_name)
    keys: dict[str, str] = {}
    for link in found.links:
        keys[link.name] = figure.add(Node(link.name, "link", link.name, elements=link.sources)).key
    joints = {joint.name for joint in found.joints}
    clash = joints & keys.keys()  # urdfdom's graph has one node for both
    for joint in found.joints:
        if joint.name in clash:
            clash.discard(joint.name)
            node = figure.nodes[keys[joint.name]]
        else:
            node = figure.add(Node(joint.name, "joint", joint.name, elements=joint.sources))
        _add_edges(figure, robot, joint, node, keys)
    return figure


def _add_edges(
    figure: Figure, robot: Robot, joint: Joint, node: Node, keys: dict[str, str]
) -> None:
    parent, child = find_ends(figure, joint, keys)
    xyz = joint.origin.xyz if joint.origin is not None else (0.0, 0.0, 0.0)
    node.facts |= {"type": joint.type, "parent": joint.parent, "child": joint.child}
    figure.edges.append(
        Edge(
            parent,
            node.key,
            xyz=_format_six_digits(xyz),
            rpy=_format_six_digits(_compute_rpy(joint.origin, robot.version)),
        )
    )
    figure.edges.append(Edge(node.key, child))


def _format_six_digits(values: Vector) -> str:
    """Format numbers with six digits, as C++ streams do."""
    return " ".join(f"{value:g}" for value in values)


def _compute_rpy(origin: Origin | None, version: str | None) -> Vector:
    """Compute roll, pitch and yaw [rad] as urdfdom does from its stored quaternion.

    urdfdom reads ``quat_xyzw`` only since URDF 1.1.
    """
    if origin is None:
        x = y = z = 0.0
        w = 1.0
    elif origin.quaternion is not None and version not in (None, "1", "1.0"):
        x, y, z, w = origin.quaternion
    else:
        w, x, y, z = quaternion_from_rpy(origin.rpy)
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if length == 0.0:
        x = y = z = 0.0
        w = length = 1.0
    x, y, z, w = x / length, y / length, z / length, w / length
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    sine = -2 * (x * z - w * y) / (xx + yy + zz + ww)
    if sine <= -0.99999:
        return 0.0, -math.pi / 2, 2 * math.atan2(x, -y)
    if sine >= 0.99999:
        return 0.0, math.pi / 2, 2 * math.atan2(-x, y)
    return (
        math.atan2(2 * (y * z + w * x), ww - xx - yy + zz),
        math.asin(sine),
        math.atan2(2 * (x * y + w * z), ww + xx - yy - zz),
    )
