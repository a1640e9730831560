"""Loop-closing joints, which SDF ``<joint>`` elements in ``<gazebo>`` add to the tree of a URDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import GazeboExtension, Vector
from ...model.pose import IDENTITY, Pose, add, compute_dot, compute_norm, rotate, rotation_from_rpy
from ...model.read import number, parse_numbers
from ...source.document import Element
from ..common.naming import UniqueNames
from ..written import Written
from .digits import format_numbers_text
from .structure import WORLD, Structure

KINDS = {"revolute": "connect", "continuous": "connect", "ball": "connect", "fixed": "weld"}
"""Equality constraint for each type of SDF joint; other types are reported as lost."""

STIFF = {"solimp": "0.95 0.99 0.001", "solref": "0.005 1"}
"""Softness of an equality, as in MuJoCo Menagerie for coupled fingers."""

ARM = 0.1
"""Distance [m] of a second point along the axis, which constrains the axis of a spatial loop."""

UNBOUNDED = 1e15


@dataclass(frozen=True)
class Loop:
    """A joint that closes a loop.

    Attributes:
        element: The ``<joint>`` element.
        kind: Tag of its equality constraint.
        child: Name of the child link.
        parent: Name of the parent link, or ``world``.
        pose: Pose of the joint in the child's frame.
    """

    element: Element
    kind: str
    child: str
    parent: str
    pose: Pose

    @property
    def name(self) -> str:
        """Return the joint's name."""
        return self.element.get("name") or ""


def list_loops(structure: Structure) -> Iterator[Loop]:
    """Yield the loop-closing joints that can be exported."""
    for block in structure.robot.gazebo:
        for element in block.element.list_children("joint"):
            found = _read(structure, block, element)
            if isinstance(found, Loop):
                yield found


def list_loop_equalities(structure: Structure, written: Written) -> Iterator[etree._Element]:
    """Yield ``<connect>`` and ``<weld>`` for each loop-closing joint, and report losses."""
    names = UniqueNames()
    for block in structure.robot.gazebo:
        for element in block.element.list_children("joint"):
            loop = _read(structure, block, element)
            if isinstance(loop, Loop):
                _report_bounds_losses(loop, written)
                yield from _list_equalities(structure, loop, names)
            else:
                written.report_loss(
                    "loop",
                    f"joint '{element.get('name') or ''}' of <gazebo> is not exported: {loop}",
                    element.place,
                    kind="gazebo",
                    name=block.reference or "",
                )


def _read(structure: Structure, block: GazeboExtension, element: Element) -> Loop | str:
    """Read a joint; return the reason as text if it cannot be exported."""
    if block.reference is not None:
        return "a loop-closing joint must be in a <gazebo> block without reference"
    kind = KINDS.get(element.get("type") or "")
    if kind is None:
        return (
            f"a loop can be closed by joints of type {', '.join(KINDS)}, not by "
            f"'{element.get('type') or ''}'"
        )
    child, parent = _format_text(element, "child"), _format_text(element, "parent")
    # a scoped name starts with the name of the model
    child, parent = child.rpartition("::")[2], parent.rpartition("::")[2]
    known = structure.robot.link
    for end, name in (("child", child), ("parent", parent)):
        if name not in known and not (end == "parent" and name == WORLD):
            return f"its {end} '{name}' is not a link"
    if child == parent:
        return f"it connects '{child}' to itself"
    pose = _make_pose(structure, element, child)
    return pose if isinstance(pose, str) else Loop(element, kind, child, parent, pose)


def _make_pose(structure: Structure, joint: Element, child: str) -> Pose | str:
    element = joint.find_child("pose")
    if element is None:
        return IDENTITY
    values = parse_numbers(element.text, 6) or (0.0,) * 6
    turn = rotation_from_rpy((values[3], values[4], values[5]))
    pose = Pose(turn, (values[0], values[1], values[2]))
    frame = element.get("relative_to") or element.get("frame") or child
    if frame == child:
        return pose
    if frame != "__model__" and frame not in structure.robot.link:
        return f"its pose is relative to '{frame}', which is not a link"
    start = IDENTITY if frame == "__model__" else structure.get_pose_at_zero(frame)
    return structure.get_pose_at_zero(child).invert() @ start @ pose


