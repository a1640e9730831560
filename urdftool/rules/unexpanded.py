"""Detect text that xacro should have replaced, whose value is unknown."""

from __future__ import annotations

import re

_BRACED = re.compile(r"\{\w+\}")


def is_unexpanded(text: str) -> bool:
    """Tell whether a value still has ``${…}``, ``$(…)`` or a ``{name}`` that lost its ``$``."""
    if "{" not in text and "$" not in text:
        return False
    return "${" in text or "$(" in text or _BRACED.search(text) is not None
