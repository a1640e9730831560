"""Results as JSON."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

_SPECIAL = re.compile("[^ -~\n]")


def format_json(value: object, indent: int | None = None) -> str:
    """Format a value as JSON in which every control character is escaped.

    JSON itself escapes only those below U+0020; terminals also interpret U+0080 to U+009F and
    characters that change the direction of text.
    """
    text = json.dumps(value, indent=indent, ensure_ascii=False)
    return _SPECIAL.sub(_escape, text)


def _escape(match: re.Match[str]) -> str:
    character = match[0]
    return character if character.isprintable() else json.dumps(character)[1:-1]


def replace_non_finite(value: Any) -> Any:
    """Replace numbers that are not finite, which JSON cannot hold, by None."""
    if isinstance(value, Mapping):
        return {key: replace_non_finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [replace_non_finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
