"""Detect text that xacro should have replaced, whose value is unknown."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..source.document import Element

_BRACED = re.compile(r"\{-?\w+\}")


def is_unexpanded(text: str) -> bool:
    """Tell whether a value still has ``${…}``, ``$(…)`` or a ``{name}`` that lost its ``$``."""
    if "{" not in text and "$" not in text:
        return False
    return "${" in text or "$(" in text or _BRACED.search(text) is not None


def list_unexpanded(element: Element) -> Iterator[str]:
    """List the values of an element that have an expression."""
    for text in (*element.attributes.values(), element.text):
        if text and is_unexpanded(text):
            yield text


def is_part(root: Element) -> bool:
    """Tell whether a file uses arguments of xacro and declares none, as a part of a robot does."""
    texts = [text for element in root.walk() for text in list_unexpanded(element)]
    declares = any(element.tag.rpartition(":")[2] == "arg" for element in root.walk())
    return bool(texts) and not declares and all("$(arg " in text for text in texts)
