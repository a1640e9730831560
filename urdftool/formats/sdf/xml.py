"""XML as it is written: elements made one by one, indented, the same bytes every time."""

from __future__ import annotations

from lxml import etree

from ...source.document import Element

Node = etree._Element


def add(parent: Node, tag: str, text: str | None = None, **attributes: str) -> Node:
    """A new last child, with its text and attributes."""
    node = etree.SubElement(parent, tag, attributes)
    if text is not None:
        node.text = text
    return node


def comment(parent: Node, text: str) -> None:
    """A comment as the last child; two hyphens, which XML does not allow in one, are parted."""
    while "--" in text:
        text = text.replace("--", "- -")
    parent.append(etree.Comment(f" {text.rstrip('-')} "))


def at(parent: Node, path: str) -> Node:
    """The element at a path of tags such as ``surface/friction/ode``, made where it is missing."""
    for tag in path.split("/"):
        found = parent.find(tag)
        parent = add(parent, tag) if found is None else found
    return parent


def copied(parent: Node, element: Element, tag: str | None = None) -> Node:
    """An element of the source, with all below it, as the last child.

    Args:
        parent: What it goes into.
        element: The element of the source.
        tag: A new name for it.
    """
    node = etree.SubElement(parent, tag or _name(element, element.tag), nsmap=_prefixes(element))
    for name, value in element.attributes.items():
        if name != "xmlns" and not name.startswith("xmlns:"):
            node.set(_name(element, name), value)
    text = element.text.strip()
    if text:
        node.text = text
    for child in element.children:
        copied(node, child)
    return node


def spoken(element: Element) -> str:
    """An element in one line, for a comment."""
    words = [element.tag, *(f'{name}="{value}"' for name, value in element.attributes.items())]
    words += element.text.split()
    inner = "; ".join(spoken(child) for child in element.children)
    return " ".join(words) + (f" ({inner})" if inner else "")


def merge(target: Node, source: Node) -> None:
    """Put what is in one element into another; a leaf that both have is the source's."""
    for child in source:
        same = target.find(child.tag) if isinstance(child.tag, str) else None
        if same is None or (len(child) and not len(same) and child.get("name")):
            target.append(child)
        elif len(child):
            merge(same, child)
        else:
            same.text = child.text
            same.attrib.update(child.attrib)


def document(root: Node) -> bytes:
    """The file of a root element."""
    etree.indent(root, "  ")
    text: bytes = etree.tostring(root, encoding="UTF-8")
    return b'<?xml version="1.0"?>\n' + text + b"\n"


def _name(element: Element, name: str) -> str:
    """A name with a prefix in the notation of lxml."""
    prefix, colon, local = name.partition(":")
    if not colon:
        return name
    return f"{{{_namespace(element, prefix)}}}{local}"


def _namespace(element: Element | None, prefix: str) -> str:
    while element is not None:
        if f"xmlns:{prefix}" in element.attributes:
            return element.attributes[f"xmlns:{prefix}"]
        element = element.parent
    return f"urn:{prefix}"  # readers of robot files know prefixes, and rarely declare them


def _prefixes(element: Element) -> dict[str, str] | None:
    names = [element.tag, *element.attributes]
    prefixes = {name.partition(":")[0] for name in names if ":" in name} - {"xmlns"}
    return {prefix: _namespace(element, prefix) for prefix in sorted(prefixes)} or None
