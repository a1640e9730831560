"""Results as JSON."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

from ..model.numbers import round_number

_SPECIAL = re.compile("[^ -~\n]")


def format_json(value: object, indent: int | None = None) -> str:
    """Format a value as JSON with numbers of at most ten digits and escaped control characters.

    JSON itself escapes only those below U+0020; terminals also interpret U+0080 to U+009F and
    characters that change the direction of text.
    """
    text = json.dumps(_round_numbers(value), indent=indent, ensure_ascii=False)
    return _SPECIAL.sub(_escape, text)


def _round_numbers(value: Any) -> Any:
    """Return a value with its fractions rounded to the digits of ``numbers``."""
    if isinstance(value, Mapping):
        return {key: _round_numbers(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_round_numbers(part) for part in value]
    return round_number(value) if isinstance(value, float) else value


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
