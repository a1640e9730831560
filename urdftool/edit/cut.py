"""A branch of a robot removed, with all that refers to it."""

from __future__ import annotations

import os
from collections.abc import Iterator

from ..errors import ModelError
from ..rules.moveit.semantic import find_references
from ..source.document import Comment, Element
from ..source.edit import Edit
from .around import YamlDraft
from .closed_loops import cut_loops
from .draft import Draft, TextDraft
from .references import list_names_in_text

MARKS = {
    name: (f" urdftool {name}, begin ", f" urdftool {name}, end ") for name in ("attach", "mirror")
}
"""Texts of the comments around what an operation inserts, before the name of its first link."""


def cut_branch(draft: Draft, name: str, *, force: bool = False) -> None:
    """Remove a link, all below it, and all that refers to them.

    ``force`` removes parts that refer to it also if they are about kept parts.

    Raises:
        ModelError: The link does not exist or is the root, or a kept part depends on the branch.
    """
    robot = draft.robot
    link = draft.find_link(name)
    above = robot.tree.get_parent_joint(name)
    if above is None:
        raise ModelError(f"link '{name}' is the root; nothing would remain", at=link.place)
    links = {name, *robot.tree.list_descendants(name)}
    joints = {joint.name for joint in robot.joints if joint.child in links}
    draft.declare("removed", name)
    _check_mimic(draft, joints)
    cut_loops(draft, links)
    marks = _find_marks(draft, name)
    if marks is not None:
        _remove_marked(draft, marks, links | joints)
    for element in _list_concerned(draft, links, joints, force=force):
        draft.remove(element)
    for file in draft.around:
        if not isinstance(file, YamlDraft):
            _cut_semantics(draft, file, links, joints)
    _report_yaml(draft, links | joints)
    list_names_in_text(draft, links | joints, "it is not changed")


def _check_mimic(draft: Draft, joints: set[str]) -> None:
    for joint in draft.robot.joints:
        if joint.mimic is not None and joint.mimic.joint in joints and joint.name not in joints:
            raise ModelError(
                f"joint '{joint.name}' mimics '{joint.mimic.joint}', which would be cut; "
                "remove the <mimic> first",
                at=joint.mimic.place,
            )


def _list_concerned(
    draft: Draft, links: set[str], joints: set[str], *, force: bool
) -> Iterator[Element]:
    """Yield the elements to remove."""
    gone = {id(draft.robot.link[name].element) for name in links}
    gone |= {id(draft.robot.joint[name].element) for name in joints}
    for block in draft.root.children:
        is_about = block.tag == "gazebo" and block.get("reference") in links | joints
        if id(block) in gone or is_about:
            yield block
        elif block.tag in ("transmission", "ros2_control"):
            yield from _list_cut_joints(block, joints, force=force)


def _list_cut_joints(block: Element, joints: set[str], *, force: bool) -> Iterator[Element]:
    """Yield the joints of a block that are cut, or the block if none is left."""
    own = list(block.list_children("joint"))
    cut = [joint for joint in own if joint.get("name") in joints]
    if not cut:
        return
    if len(cut) == len(own) and not any(e.tag in ("sensor", "gpio") for e in block.children):
        yield block
    elif block.tag == "transmission" and not force:
        kept = next(joint.get("name") for joint in own if joint not in cut)
        raise ModelError(
            f"<transmission> '{block.get('name') or ''}' is about joint '{cut[0].get('name')}', "
            f"which would be cut, and '{kept}'; remove it first, or pass --drop-references",
            at=block.place,
        )
    else:
        yield from cut


def _cut_semantics(draft: Draft, file: TextDraft, links: set[str], joints: set[str]) -> None:
    """Remove from an SRDF what refers to the branch, and groups that are empty then."""
    root = file.source.document.root
    for kind, names in (("link", links), ("joint", joints)):
        for element, attribute, _ in find_references(root, kind):
            if element.get(attribute) in names:
                file.remove(element)
    gone = set()
    for block in root.children:
        inner = block.children
        if block.tag in ("group", "group_state") and inner:
            if all(child.start in file.removed for child in inner):
                file.remove(block)
                gone.add(block.get("name"))
    for block in root.children:
        if {block.get("group"), block.get("parent_group")} & gone:
            file.remove(block)
            what = f"<{block.tag}> '{block.get('name') or ''}' is about a group that was cut"
            draft.report("semantics", f"{what}; it was removed", block.place)


def _report_yaml(draft: Draft, names: set[str]) -> None:
    from ..source.yaml_tree import list_scalars

    for file in draft.around:
        if isinstance(file, YamlDraft):
            for node in list_scalars(file.file):
                if names & set((node.text or "").split("/")):
                    name = os.path.basename(file.file.path)
                    message = f"'{node.text}' was cut; {name} is not changed"
                    draft.report("yaml", message, node.place)
    draft.around = [file for file in draft.around if not isinstance(file, YamlDraft)]


def _find_marks(draft: Draft, name: str) -> tuple[Comment, Comment] | None:
    """Return the comments around what was inserted with a first link."""
    comments = draft.source.document.comments
    for begin, end in MARKS.values():
        first = [c for c in comments if c.text == f"{begin}{name} "]
        last = [c for c in comments if c.text == f"{end}{name} "]
        if len(first) == len(last) == 1 and first[0].start < last[0].start:
            return first[0], last[0]
    return None


def _remove_marked(draft: Draft, marks: tuple[Comment, Comment], names: set[str]) -> None:
    """Remove the text from the first to the last comment, if only the branch is between them."""
    data = draft.file.data
    start, end = data.rfind(b"\n", 0, marks[0].start) + 1, data.find(b"\n", marks[1].end) + 1
    for block in draft.root.children:
        is_inside = start <= block.start < end
        is_own = block.tag not in ("link", "joint") or block.get("name") in names
        if is_inside and not is_own:
            return
    if end and not data[start : marks[0].start].strip() and not data[marks[1].end : end].strip():
        draft.edits.append(Edit(start, end, b""))
