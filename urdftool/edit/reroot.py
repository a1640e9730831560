"""Another root link: joints on the way are turned round, and no link frame moves.

A joint that is turned round moves a link without mass at its axis, to which its old parent is
fixed. A comment after the fixed joint keeps what was written, so that the way back is exact.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..errors import ModelError
from ..model.elements import Joint, Link
from ..model.kinematics import MOVABLE
from ..model.numbers import parse_numbers
from ..model.pose import IDENTITY, Pose, make_pose, rotation_from_rpy
from ..model.world import WORLD
from ..rules.moveit.semantic import find_references
from ..source.document import Comment, Element
from ..source.edit import Edit
from .around import YamlDraft
from .closed_loops import check_loops
from .draft import Draft, TextDraft, is_identity
from .inclusion import quote
from .numbers import format_rotation, format_vector, is_same_pose
from .positions import negate_axis
from .references import list_gazebo_blocks

MARK = " urdftool root, joint "
"""Text of the comment after a joint that was turned round, before its name and what was written."""

_RESTORED = 1e-11
"""Difference [m, elements of the rotation] up to which a joint is as it was turned round.

Chosen, no source: above the rounding of two inversions, far below what a person changes.
"""

_KEPT = re.compile(rf"{MARK}'([^']*)' had (.*) ", re.DOTALL)


def take_root(draft: Draft, name: str, *, move_frames: bool = False) -> None:
    """Make another link the root.

    ``move_frames`` moves the frames of links on the way to their joints, without links at axes.

    Raises:
        ModelError: The link does not exist or is one that this operation made, or a joint on the
            way cannot be turned round.
    """
    robot = draft.robot
    link = draft.find_link(name)
    old = robot.tree.roots[0].name
    draft.declare("root", old, name)
    turned = {} if move_frames else _find_turned(draft)
    if any(entry.middle == name for entry in turned.values()):
        raise ModelError(
            f"link '{name}' is at the axis of a joint that was turned round; choose another link",
            at=link.place,
        )
    path = list(_list_path(draft, name))
    skipped = {entry.fixed.name for entry in turned.values() if entry.fixed}
    if move_frames:
        turn_with_frames(draft, path)
    for joint in () if move_frames else path:
        entry = turned.get(joint.name)
        if entry is not None:
            _turn_back(draft, joint, entry)
        elif joint.name not in skipped:
            _turn_round(draft, joint)
    for file in draft.around:
        if not isinstance(file, YamlDraft):
            _check_semantics(draft, file, old, name)
    _report_base(draft, old, name)


def _list_path(draft: Draft, name: str) -> Iterator[Joint]:
    """Yield the joints from a link up to the root."""
    tree = draft.robot.tree
    while (joint := tree.get_parent_joint(name)) is not None:
        if joint.type not in (*MOVABLE, "fixed"):
            raise ModelError(
                f"{joint.type} joint '{joint.name}' is on the way to the new root; "
                "it cannot be turned round",
                at=joint.place,
            )
        yield joint
        name = joint.parent


class _Turned(NamedTuple):
    """A joint that was turned round before.

    Attributes:
        middle: Link at the axis; empty for a fixed joint.
        fixed: Joint that carries the old parent; None for a fixed joint.
        comment: Comment that keeps what was written.
        texts: The ``<origin>`` and ``<axis>`` as they were written.
    """

    middle: str
    fixed: Joint | None
    comment: Comment
    texts: str


def _find_turned(draft: Draft) -> dict[str, _Turned]:
    """Return the joints that were turned round before, if nothing was changed since."""
    found = {}
    for comment in draft.source.document.comments:
        match = _KEPT.fullmatch(comment.text)
        joint = draft.robot.joint.get(match[1]) if match else None
        if joint is None or match is None:
            continue
        before = _parse_pose(match[2])
        if joint.is_fixed or is_identity(before):
            if is_same_pose(make_pose(joint.origin).invert(), before, _RESTORED):
                found[joint.name] = _Turned("", None, comment, match[2])
            continue
        below = draft.robot.tree.get_child_joints(joint.child)
        middle = draft.robot.link.get(joint.child)
        if middle is None or not middle.is_frame or len(below) != 1 or not below[0].is_fixed:
            continue
        if is_same_pose(make_pose(below[0].origin).invert(), before, _RESTORED):
            found[joint.name] = _Turned(joint.child, below[0], comment, match[2])
    return found


_TAG = re.compile(r"<(origin|axis)\b[^<>]*>")
_ATTRIBUTE = re.compile(r"""(\w+)\s*=\s*["']([^"']*)["']""")


def _parse_pose(text: str) -> Pose:
    tag = next((m[0] for m in _TAG.finditer(text) if m[1] == "origin"), "")
    values = dict(_ATTRIBUTE.findall(tag))
    x, y, z = parse_numbers(values.get("xyz"), 3) or (0.0, 0.0, 0.0)
    roll, pitch, yaw = parse_numbers(values.get("rpy"), 3) or (0.0, 0.0, 0.0)
    return Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))


def _turn_round(draft: Draft, joint: Joint) -> None:
    """Exchange parent and child of a joint."""
    pose = make_pose(joint.origin)
    written = _describe_written(draft, joint)
    if joint.is_fixed or is_identity(pose):
        set_links(draft, joint, joint.child, joint.parent)
        if not joint.is_fixed:
            negate_axis(draft, joint)
            if joint.axis is None:
                _append_comment(draft, joint, f"{MARK}'{joint.name}' had {written} ")
        elif not is_identity(pose):
            draft.set_pose(joint.element, joint.origin, pose.invert())
            _append_comment(draft, joint, f"{MARK}'{joint.name}' had {written} ")
        return
    middle = _find_free_name(draft, f"{joint.parent}__{joint.name}")
    set_links(draft, joint, joint.child, middle)
    negate_axis(draft, joint)
    assert joint.origin is not None
    _drop_element(draft, joint.origin.element)
    back = pose.invert()
    xyz, rpy = format_vector(back.translation), format_rotation(back.rotation)
    _insert_after(
        draft,
        joint.element,
        [
            f'<link name="{quote(middle)}"/>',
            f'<joint name="{quote(middle)}_fixed" type="fixed">',
            f'\t<parent link="{quote(middle)}"/>',
            f'\t<child link="{quote(joint.parent)}"/>',
            f'\t<origin xyz="{xyz}" rpy="{rpy}"/>',
            "</joint>",
            f"<!--{MARK}'{joint.name}' had {written} -->",
        ],
    )


def _find_free_name(draft: Draft, name: str) -> str:
    while name in draft.robot.link or f"{name}_fixed" in draft.robot.joint:
        name += "_"
    return name


def _describe_written(draft: Draft, joint: Joint) -> str:
    """Return the bytes of origin and axis, with the spaces before them, in one line each."""
    parts = (
        None if joint.origin is None else joint.origin.xml,
        None if joint.axis is None else joint.axis.xml,
    )
    texts = []
    for tag, element in zip(("origin", "axis"), parts, strict=True):
        if element is None:
            texts.append(f"no {tag}")
            continue
        data = _decode(draft, element)
        if "--" in data:
            raise ModelError(f"<{tag}> has two signs in a row", at=element.place)
        texts.append(data)
    return " and ".join(texts)


def _decode(draft: Draft, element: Element) -> str:
    encoding = draft.source.document.file.encoding
    return draft.file.data[element.start : element.end].decode(encoding)


def _drop_element(draft: Draft, element: Element) -> None:
    """Write an identity in place of an ``<origin>``, which stays so that it can be written back."""
    for name in ("xyz", "rpy"):
        if element.get(name) is not None:
            draft.set(element, name, "0 0 0")
    draft.remove_attribute(element, "quat_xyzw")


def _append_comment(draft: Draft, joint: Joint, text: str) -> None:
    _insert_after(draft, joint.element, [f"<!--{text}-->"])


def _insert_after(draft: Draft, element: Element, lines: list[str]) -> None:
    """Insert lines after an element, with its indentation."""
    source = draft.source
    own = source.get_indentation(element)
    start = b"" if own is None else source.line_end + own
    step = source.step
    shown = b"".join(
        start + step * (len(line) - len(line.lstrip("\t"))) + draft.encode(line.lstrip("\t"))
        for line in lines
    )
    draft.edits.append(Edit(element.end, element.end, shown))


def _turn_back(draft: Draft, joint: Joint, entry: _Turned) -> None:
    """Write a joint that was turned round as it was."""
    inserted = [joint.element]
    if entry.fixed is None:
        set_links(draft, joint, joint.child, joint.parent)
    else:
        set_links(draft, joint, entry.fixed.child, joint.parent)
        draft.declare("merged", entry.fixed.child, entry.middle)
        inserted += [draft.robot.link[entry.middle].element, entry.fixed.element]
    for part, tag in ((joint.origin, "origin"), (joint.axis, "axis")):
        written = next((m[0] for m in _TAG.finditer(entry.texts) if m[1] == tag), None)
        element = None if part is None else part.xml
        if element is None or (tag == "axis" and joint.is_fixed):
            continue
        if written is not None:
            draft.edits.append(Edit(element.start, element.end, draft.encode(written)))
        else:
            draft.remove(element)
    _remove_inserted(draft, inserted, entry.comment)


def _remove_inserted(draft: Draft, elements: list[Element], comment: Comment) -> None:
    """Remove what stands after a joint up to the comment, if it is as it was inserted."""
    at, data = elements[0].end, draft.file.data
    for element in elements[1:]:
        if data[at : element.start].strip():
            break
        at = element.end
    else:
        if not data[at : comment.start].strip():
            draft.edits.append(Edit(elements[0].end, comment.end, b""))
            return
    for element in elements[1:]:
        draft.remove(element)
    draft.edits.append(Edit(comment.start, comment.end, b""))


def _check_semantics(draft: Draft, file: TextDraft, old: str, new: str) -> None:
    """Attach virtual joints to the new root; refuse chains that lead up the tree then.

    Raises:
        ModelError: A chain would not lead down the tree any more.
    """
    root = file.source.document.root
    for element in root.list_children("virtual_joint"):
        if element.get("child_link") == old:
            file.set(element, "child_link", new)
            draft.report("semantics", f"the virtual joint now places '{new}'", element.place)
    above = {new, *draft.robot.tree.list_ancestors(new)}
    for element, attribute, _ in find_references(root, "link"):
        if attribute != "base_link" or element.get(attribute) not in above - {new}:
            continue
        tip = element.get("tip_link") or ""
        if tip in above or not _is_below(draft, element.get(attribute) or "", tip, above):
            raise ModelError(
                f"the chain from '{element.get(attribute)}' to '{tip}' would lead up the tree; "
                "write the group as a list of joints first",
                at=element.place,
            )


def _is_below(draft: Draft, base: str, tip: str, above: set[str]) -> bool:
    """Tell whether a chain leaves the way to the new root at its base."""
    way = [tip, *draft.robot.tree.list_ancestors(tip)]
    first = next((name for name in way if name in above), "")
    return first == base


def _report_base(draft: Draft, old: str, new: str) -> None:
    if WORLD in (old, new):
        effect = "not the root any more, so that the base is free"
        if new == WORLD:
            effect = "the root now, which Gazebo fixes to its world"
        draft.report("base", f"'{WORLD}' is {effect}", draft.robot.link[WORLD].place)


def set_links(draft: Draft, joint: Joint, parent: str, child: str) -> None:
    """Write parent and child of a joint."""
    for element, name in ((joint.parent_element, parent), (joint.child_element, child)):
        assert element is not None
        draft.set(element, "link", name)


def turn_with_frames(draft: Draft, path: Sequence[Joint]) -> None:
    """Turn the joints from a new root up to the old one round.

    The old parent of a moving joint gets its frame at the joint: with X of each link, its new frame
    in its old one, the joint from C to P is X(C)⁻¹ M(-a, q) for X(P) = T, its origin before.
    """
    moved: dict[str, Pose] = {}
    for joint in path:
        pose = make_pose(joint.origin)
        before = moved.get(joint.child, IDENTITY).invert()
        if joint.is_fixed:
            before = before @ pose.invert()
        else:
            moved[joint.parent] = pose
            negate_axis(draft, joint)
        set_links(draft, joint, joint.child, joint.parent)
        draft.set_pose(joint.element, joint.origin, before)
    turned = {name: pose for name, pose in moved.items() if not is_identity(pose)}
    check_loops(draft, turned, "whose frame would move")
    for name, pose in moved.items():
        if not is_identity(pose):
            _move_link(draft, draft.robot.link[name], pose, {joint.name for joint in path})


def _move_link(draft: Draft, link: Link, pose: Pose, turned: set[str]) -> None:
    """Write the parts of a link in its new frame."""
    back = pose.invert()
    for part in (link.inertial, *link.visuals, *link.collisions):
        if part is not None:
            draft.set_pose(part.element, part.origin, back @ make_pose(part.origin))
    for joint in draft.robot.tree.get_child_joints(link.name):
        if joint.name not in turned:
            draft.set_pose(joint.element, joint.origin, back @ make_pose(joint.origin))
    for block in list_gazebo_blocks(draft, link.name):
        message = f"<gazebo> of '{link.name}': poses in it are relative to the frame before"
        draft.report("frame", message, block.place)
    xyz, rpy = format_vector(pose.translation), format_rotation(pose.rotation)
    draft.declare("frame", link.name, "xyz", *xyz.split(), "rpy", *rpy.split())
