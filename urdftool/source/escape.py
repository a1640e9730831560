"""Characters of XML that have to be written otherwise, and back.

As ``xml.sax.saxutils`` does it, whose import takes longer than the lint of a small robot: it brings
the machinery of URLs and mail.
"""

from __future__ import annotations

from collections.abc import Mapping


def escape(text: str, entities: Mapping[str, str] | None = None) -> str:
    """A text as it is written between tags; ``entities`` by the characters they stand for."""
    text = text.replace("&", "&amp;").replace(">", "&gt;").replace("<", "&lt;")
    for character, entity in (entities or {}).items():
        text = text.replace(character, entity)
    return text


def unescape(text: str, entities: Mapping[str, str] | None = None) -> str:
    """A text as it is meant; ``entities`` gives the characters by what stands for them."""
    for entity, character in (entities or {}).items():
        text = text.replace(entity, character)
    return text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
