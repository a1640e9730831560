"""Escaping of XML characters.

Equivalent to ``xml.sax.saxutils``, whose import takes longer than the lint of a small robot, since
it imports the URL and mail packages.
"""

from __future__ import annotations

from collections.abc import Mapping


def escape(text: str, entities: Mapping[str, str] | None = None) -> str:
    """Return a text escaped for XML; ``entities`` maps further characters to their entities."""
    text = text.replace("&", "&amp;").replace(">", "&gt;").replace("<", "&lt;")
    for character, entity in (entities or {}).items():
        text = text.replace(character, entity)
    return text


def unescape(text: str, entities: Mapping[str, str] | None = None) -> str:
    """Return a text with entities resolved; ``entities`` maps further entities to characters."""
    for entity, character in (entities or {}).items():
        text = text.replace(entity, character)
    return text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")


def escape_attribute(text: str) -> str:
    """Escape text for an attribute in double quotes, or between tags."""
    return escape(text, {'"': "&quot;"})
