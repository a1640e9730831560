"""Creation of XML elements, serialized deterministically."""

from __future__ import annotations

from lxml import etree

from ...model.mechanism import NativeElement
from ...model.provenance import Written
from ...source.document import Element

Node = etree._Element


def add(parent: Node, tag: str, text: str | None = None, **attributes: str) -> Node:
    """Append a child element with text and attributes."""
    node = etree.SubElement(parent, tag, attributes)
    if text is not None:
        node.text = text
    return node


def append_comment(parent: Node, text: str) -> None:
    """Append a comment; XML does not allow two consecutive hyphens in it."""
    while "--" in text:
        text = text.replace("--", "- -")
    parent.append(etree.Comment(f" {text.rstrip('-')} "))


def get_or_create(parent: Node, path: str) -> Node:
    """Return the element at a path such as ``surface/friction/ode``; create missing ones."""
    for tag in path.split("/"):
        found = parent.find(tag)
        parent = add(parent, tag) if found is None else found
    return parent


def append_copy(parent: Node, element: Element, tag: str | None = None) -> Node:
    """Append a copy of a source element with all its children, with another tag if given."""
    node = etree.SubElement(
        parent, tag or _name(element, element.tag), nsmap=_collect_prefixes(element)
    )
    for name, value in element.attributes.items():
        if name != "xmlns" and not name.startswith("xmlns:"):
            node.set(_name(element, name), value)
    text = element.text.strip()
    if text:
        node.text = text
    for child in element.children:
        append_copy(node, child)
    return node


def append_native(parent: Node, element: NativeElement) -> Node:
    """Append an element with its children; prefixes mean what they mean in its source."""
    source = element.provenance
    assert isinstance(source, Written)
    assert source.element is not None
    tag = _name(source.element, element.tag)
    node = etree.SubElement(parent, tag, nsmap=_collect_prefixes(source.element))
    for name, value in element.attributes.items():
        node.set(_name(source.element, name), value)
    node.text = element.text or None
    for child in element.children:
        append_native(node, child)
    return node


def format_one_line(element: Element) -> str:
    """Format an element as one line for a comment."""
    words = [element.tag, *(f'{name}="{value}"' for name, value in element.attributes.items())]
    words += element.text.split()
    inner = "; ".join(format_one_line(child) for child in element.children)
    return " ".join(words) + (f" ({inner})" if inner else "")


def merge(target: Node, source: Node) -> None:
    """Merge the children of an element into another; for common leaves the source counts."""
    for child in source:
        same = target.find(child.tag) if isinstance(child.tag, str) else None
        if same is None or (len(child) and not len(same) and child.get("name")):
            target.append(child)
        elif len(child):
            merge(same, child)
        else:
            same.text = child.text
            same.attrib.update(child.attrib)


def serialize_document(root: Node) -> bytes:
    """Serialize a root element."""
    etree.indent(root, "  ")
    text: bytes = etree.tostring(root, encoding="UTF-8")
    return b'<?xml version="1.0"?>\n' + text + b"\n"


def _name(element: Element, name: str) -> str:
    """Convert a prefixed name to the notation of lxml."""
    prefix, colon, local = name.partition(":")
    if not colon:
        return name
    return f"{{{_format_namespace(element, prefix)}}}{local}"


def _format_namespace(element: Element | None, prefix: str) -> str:
    while element is not None:
        if f"xmlns:{prefix}" in element.attributes:
            return element.attributes[f"xmlns:{prefix}"]
        element = element.parent
    return f"urn:{prefix}"  # robot files rarely declare their prefixes


def _collect_prefixes(element: Element) -> dict[str, str] | None:
    names = [element.tag, *element.attributes]
    prefixes = {name.partition(":")[0] for name in names if ":" in name} - {"xmlns"}
    return {prefix: _format_namespace(element, prefix) for prefix in sorted(prefixes)} or None
