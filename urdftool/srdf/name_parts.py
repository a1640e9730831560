"""Parts of the names of links and joints."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..model.elements import Joint

_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_a-zA-Z]+")
_COUNTED = frozenset(("joint", "link", "axis", "j", "a", "finger", "wheel"))
_WHEEL = re.compile(r"wheel|caster|castor|roller|steer", re.IGNORECASE)
_UNSAFE = re.compile(r"[^A-Za-z0-9_]+")


def split_name(name: str) -> list[str]:
    """Split a name into words in lower case: ``FL_hipJoint1`` is fl, hip, joint and 1."""
    return [word.lower() for word in _WORDS.findall(name)]


def is_wheel_name(joint: Joint) -> bool:
    """Tell whether the name of a joint or of its child link is that of a wheel."""
    return _WHEEL.search(f"{joint.name} {joint.child}") is not None


def find_common_prefix(names: Sequence[str]) -> str:
    """Find the whole words at the start of all names, without numbered words such as ``joint``.

    Names of one robot: ``fr3_joint1`` and ``fr3_joint2`` have the prefix ``fr3``. The result has
    only ASCII letters, digits and underscores.
    """
    if len(names) < 2:
        return ""
    start = _find_common_start(min(names), max(names))
    ends = {match.end() for match in _WORDS.finditer(names[0])}
    cut = max((end for end in ends if end <= len(start) and _is_word_end(names, end)), default=0)
    while cut:
        words = list(_WORDS.finditer(names[0][:cut]))
        last = words[-1] if words else None
        if last is None or last[0].lower() not in _COUNTED:
            break
        cut = last.start()
    return make_identifier(names[0][:cut])


def _find_common_start(one: str, other: str) -> str:
    for index, (left, right) in enumerate(zip(one, other, strict=False)):
        if left != right:
            return one[:index]
    return min(one, other, key=len)


def _is_word_end(names: Sequence[str], end: int) -> bool:
    """Tell whether a word ends there in all names."""
    return all(end in {match.end() for match in _WORDS.finditer(name)} for name in names)


def make_identifier(name: str) -> str:
    """Replace what a name of a ROS node must not have by underscores; empty if nothing is left."""
    text = re.sub("_+", "_", _UNSAFE.sub("_", name)).strip("_")
    return f"_{text}" if text[:1].isdigit() else text
