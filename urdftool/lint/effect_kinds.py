"""Kinds of effects: what a reader gets of a robot with a defect.

They are data with the words of each effect, in ``fixtures/effects``; ``python -m tests.effects``
writes them to ``rules/effect_kinds.json``.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from .. import rules
from ..finding import Finding
from ..rules.rule import select_holding
from .motion import UNUSED_JOINT, WELDED

REJECTS = "rejects"
"""The reader rejects the robot."""

INTENDED = "as intended"
"""It gets what the author meant: the finding does not matter to it."""

WRITTEN = "as written"
"""It takes a value that is doubted, or that is missing, as it is written."""

FLAGGED = "only with the flag"
"""PyBullet gets something else only with URDF_USE_INERTIA_FROM_FILE."""

CHANGES = "changes"
"""It gets another robot: without a part, or with another value."""


@cache
def _read_table() -> dict[str, dict[str, dict[str, list[str]]]]:
    path = Path(rules.__file__).with_name("effect_kinds.json")
    table: dict[str, dict[str, dict[str, list[str]]]] = json.loads(path.read_text("utf-8"))
    return table


def find_kinds(rule: str, keys: Iterable[str], effects: Mapping[str, str]) -> dict[str, str]:
    """Return the kind of the effect on each reader.

    Args:
        rule: Name of the rule.
        keys: Keys of its effects that hold.
        effects: The effects of a finding, which may be others than those of the rule.
    """
    known = _find_kinds(rule, keys)
    found = {}
    for key, text in effects.items():
        for reader in key.split(", "):
            is_unused = text in (WELDED, UNUSED_JOINT)
            found[reader] = INTENDED if is_unused else known.get(reader, CHANGES)
    return found


def find_kinds_of_error(finding: Finding) -> dict[str, str]:
    """Return the kind of the effect of an error of reading on each reader, by its case."""
    keys = select_holding(_read_table().get(finding.code, {}), finding.data.get("case", ""))
    return find_kinds(finding.code, keys, finding.effects)


def _find_kinds(rule: str, keys: Iterable[str]) -> dict[str, str]:
    table: Mapping[str, Mapping[str, list[str]]] = _read_table().get(rule, {})
    found: dict[str, str] = {}
    for key in keys:
        readers = key.partition(" (")[0].split(", ")
        found |= dict.fromkeys(readers, CHANGES)
        for kind, of_kind in table.get(key, {}).items():
            found |= dict.fromkeys(of_kind, kind)
    return found
