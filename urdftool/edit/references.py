"""Names in a description: changed with every reference that is known, others listed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ..model.urdf_schema import BLOCKS
from ..rules.renaming import list_joint_references, list_link_references
from ..source.document import Element
from ..source.location import Place
from .draft import Draft


class Names(NamedTuple):
    """New names by old ones.

    Attributes:
        links: Names of links.
        joints: Names of joints.
        materials: Names of materials.
        others: Names of transmissions, actuators, hardware components and their sensors.
    """

    links: Mapping[str, str]
    joints: Mapping[str, str]
    materials: Mapping[str, str] = {}
    others: Mapping[str, str] = {}

    @property
    def every(self) -> dict[str, str]:
        """Return the new names of links, joints and others, to which files around may refer."""
        return {**self.others, **self.joints, **self.links}


def list_gazebo_blocks(draft: Draft, reference: str) -> list[Element]:
    """Return the ``<gazebo>`` elements about a link or joint; those about the robot for ''."""
    blocks = draft.root.list_children("gazebo")
    return [block for block in blocks if (block.get("reference") or "") == reference]


def list_others(root: Element) -> Iterator[Element]:
    """Yield transmissions and their actuators, hardware components, their sensors and GPIOs."""
    for block in root.children:
        if block.tag in ("transmission", "ros2_control"):
            yield block
            yield from (e for e in block.children if e.tag in ("actuator", "sensor", "gpio"))


class NameChange(NamedTuple):
    """A name in a description that changes."""

    element: Element
    attribute: str
    name: str


def list_changes(root: Element, names: Names) -> list[NameChange]:
    """List the names to change in a description: definitions and known references."""
    found: dict[tuple[int, str], NameChange] = {}
    for listed, new in (
        (list_link_references(root), names.links),
        (list_joint_references(root), names.joints),
    ):
        for element, attribute, name in listed:
            key = id(element), attribute
            if name in new and (attribute or key not in found):
                found[key] = NameChange(element, attribute, new[name])
    for change in _list_block_changes(root, names):
        found.setdefault((id(change.element), change.attribute), change)
    for element in list_others(root):
        if (name := element.get("name") or "") in names.others:
            found[id(element), "name"] = NameChange(element, "name", names.others[name])
    for element in root.walk():
        if element.tag == "material" and (name := element.get("name") or "") in names.materials:
            if element.parent is not None and element.parent.tag in ("robot", "visual"):
                found[id(element), "name"] = NameChange(element, "name", names.materials[name])
    return list(found.values())


def _list_block_changes(root: Element, names: Names) -> Iterator[NameChange]:
    """Yield attributes and texts of blocks for simulators that are the name of a link or joint."""
    new = {**names.joints, **names.links}
    for element in (e for block in root.children if block.tag in BLOCKS for e in block.walk()):
        for attribute, value in element.attributes.items():
            if value in new:
                yield NameChange(element, attribute, new[value])
        text = element.text.strip()
        if text in new and not element.children:
            yield NameChange(element, "", new[text])


def rename(draft: Draft, names: Names) -> None:
    """Change names with all references in the description."""
    for element, attribute, name in list_changes(draft.root, names):
        if attribute:
            draft.set(element, attribute, name)
        else:
            draft.set_text(element, name)


def _is_text_set(draft: Draft, element: Element) -> bool:
    return any(element.start < edit.start < element.end for edit in draft.edits)


def report_text(draft: Draft, name: str, why: str, *, has_positions: bool = False) -> None:
    """List elements of simulators and controllers whose text has a name that was not changed."""
    if not name:
        return
    word = re.compile(rf"(?<![\w-]){re.escape(name)}(?![\w-])")
    for block in draft.root.children:
        if block.tag not in BLOCKS:
            continue
        for element in block.walk():
            for place in _find_word(draft, element, word):
                if has_positions and not _may_hold_position(element):
                    continue
                draft.report("text", f"<{element.tag}> has '{name}' in its text; {why}", place)


def report_file_names(draft: Draft, names: Iterable[str]) -> None:
    """List the plugins that read a file of which an edited copy is written."""
    known = set(names)
    for block in draft.root.children:
        if block.tag not in BLOCKS:
            continue
        for element in block.walk():
            name = element.text.strip().replace("\\", "/").rpartition("/")[2]
            if name in known:
                message = f"<{element.tag}> reads {name}, whose edited copy is next to the output"
                draft.report("file", message, element.place)


def _may_hold_position(element: Element) -> bool:
    """Tell whether an element may depend on the position of a joint: not a name of it alone."""
    return not element.children and len(element.text.split()) > 1


def _find_word(draft: Draft, element: Element, word: re.Pattern[str]) -> Iterator[Place]:
    """Yield the places of a word in attributes and text that no change concerns."""
    for name, value in element.attributes.items():
        if word.search(value) and (element.start, name) not in draft.values:
            yield element.locate_attribute(name)
    if word.search(element.text) and not _is_text_set(draft, element):
        yield element.place


def _list_kept(draft: Draft, element: Element) -> Iterator[Element]:
    """Yield an element and its descendants, without those that are removed."""
    if element.start not in draft.removed:
        yield element
        for child in element.children:
            yield from _list_kept(draft, child)


def list_names_in_text(
    draft: Draft, names: Iterable[str], why: str, *, skipped: Sequence[Element] = ()
) -> None:
    """List the texts of plugins with one of many names, as :func:`report_text`."""
    known = sorted(filter(None, names), key=len, reverse=True)
    if not known:
        return
    word = re.compile(rf"(?<![\w-])({'|'.join(map(re.escape, known))})(?![\w-])")
    for block in draft.root.children:
        if block.tag not in BLOCKS or block in skipped:
            continue
        for element in _list_kept(draft, block):
            for place in _find_word(draft, element, word):
                found = word.search(" ".join([*element.attributes.values(), element.text]))
                shown = found[1] if found else ""
                draft.report("text", f"<{element.tag}> has '{shown}' in its text; {why}", place)
