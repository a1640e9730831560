"""Comparison of two descriptions as they are written, part by part, for ``diff``.

Unlike ``compare.compare_robots``, it takes links and joints by their names, in their own frames, so
that robots that form no tree can be compared, and a body with other frames is not the same.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping

from ..errors import ModelError
from ..model.angles import restore_angle
from ..model.elements import Joint, Link, Robot, Vector
from ..model.pose import compute_norm, make_restored_pose
from .bodies import LEAST_AXIS, compute_axis
from .compare import compare_robots
from .difference import EXISTENCE, RENAMED, Difference, describe_change
from .extensions import compare_extensions
from .joints import list_values
from .links import collect_pose_values, compare_links
from .mechanisms import compare_mechanisms
from .native import are_of_one_format, compare_native
from .rows import ROWS
from .settings import compare_written_settings
from .tolerance import TOLERANCE, are_close, close, format_motion, is_same_pose


def compare(a: Robot, b: Robot, *, tolerance: float = TOLERANCE) -> Iterator[Difference]:
    """Yield the differences from one robot to another: links, joints, then extensions.

    Order, comments and formatting are ignored, and so are equivalent notations of poses and
    tensors.

    ``tolerance`` is as in ``tolerance.TOLERANCE``.
    """
    robots = a, b

    def same_link(x: Link, y: Link) -> bool:
        return next(compare_links(x, y, tolerance, robots), None) is None

    def same_joint(x: Joint, y: Joint) -> bool:
        ends = ("parent", "child", "mimic joint")
        return all(c.what in ends for c in compare_joints(x, y, tolerance, {}))

    links, joints = find_renames(a, b, same_link, same_joint)
    if a.name != b.name:
        yield describe_change("tree", "robot", b.name, "name", (a.name, b.name), (a, b))
    yield from _compare_presence("link", a.link, b.link, links)
    yield from _compare_presence("joint", a.joint, b.joint, joints)
    for name, link in a.link.items():
        other = b.link.get(links.get(name, name))
        if other is not None:
            yield from compare_links(link, other, tolerance, robots)
    renamed = {**joints, **links}
    for name, joint in a.joint.items():
        new = b.joint.get(joints.get(name, name))
        if new is not None:
            yield from compare_joints(joint, new, tolerance, renamed)
            if a.format == b.format:  # a writer of another format may normalize it
                yield from _compare_axis_length(joint, new)
    yield from compare_extensions(a, b, tolerance, renamed)
    yield from compare_written_settings(a, b, tolerance, renamed)
    yield from compare_mechanisms(a, b, tolerance, renamed)
    if are_of_one_format(a, b):
        yield from compare_native(a.native, b.native, tolerance, renamed)
    if a.format != b.format:
        yield from _compare_whole(a, b, tolerance, _OF_ALL_FORMATS)
    elif a.xml is None:
        yield from _compare_pose(a, b, tolerance)
        yield from _compare_whole(a, b, tolerance, _OF_THE_WHOLE)


def _compare_pose(a: Robot, b: Robot, tolerance: float) -> Iterator[Difference]:
    """Yield the difference of the poses of both robots in their worlds, such as of a model."""
    if a.base is None or b.base is None or a.tree.root is None or b.tree.root is None:
        return
    one, two = make_restored_pose(a.base.origin), make_restored_pose(b.base.origin)
    if not is_same_pose(one, two, tolerance):
        values, note = (collect_pose_values(one), collect_pose_values(two)), format_motion(one, two)
        name, sides = b.tree.root.name, (a.base, b.base)
        yield describe_change("base", "link", name, "pose in the world", values, sides, note=note)


def _compare_whole(
    a: Robot, b: Robot, tolerance: float, names: Container[str]
) -> Iterator[Difference]:
    """Yield the differences of base, world and looks, and of settings of whole robots.

    They are those of ``compare.compare_robots``, which needs trees; in robots that form none, only
    their parts are compared. In two URDF they are elements of blocks.
    """
    rows = [row._replace(tolerance=min(row.tolerance, tolerance)) for row in ROWS]
    try:
        found = compare_robots(a, b, rows=[row for row in rows if row.name in names])
    except ModelError:
        return
    for difference in found.differences:
        if difference.row != "link flags" or difference.kind == "robot":
            yield difference


def _compare_presence(
    kind: str,
    a: Mapping[str, Link] | Mapping[str, Joint],
    b: Mapping[str, Link] | Mapping[str, Joint],
    renamed: Mapping[str, str],
) -> Iterator[Difference]:
    """Yield renamed parts, and parts that only one robot has."""
    for old, new in renamed.items():
        yield describe_change("tree", kind, new, RENAMED, (old, new), (a[old], b[new]))
    new_names = set(renamed.values())
    for name, part in a.items():
        if name not in b and name not in renamed:
            facts = _describe_part(part)
            yield describe_change("tree", kind, name, EXISTENCE, (facts, None), (part, None))
    for name, part in b.items():
        if name not in a and name not in new_names:
            facts = _describe_part(part)
            yield describe_change("tree", kind, name, EXISTENCE, (None, facts), (None, part))


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


_OF_THE_WHOLE = frozenset(("base", "world", "looks", "link flags"))
"""Rows that hold what no link and no joint has, or only the comparison of equal visuals finds."""

_OF_ALL_FORMATS = ("world",)
"""Those that are compared in two formats."""

_AXIS_LENGTH = 1e-2
"""Relative difference of lengths of axes above rounding, as of 0.577 0.577 0.577; chosen."""


def compare_joints(
    a: Joint, b: Joint, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Difference]:
    """Yield the differences of a joint."""
    for what in ("type", "parent", "child"):
        before, after = getattr(a, what), getattr(b, what)
        if (before if what == "type" else renamed.get(before, before)) != after:
            yield describe_change("tree", "joint", b.name, what, (before, after), (a, b))
    one, two = make_restored_pose(a.origin), make_restored_pose(b.origin)
    if not is_same_pose(one, two, tolerance):
        values, sides = (
            (collect_pose_values(one), collect_pose_values(two)),
            (a.origin or a, b.origin or b),
        )
        note = format_motion(one, two)
        yield describe_change("frames", "joint", b.name, "origin", values, sides, note=note)
    if a.has_direction and b.has_direction:
        x, y = _get_axis(a), _get_axis(b)
        if not are_close(x, y, max(tolerance, 1e-12)):
            opposite = are_close(x, (-y[0], -y[1], -y[2]), max(tolerance, 1e-12))
            note, parts = "opposite direction" if opposite else "", (a.axis or a, b.axis or b)
            yield describe_change("axes", "joint", b.name, "axis", (x, y), parts, note=note)
    yield from _compare_values(a, b, tolerance, renamed)


def _compare_axis_length(a: Joint, b: Joint) -> Iterator[Difference]:
    lengths = _get_axis_length(a), _get_axis_length(b)
    if a.has_direction and b.has_direction and not close(*lengths, _AXIS_LENGTH):
        note, parts = "PyBullet does not normalize it", (a.axis or a, b.axis or b)
        yield describe_change("axes", "joint", b.name, "axis length", lengths, parts, note=note)


def _get_axis(joint: Joint) -> Vector:
    """Return the axis, normalized unless it is zero."""
    x, y, z = compute_axis(joint).tolist()
    return x, y, z


def _get_axis_length(joint: Joint) -> float:
    """Return the length of the axis as it is written; 1 if it has no direction."""
    length = compute_norm(joint.axis.xyz) if joint.axis is not None else 1.0
    return length if length >= LEAST_AXIS else 1.0


def _restore(value: float | None) -> float | None:
    return None if value is None else restore_angle(value)


_ROW_OF = {
    "limit": "limits",
    "dynamics": "joint physics",
    "mimic": "tree",
    "safety_controller": "limits",
    "calibration": "limits",
}


def _compare_values(
    a: Joint, b: Joint, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Difference]:
    for value in list_values(a, b):
        x, y = value.values
        if value.name in ("lower", "upper") and a.is_limited and b.is_limited:
            x, y = x or 0.0, y or 0.0  # default of readers
        if isinstance(x, str) or isinstance(y, str):
            same = renamed.get(str(x), x) == y
        else:
            same = close(x, y, tolerance) or (
                value.unit == "rad" and close(_restore(x), _restore(y), tolerance)
            )
        if not same:
            owners = value.owners[0] or a, value.owners[1] or b
            row = _ROW_OF[value.part]
            yield describe_change(row, "joint", b.name, value.what, (x, y), owners, value.unit)
