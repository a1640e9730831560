"""Names of joints and links in one robot for those in another."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import ConfigError


class NameMap(NamedTuple):
    """Names in a second robot by those in a first.

    Attributes:
        joints: Names of joints.
        links: Names of links.
        parts: Names of these and of transmissions, hardware and the like, for ``<gazebo>`` and
            other blocks that refer to them.
    """

    joints: Mapping[str, str]
    links: Mapping[str, str]
    parts: Mapping[str, str] = {}


EMPTY = NameMap({}, {})

_KINDS = ("joint", "link")


Line = tuple[str, tuple[str, ...]]
"""``joint`` or ``link``, and a name in each robot."""


def read_lines(path: Path) -> list[tuple[int, list[str]]]:
    """Read number and words of each line that has words; a name with spaces is in double quotes.

    Raises:
        ConfigError: The file cannot be read.
    """
    try:
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"cannot be read: {error}", path=path) from None
    lines = [(n, split_words(line)) for n, line in enumerate(text.splitlines(), 1)]
    return [(number, words) for number, words in lines if words]


_WORD = re.compile(r'"([^"]*)"|([^\s#]+)|#.*')


def split_words(line: str) -> list[str]:
    """Split a line at spaces, except in double quotes; text after ``#`` is a comment."""
    found = (match[1] if match[1] is not None else match[2] for match in _WORD.finditer(line))
    return [word for word in found if word is not None]


def get_pair(lines: Iterable[tuple[str, tuple[str, ...]]], one: int, two: int) -> NameMap:
    """Return the names of two of the robots, by the numbers of the robots."""
    maps: dict[str, dict[str, str]] = {kind: {} for kind in (*_KINDS, "part")}
    for kind, names in lines:
        maps[kind][names[one]] = names[two]
    return NameMap(maps["joint"], maps["link"], {**maps["part"], **maps["joint"], **maps["link"]})


def match_names(a: Sequence[str], b: Sequence[str], given: Mapping[str, str]) -> dict[str, str]:
    """Match names: as given, then equal ones, then those equal up to case, marks and a prefix.

    Args:
        a: Names in the first robot.
        b: Names in the second.
        given: Names that are known, which need not exist.

    Returns:
        Names in the second robot by those in the first; each name occurs once.
    """
    firsts, seconds = set(a), set(b)
    found = {x: y for x, y in given.items() if x in firsts and y in seconds}
    taken = set(found.values())
    found |= {x: x for x in a if x in seconds and x not in found and x not in taken}
    for plain in (_simplify, _strip):
        left = [x for x in a if x not in found]
        taken = set(found.values())
        right = [y for y in b if y not in taken]
        one, two = plain(left, a), plain(right, b)
        for key in one.keys() & two.keys():
            if len(one[key]) == len(two[key]) == 1:
                found[one[key][0]] = two[key][0]
    return {x: found[x] for x in a if x in found}


def _simplify(names: Sequence[str], every: Sequence[str]) -> dict[str, list[str]]:
    """Group names by their letters and digits, in lower case."""
    return _group(names, "")


def _strip(names: Sequence[str], every: Sequence[str]) -> dict[str, list[str]]:
    """Group names by letters and digits without the prefix that all names of a robot have."""
    lower = [name.lower() for name in every]
    prefix = ""
    if len(lower) > 1:
        first, last = min(lower), max(lower)
        same = (i for i, (x, y) in enumerate(zip(first, last, strict=False)) if x != y)
        prefix = first[: next(same, min(len(first), len(last)))]
    return _group(names, prefix.rstrip("0123456789"))


def _group(names: Sequence[str], prefix: str) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for name in names:
        short = name.lower().removeprefix(prefix)
        short = re.sub(r"(?<![a-z])joint|joint(?![a-z])", "", short) or short
        key = re.sub(r"[^a-z0-9]", "", short)
        found.setdefault(key, []).append(name)
    return found