def _list_equalities(
    structure: Structure, loop: Loop, names: UniqueNames
) -> Iterator[etree._Element]:
    bodies = {"body1": structure.get_body_name(loop.child)}
    if loop.parent in structure.robot.link and loop.parent != WORLD:
        bodies["body2"] = loop.parent
    elif loop.parent in structure.robot.link and not structure.in_world:
        bodies["body2"] = structure.get_body_name(loop.parent)
    name = names.take(loop.name or f"{loop.child}_{loop.kind}")
    if loop.kind == "weld":
        yield etree.Element("weld", {"name": name, **bodies, **STIFF})
        return
    points = [loop.pose.translation]
    if loop.element.get("type") != "ball":
        axis = _get_axis(structure, loop)
        if not _is_planar(structure, loop, axis):
            x, y, z = axis
            points.append(add(points[0], (ARM * x, ARM * y, ARM * z)))
    for index, point in enumerate(points):
        own = name if index == 0 else names.take(f"{name}_axis")
        anchor = format_numbers_text(point)
        yield etree.Element("connect", {"name": own, **bodies, "anchor": anchor, **STIFF})


def _get_axis(structure: Structure, loop: Loop) -> Vector:
    """Return the joint axis in the child's frame, of length 1."""
    axis = loop.element.find_child("axis")
    xyz = axis.find_child("xyz") if axis is not None else None
    x, y, z = parse_numbers(xyz.text if xyz is not None else "0 0 1", 3) or (0.0, 0.0, 1.0)
    length = compute_norm((x, y, z)) or 1.0
    direction = (x / length, y / length, z / length)
    old = axis is not None and _format_text(axis, "use_parent_model_frame").lower() in ("1", "true")
    if old or (xyz is not None and xyz.get("expressed_in") == "__model__"):
        return rotate(structure.get_pose_at_zero(loop.child).invert().rotation, direction)
    return rotate(loop.pose.rotation, direction)


def _is_planar(structure: Structure, loop: Loop, axis: Vector) -> bool:
    """Tell whether the other joints of the loop keep its axis already: all move in one plane."""
    axis = rotate(structure.get_pose_at_zero(loop.child).rotation, axis)
    paths = [_to_root(structure, link) for link in (loop.child, loop.parent)]
    for link in set(paths[0]) ^ set(paths[1]):
        joint = structure.robot.tree.get_parent_joint(link)
        kind = structure.get_kind(joint) if joint is not None else "weld"
        if kind == "weld" or joint is None:
            continue
        if kind not in ("hinge", "slide") or joint.axis is None:
            return False
        own = rotate(structure.get_pose_at_zero(link).rotation, joint.axis.xyz)
        along = abs(compute_dot(axis, own)) / compute_norm(own)
        if abs(along - (1.0 if kind == "hinge" else 0.0)) > 1e-6:
            return False
    return True


def _to_root(structure: Structure, link: str) -> list[str]:
    path = []
    while link in structure.robot.link:
        path.append(link)
        joint = structure.robot.tree.get_parent_joint(link)
        if joint is None:
            break
        link = joint.parent
    return path


def _report_bounds_losses(loop: Loop, written: Written) -> None:
    axis = loop.element.find_child("axis")
    if axis is None or loop.kind == "weld":
        return
    limit, dynamics = axis.find_child("limit"), axis.find_child("dynamics")
    bounds = (
        [number(_format_text(limit, end)) for end in ("lower", "upper")]
        if limit is not None
        else []
    )
    rubs = (
        [number(_format_text(dynamics, tag)) for tag in ("damping", "friction", "spring_stiffness")]
        if dynamics is not None
        else []
    )
    for what, lost, part in (
        ("limits", any(b is not None and abs(b) < UNBOUNDED for b in bounds), limit),
        ("dynamics", any(rubs), dynamics),
    ):
        if lost and part is not None:
            written.report_loss(
                "loop",
                f"{what} of joint '{loop.name}', which closes a loop, are not exported: MuJoCo "
                "closes it by an equality, which has none",
                part.place,
                kind="gazebo",
                name=loop.name,
                severity=Severity.WARNING,
            )


def _format_text(element: Element, tag: str) -> str:
    child = element.find_child(tag)
    return child.text.strip() if child is not None else ""
