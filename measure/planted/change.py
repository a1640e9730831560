"""A change of a written model, by XPath."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lxml import etree

Root = etree._Element
Edit = Callable[[Root], None]


@dataclass(frozen=True)
class Planted:
    """A change and the row of the comparison that has to name it.

    Attributes:
        what: The change in words.
        row: The name of the row.
        edit: Makes the change.
    """

    what: str
    row: str
    edit: Edit


def found(root: Root, path: str) -> list[Root]:
    """Return the elements at a path, of which there has to be one."""
    elements = root.xpath(path)
    assert elements, path
    return elements


def put(path: str, name: str, value: str) -> Edit:
    """Set an attribute of the first element at a path to another value."""

    def edit(root: Root) -> None:
        element = found(root, path)[0]
        assert element.get(name) != value, (path, name)
        element.set(name, value)

    return edit


def drop(path: str, name: str = "") -> Edit:
    """Remove every element at a path, or an attribute of it."""

    def edit(root: Root) -> None:
        for element in found(root, path):
            if name:
                del element.attrib[name]
            else:
                element.getparent().remove(element)

    return edit


def say(path: str, text: str) -> Edit:
    """Write another text into the first element at a path."""

    def edit(root: Root) -> None:
        element = found(root, path)[0]
        assert (element.text or "").strip() != text, path
        element.text = text

    return edit


def add(path: str, xml: str, *, first: bool = False) -> Edit:
    """Put an element into the first one at a path."""

    def edit(root: Root) -> None:
        element = found(root, path)[0]
        element.insert(0 if first else len(element), etree.fromstring(xml))

    return edit


def move(path: str, target: str) -> Edit:
    """Move the first element at a path into another."""

    def edit(root: Root) -> None:
        found(root, target)[0].append(found(root, path)[0])

    return edit


def both(*edits: Edit) -> Edit:
    """Make several changes."""

    def edit(root: Root) -> None:
        for one in edits:
            one(root)

    return edit


def section(name: str) -> Edit:
    """Add a section to the root where there is none of its name."""

    def edit(root: Root) -> None:
        if root.find(name) is None:
            etree.SubElement(root, name)

    return edit
