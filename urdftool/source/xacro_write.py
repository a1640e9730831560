"""Output of an expanded tree in the format of xacro."""

from __future__ import annotations

from .xacro_tree import (
    CDATA,
    COMMENT,
    INSTRUCTION,
    TEXT,
    Characters,
    Node,
    XacroDocument,
    XacroElement,
)


def write_xml(document: XacroDocument, banner: list[str]) -> str:
    """Return the text of an expanded tree in the format of xacro.

    Args:
        document: The tree.
        banner: Comments to write before it.
    """
    parts = ['<?xml version="1.0" ?>\n']
    parts.extend(f"<!--{line}-->\n" for line in banner)
    for node in document.childNodes:
        _write(node, "", parts)
    return "".join(parts)


def _write(node: Node, indent: str, parts: list[str]) -> None:
    if isinstance(node, Characters):
        end = "" if node.nodeType == CDATA else "\n"
        parts.append(_escape_characters(node, indent) + end)
        return
    assert isinstance(node, XacroElement)
    parts.append(f"{indent}<{node.tagName}")
    parts.extend(
        f' {name}="{_escape_attribute(value)}"' for name, value in sorted(node.attributes.items())
    )
    first = node.firstChild
    if first is None:
        parts.append("/>\n")
        return
    if first is node.lastChild and first.nodeType == TEXT:
        assert isinstance(first, Characters)
        parts.append(f">{_escape(first.data)}</{node.tagName}>\n")
        return
    parts.append(">\n")
    for child in node.childNodes:
        if child.nodeType == TEXT and isinstance(child, Characters):
            if not child.data or child.data.isspace():
                continue
        _write(child, indent + "  ", parts)
    parts.append(f"{indent}</{node.tagName}>\n")


def _escape_characters(node: Characters, indent: str) -> str:
    if node.nodeType == COMMENT:
        return f"{indent}<!--{node.data}-->"
    if node.nodeType == CDATA:
        return f"<![CDATA[{node.data}]]>"
    if node.nodeType == INSTRUCTION:
        return f"{indent}<?{node.data}?>"
    return indent + _escape(node.data)


def _escape(text: str) -> str:
    if "&" in text or "<" in text or ">" in text:
        text = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return text


def _escape_attribute(text: str) -> str:
    text = _escape(text)
    if '"' in text:
        text = text.replace('"', "&quot;")
    if "\n" in text or "\t" in text or "\r" in text:
        text = text.replace("\r", "&#13;").replace("\n", "&#10;").replace("\t", "&#9;")
    return text
