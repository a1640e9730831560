"""Groups, states and pairs of an SRDF about one side of a robot, for its mirror image."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ..rules.moveit.semantic import find_references
from ..source.document import Element, parse
from ..source.location import SourceFile
from .draft import Draft, TextDraft
from .references import Names

Rename = Callable[[str], str]
"""Function that returns the name of the mirror image."""


def copy_semantics(draft: Draft, file: TextDraft, names: Names, rename: Rename) -> None:
    """Copy the groups, states, end effectors and pairs of one side, with the names of the image.

    A group that is about other parts, too, is reported.
    """
    root = file.source.document.root
    groups = _list_groups(draft, root, names)
    image = TextDraft(file.file)
    for kind, known in (("link", names.links), ("joint", names.joints)):
        for element, attribute, _ in find_references(root, kind):
            if (name := element.get(attribute) or "") in known:
                image.set(element, attribute, known[name])
    copied = [block for block in root.children if _is_copied(block, names, groups)]
    for element in (e for block in copied for e in block.walk()):
        for attribute in _list_attributes(element):
            if group := element.get(attribute):
                image.set(element, attribute, rename(group))
    made = SourceFile(file.file.path, image.make_bytes())
    for block, copy in zip(root.children, parse(made).root.children, strict=True):
        if block in copied:
            text = made.data[copy.start : copy.end]
            file.append_bytes(file.source.step + text + file.source.line_end)


def _list_attributes(element: Element) -> tuple[str, ...]:
    """Return the attributes of an element that are names of groups, or that of an end effector."""
    return {
        "group": ("name",),
        "group_state": ("group",),
        "end_effector": ("name", "group", "parent_group"),
    }.get(element.tag, ())


def _list_names(block: Element) -> Iterator[tuple[str, str, str]]:
    """Yield kind, name and attribute of each reference within a block."""
    for kind in ("link", "joint"):
        for element, attribute, _ in find_references(block, kind):
            yield kind, element.get(attribute) or "", attribute


def _list_groups(draft: Draft, root: Element, names: Names) -> set[str]:
    """Return the groups of one side only, by the parts and groups within them."""
    found: set[str] = set()
    mixed: set[str] = set()
    for block in root.list_children("group"):
        name = block.get("name") or ""
        inside = [_is_inside(names, *reference) for reference in _list_names(block)]
        inside += [e.get("name") in found for e in block.list_children("group")]
        if inside and all(inside):
            found.add(name)
        elif any(inside):
            mixed.add(name)
            message = f"group '{name}' is also about other parts; it has no mirror image"
            draft.report("semantics", message, block.place)
    return found


def _is_inside(names: Names, kind: str, name: str, attribute: str) -> bool:
    """Tell whether a reference is one to the side, or to the base of a chain."""
    return attribute == "base_link" or name in (names.links if kind == "link" else names.joints)


def _is_copied(block: Element, names: Names, groups: set[str]) -> bool:
    if block.tag == "group":
        return block.get("name") in groups
    if block.tag in ("group_state", "end_effector"):
        return block.get("group") in groups
    known = {"link": names.links, "joint": names.joints}
    return block.tag != "virtual_joint" and any(
        name in known[kind] for kind, name, _ in _list_names(block)
    )
