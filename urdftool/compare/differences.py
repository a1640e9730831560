"""Comparison of two robots."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from ..model.angles import restore_angle
from ..model.elements import Joint, Link, Robot, Vector
from ..model.pose import compute_norm, make_restored_pose
from .change import Change
from .changed_settings import compare_settings
from .extensions import compare_extensions
from .links import describe_pose, link_changes
from .mechanisms import compare_mechanisms
from .native import are_of_one_format, compare_native
from .tolerance import TOLERANCE, are_close, close, format_motion, is_same_pose


def compare(a: Robot, b: Robot, *, tolerance: float = TOLERANCE) -> Iterator[Change]:
    """Yield the differences from one robot to another: links, joints, then extensions.

    Order, comments and formatting are ignored, and so are equivalent notations of poses, axes and
    tensors.

    Args:
        a: The first (old) robot.
        b: The second (new) robot.
        tolerance: Tolerance as in ``closeness.TOLERANCE``.
    """
    robots = a, b

    def same_link(x: Link, y: Link) -> bool:
        return next(link_changes(x, y, tolerance, robots), None) is None

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
            yield from link_changes(link, other, tolerance, robots)
    renamed = {**joints, **links}
    for name, joint in a.joint.items():
        new = b.joint.get(joints.get(name, name))
        if new is not None:
            yield from compare_joints(joint, new, tolerance, renamed)
    yield from compare_extensions(a, b, tolerance, renamed)
    yield from compare_settings(a, b, tolerance, renamed)
    yield from compare_mechanisms(a, b, tolerance, renamed)
    if are_of_one_format(a, b):
        yield from compare_native(a.native, b.native, tolerance, renamed)


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


SameLink = Callable[[Link, Link], bool]
SameJoint = Callable[[Joint, Joint], bool]


def find_renames(
    a: Robot, b: Robot, same_link: SameLink, same_joint: SameJoint
) -> tuple[dict[str, str], dict[str, str]]:
    """Return the new names of renamed links and of renamed joints, by old names.

    A link is renamed if a new link has the same parent and is equal, and so is its parent joint. A
    joint is renamed if an equal new joint connects the same links.

    Args:
        a: The first robot.
        b: The second robot.
        same_link: Tells whether two links are equal except for their names.
        same_joint: Tells whether two joints are equal except for their names and links.
    """
    links: dict[str, str] = {}
    joints: dict[str, str] = {}
    taken: set[str] = set()
    for name in a.tree.order:
        if name in b.link:
            continue
        joint = a.tree.get_parent_joint(name)
        for other, link in _list_replacements(a, b, name, joint, links):
            if link.name in a.link or link.name in taken or not same_link(a.link[name], link):
                continue
            if joint is None or other is None:
                if joint is not other:
                    continue
            elif not same_joint(joint, other):
                continue
            links[name] = link.name
            taken.add(link.name)
            break
    for joint in a.joints:
        ends = links.get(joint.parent, joint.parent), links.get(joint.child, joint.child)
        if joint.name in b.joint:
            continue
        for other in b.tree.joints_of_child.get(ends[1], []):
            new = other.name not in a.joint and other.name not in joints.values()
            if new and other.parent == ends[0] and same_joint(joint, other):
                joints[joint.name] = other.name
                break
    return links, joints


def _list_replacements(
    a: Robot, b: Robot, name: str, joint: Joint | None, links: dict[str, str]
) -> Iterator[tuple[Joint | None, Link]]:
    """Yield joints and links of the second robot with the same parent as a link of the first."""
    if joint is None:
        yield from ((None, link) for link in b.tree.roots)
        return
    parent = links.get(joint.parent, joint.parent)
    below = b.tree.get_child_joints(parent)
    for other in sorted(below, key=lambda other: other.name != joint.name):
        if other.child in b.link:
            yield other, b.link[other.child]


_X: Vector = (1.0, 0.0, 0.0)


def compare_joints(
    a: Joint, b: Joint, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    """Yield the differences of a joint.

    Args:
        a: The joint in the first robot.
        b: The joint in the second.
        tolerance: Tolerance as in ``closeness.TOLERANCE``.
        renamed: New names of links and joints by old names.
    """

    def change(
        what: str, before: object, after: object, unit: str = "", remark: str = ""
    ) -> Change:
        part = getattr(b, what.partition(" ")[0], None)
        place = getattr(part, "place", None) or b.place
        return Change("joint", b.name, what, before, after, unit, remark, place)

    for what in ("type", "parent", "child"):
        before, after = getattr(a, what), getattr(b, what)
        if (before if what == "type" else renamed.get(before, before)) != after:
            yield change(what, before, after)
    one, two = make_restored_pose(a.origin), make_restored_pose(b.origin)
    if not is_same_pose(one, two, tolerance):
        yield change("origin", describe_pose(one), describe_pose(two), "", format_motion(one, two))
    if a.has_axis and b.has_axis:
        x, y = _get_axis(a), _get_axis(b)
        if not are_close(x, y, max(tolerance, 1e-12)):
            opposite = are_close(x, (-y[0], -y[1], -y[2]), max(tolerance, 1e-12))
            yield change("axis", x, y, "", "opposite direction" if opposite else "")
    yield from _compare_numbers(a, b, tolerance, renamed)


def _get_axis(joint: Joint) -> Vector:
    """Return the axis, normalized unless it is zero."""
    x, y, z = joint.axis.xyz if joint.axis is not None else _X
    length = compute_norm((x, y, z)) or 1.0
    return x / length, y / length, z / length


def _restore(value: float | None) -> float | None:
    return None if value is None else restore_angle(value)


def _compare_numbers(
    a: Joint, b: Joint, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    slides = b.type == "prismatic"
    here, force, rate = ("m", "N", "m/s") if slides else ("rad", "N·m", "rad/s")
    units = {
        "limit": {"lower": here, "upper": here, "effort": force, "velocity": rate},
        "dynamics": {
            "damping": "N·s/m" if slides else "N·m·s/rad",
            "friction": force,
            "armature": "kg" if slides else "kg·m²",
        },
        "mimic": {"joint": "", "multiplier": "", "offset": here},
        "safety_controller": {
            "soft_lower_limit": here,
            "soft_upper_limit": here,
            "k_position": "",
            "k_velocity": "",
        },
        "calibration": {"rising": here, "falling": here, "reference_position": here},
    }
    for part, properties in units.items():
        one, two = getattr(a, part), getattr(b, part)
        place = b.place if two is None else two.place
        for name, unit in properties.items():
            before = None if one is None else getattr(one, name)
            after = None if two is None else getattr(two, name)
            if part == "limit" and name in ("lower", "upper") and a.is_limited and b.is_limited:
                before, after = before or 0.0, after or 0.0  # default of readers
            if isinstance(before, str) or isinstance(after, str):
                same = renamed.get(before or "", before) == after
            else:
                same = close(before, after, tolerance) or (
                    unit == "rad" and close(_restore(before), _restore(after), tolerance)
                )
            if not same:
                what = f"{part.replace('_', ' ')} {name.replace('_', ' ')}"
                yield Change("joint", b.name, what, before, after, unit, "", place)
