"""Look up rules by name, family and file.

A family follows from the stage at which its rules run: the bytes (xml), the xacro source (xacro),
the expanded robot (tree to name), its files (mesh, package), the simulators (gazebo, control,
simulation), and the linter itself (lint). Rules are imported on demand.
"""

from __future__ import annotations

from collections.abc import Iterator, Set
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from .table import APPLIES_TO, RULES

if TYPE_CHECKING:
    from .rule import Rule

FAMILIES = (
    *("xml", "xacro", "tree", "joint", "inertia", "collision", "visual", "mesh", "package"),
    *("gazebo", "control", "simulation", "moveit", "name", "lint"),
)
"""In reading order."""

FILE_OF = {
    name: f"{family}.{file}"
    for family, files in RULES.items()
    for file, names in files.items()
    for name in names
}

FAMILY_OF = {name: file.partition(".")[0] for name, file in FILE_OF.items()}


@cache
def get_rule(name: str) -> Rule:
    """Get a rule by its name, importing it if needed.

    Raises:
        KeyError: There is no rule of that name.
    """
    module = import_module(f".{FILE_OF[name]}", __name__)
    rule: Rule = getattr(module, name.replace("-", "_"))
    return rule


def applies_to(name: str, tags: Set[str]) -> bool:
    """Tell whether a rule can find anything in a robot that has only these elements."""
    required = APPLIES_TO.get(FILE_OF[name])
    return required is None or not tags.isdisjoint(required)


def get_all_rules() -> Iterator[Rule]:
    """Get every rule, in reading order."""
    return map(get_rule, FAMILY_OF)
