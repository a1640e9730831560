"""Comparison of two robots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ..model.elements import Joint, Link, Material, Robot
from .change import Change
from .extensions import compare_extensions
from .joints import compare_joints
from .links import link_changes
from .mechanisms import compare_mechanisms
from .renames import find_renames
from .tolerance import TOLERANCE


def compare(a: Robot, b: Robot, *, tolerance: float = TOLERANCE) -> Iterator[Change]:
    """Yield the differences from one robot to another: links, joints, then extensions.

    Order, comments and formatting are ignored, and so are equivalent notations of poses, axes and
    tensors.

    Args:
        a: The first (old) robot.
        b: The second (new) robot.
        tolerance: Tolerance as in ``closeness.TOLERANCE``.
    """
    materials = _collect_materials(a), _collect_materials(b)

    def same_link(x: Link, y: Link) -> bool:
        return next(link_changes(x, y, tolerance, materials), None) is None

    def same_joint(x: Joint, y: Joint) -> bool:
        ends = ("parent", "child", "mimic joint")
        return all(c.what in ends for c in compare_joints(x, y, tolerance, {}))

    links, joints = find_renames(a, b, same_link, same_joint)
    if a.name != b.name:
        yield Change("robot", b.name, "name", a.name, b.name, place=b.place)
    yield from _compare_presence("link", a.link, b.link, links)
    yield from _compare_presence("joint", a.joint, b.joint, joints)
    for name, link in a.link.items():
        other = b.link.get(links.get(name, name))
        if other is not None:
            yield from link_changes(link, other, tolerance, materials)
    renamed = {**joints, **links}
    for name, joint in a.joint.items():
        new = b.joint.get(joints.get(name, name))
        if new is not None:
            yield from compare_joints(joint, new, tolerance, renamed)
    yield from compare_extensions(a, b, tolerance, renamed)
    yield from compare_mechanisms(a, b, tolerance, renamed)


def _compare_presence(
    kind: str,
    a: Mapping[str, Link] | Mapping[str, Joint],
    b: Mapping[str, Link] | Mapping[str, Joint],
    renamed: Mapping[str, str],
) -> Iterator[Change]:
    """Yield renamed parts, and parts that only one robot has."""
    for old, new in renamed.items():
        yield Change(kind, new, "renamed", old, new, place=b[new].place)
    for name, part in a.items():
        if name not in b and name not in renamed:
            yield Change(kind, name, "removed", _describe_part(part), place=part.place)
    new_names = set(renamed.values())
    for name, part in b.items():
        if name not in a and name not in new_names:
            yield Change(kind, name, "added", after=_describe_part(part), place=part.place)


def _describe_part(part: Link | Joint) -> dict[str, object]:
    """Return the main properties of an added or removed part."""
    if isinstance(part, Joint):
        return {"type": part.type, "parent": part.parent, "child": part.child}
    return {"mass": part.inertial.mass if part.inertial is not None else None}


def _collect_materials(robot: Robot) -> dict[str, Material]:
    """Return named materials; definitions inside visuals are global, as in urdfdom."""
    found: dict[str, Material] = {}
    written = [v.material for link in robot.links for v in link.visuals if v.material is not None]
    for material in (*robot.materials, *written):
        if material.color is not None or material.texture is not None:
            found.setdefault(material.name, material)
    return found
