"""Loop-closing joints, which SDF ``<joint>`` elements in ``<gazebo>`` add to the tree of a URDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from lxml import etree

from ...model.elements import Vector
from ...model.kinematics import link_poses
from ...model.mechanism import Closure
from ...model.numbers import format_numbers_text
from ...model.pose import Pose, add, compute_dot, compute_norm, get_origin_at, make_pose, rotate
from ..common.naming import UniqueNames
from ..written import Written
from .copied import get_start, has_copies
from .structure import WORLD, Structure

KINDS = {"revolute": "connect", "continuous": "connect", "ball": "connect", "fixed": "weld"}
"""Equality constraint for each type of SDF joint; other types are reported as lost."""

STIFF = {"solimp": "0.95 0.99 0.001", "solref": "0.005 1"}
"""Softness of an equality, as in MuJoCo Menagerie for coupled fingers."""

_APART = 1e-6
"""Distance [m] of two ends of a connection that are in one place; chosen, no source."""

ARM = 0.1
"""Distance [m] of a second point along the axis of a spatial loop; chosen, no source."""


def get_softness(structure: Structure) -> dict[str, str]:
    """Return the softness of the equalities that an export makes, that of MuJoCo for an MJCF."""
    return {} if structure.robot.format == "mjcf" else STIFF


def list_loops(structure: Structure) -> list[Closure]:
    """Return the connections of a robot that can be exported."""
    return [one for one in structure.robot.closures if _get_kind(one) is not None]


def plan_closures(structure: Structure, written: Written) -> list[Closure]:
    """Return the equalities that close the loops of a robot, and report losses.

    Their parent is the child of the SDF joint, in whose frame MuJoCo has the point. A hinge of a
    spatial loop is held at two points.
    """
    names, found = UniqueNames(), []
    for closure in structure.robot.closures:
        kind = _get_kind(closure)
        if kind is None:
            _report_kind(closure, written)
        elif closure.xml is None and structure.robot.format == "mjcf":
            if has_copies(structure.robot, "equality") or _is_closed(structure, closure):
                found.append(closure)
            else:
                _report_apart(closure, written)
        else:
            _report_bounds(closure, kind, written)
            found += _plan_equalities(structure, closure, kind, names)
    return found


def _get_kind(closure: Closure) -> str | None:
    return closure.type if closure.type in KINDS.values() else KINDS.get(closure.type)


def _is_closed(structure: Structure, closure: Closure) -> bool:
    """Tell whether both ends of a connection are in one place where the joints start."""
    poses = link_poses(structure.robot, dict(get_start(structure.robot)))
    one, other = (
        (poses[link] if link in poses else _get_pose(structure, link)) @ make_pose(origin)
        for link, origin in (
            (closure.parent, closure.origin),
            (closure.child, closure.child_origin),
        )
    )
    return compute_norm((one.invert() @ other).translation) < _APART


def _report_apart(closure: Closure, written: Written) -> None:
    written.report_loss(
        "loop",
        f"connection '{closure.name}' is not exported: its ends are apart where the joints start, "
        "at which MuJoCo computes the second one",
        closure.place,
        kind="closed loop",
        name=closure.name,
    )


def _report_kind(closure: Closure, written: Written) -> None:
    written.report_loss(
        "loop",
        f"joint '{closure.name}' of <gazebo> is not exported: a loop can be closed by joints of "
        f"type {', '.join(KINDS)}, not by '{closure.type}'",
        closure.place,
        kind="gazebo",
        name=closure.name,
    )


def _report_bounds(closure: Closure, kind: str, written: Written) -> None:
    for what, lost in (("limits", closure.is_limited), ("dynamics", closure.has_dynamics)):
        if lost and kind != "weld":
            written.report_loss(
                "loop",
                f"{what} of joint '{closure.name}', which closes a loop, are not exported: MuJoCo "
                "closes it by an equality, which has none",
                closure.place,
                kind="gazebo",
                name=closure.name,
            )


def _plan_equalities(
    structure: Structure, closure: Closure, kind: str, names: UniqueNames
) -> Iterator[Closure]:
    name = names.take(closure.name or f"{closure.child}_{kind}")
    made = Closure(closure.provenance, name, kind, closure.child, closure.parent)
    start = _get_pose(structure, closure.child)
    other = _get_pose(structure, closure.parent)
    if kind == "weld":
        between = get_origin_at(start.invert() @ other, closure.provenance)
        yield replace(made, origin=between)
        return
    at = make_pose(closure.child_origin)
    points = [at.translation]
    if closure.axis is not None:
        x, y, z = rotate(at.rotation, closure.axis)
        if not _is_planar(structure, closure, (x, y, z)):
            points.append(add(points[0], (ARM * x, ARM * y, ARM * z)))
    for index, point in enumerate(points):
        own = name if index == 0 else names.take(f"{name}_axis")
        opposite = (other.invert() @ start).transform(point)
        ends = (get_origin_at(Pose(translation=one)) for one in (point, opposite))
        origin, child_origin = ends
        yield replace(made, name=own, origin=origin, child_origin=child_origin)


def _get_pose(structure: Structure, link: str) -> Pose:
    """Return the pose of a link with every joint at zero; that of the world before the root."""
    if link not in structure.robot.link:
        return make_pose(structure.robot.base.origin if structure.robot.base else None).invert()
    return structure.get_pose_at_zero(link)


def build_loop_equalities(structure: Structure) -> Iterator[etree._Element]:
    """Yield ``<connect>`` and ``<weld>`` for each equality of a plan; MJCF has its own softness."""
    softness = get_softness(structure)
    for closure in structure.robot.closures:
        bodies = {"body1": structure.get_body_name(closure.parent)}
        other = closure.child
        if other in structure.robot.link and (other != WORLD or not structure.in_world):
            bodies["body2"] = structure.get_body_name(other)
        attributes = {"name": closure.name, **bodies}
        if closure.type == "connect":
            attributes["anchor"] = format_numbers_text(make_pose(closure.origin).translation)
        if not closure.is_active:
            attributes["active"] = "false"
        yield etree.Element(closure.type, {**attributes, **softness})


def _is_planar(structure: Structure, closure: Closure, axis: Vector) -> bool:
    """Tell whether the other joints of the loop keep its axis already: all move in one plane."""
    axis = rotate(_get_pose(structure, closure.child).rotation, axis)
    paths = [_to_root(structure, link) for link in (closure.child, closure.parent)]
    for link in set(paths[0]) ^ set(paths[1]):
        joint = structure.robot.tree.get_parent_joint(link)
        if joint is None or structure.get_kind(joint) == "weld":
            continue
        if not structure.is_single(joint) or joint.axis is None:
            return False
        own = rotate(structure.get_pose_at_zero(link).rotation, joint.axis.xyz)
        along = abs(compute_dot(axis, own)) / compute_norm(own)
        if abs(along - (structure.get_kind(joint) == "hinge")) > 1e-6:
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
