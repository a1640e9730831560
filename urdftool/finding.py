"""Findings: defects of a robot, each with its location in the source."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from .diagnostic import Diagnostic, Severity, make_deprecated_name
from .source.location import Call, Place

Scope = Literal["robot", "repository"]
"""Scope within which the findings of a rule may be reported once."""

Site = tuple[str, int]
"""Start of an element: the path of its file and the byte offset."""


class Group(NamedTuple):
    """Grouping of findings of one rule.

    Attributes:
        by: Scope within which they are reported once.
        sentence: Message for several findings, with ``{count}`` and ``{names}``; if empty, the
            first message followed by the other names.
        alike: What the findings of the group have in common in addition to severity and effects.
    """

    by: Scope
    sentence: str
    alike: object = None


class Cause(NamedTuple):
    """Possible cause of a finding."""

    rules: tuple[str, ...]
    sites: tuple[Site, ...]


@dataclass(slots=True)
class Finding(Diagnostic):
    """Defect of a robot at one location of the source.

    Attributes:
        code: Name of the rule, such as ``zero-axis``.
        severity: Severity for the checked targets.
        message: One sentence: the fact and, where known, the correct value.
        location: Location in the source.
        kind: Kind of the object: ``link``, ``joint``, ``robot``, ``file``, …
        name: Name of the object.
        targets: Affected targets; empty means every reader.
        effects: Effect on a reader, by target.
        hint: Remedy in one sentence; empty if the message contains it.
        others: Further instances of the same macro: their names and the xacro calls that lead to
            them.
        expansions: Number of instances.
        variants: Sets of xacro arguments with which the defect occurs; empty means all tried sets.
        fixes: Changes of the source that resolve it, if known and requested, the best one first.
        unchecked: Whether the defect prevents all other checks of the robot.
        site: Element that the finding concerns.
        group: Grouping with other findings of the rule; None if it is reported alone.
        cause: Possible cause.
        members: Findings that this one represents.
        consequences: Findings that this one explains; they are listed under it.
        owner: Name of the object, or of the nearest named element around it.
        data: Values that the rule computed, by name, so that no caller parses the message.
        moot: Whether all readers of which it speaks reject the robot for other defects; a report
            leaves out such a remark.
    """

    location: Place
    kind: str = ""
    name: str = ""
    targets: tuple[str, ...] = ()
    effects: dict[str, str] = field(default_factory=dict)
    hint: str = ""
    others: list[tuple[str, tuple[Call, ...]]] = field(default_factory=list)
    expansions: int = 1
    variants: tuple[str, ...] = ()
    unchecked: bool = False
    site: Site | None = None
    group: Group | None = None
    cause: Cause | None = None
    members: list[Finding] = field(default_factory=list)
    consequences: list[Finding] = field(default_factory=list)
    owner: str = ""
    moot: bool = False

    rule = make_deprecated_name("rule", "code")
    place = make_deprecated_name("place", "location")

    @property
    def names(self) -> list[str]:
        """Return the distinct names of all objects that the finding concerns."""
        each = [self.name, *(name for name, _ in self.others)]
        return [name for name in dict.fromkeys(each) if name]

    @property
    def count(self) -> int:
        """Return the number of defects: instances of macros, and members of a group."""
        return sum(m.expansions for m in self.members) if self.members else self.expansions

    @property
    def is_deferred(self) -> bool:
        """Tell whether it is a remark that is shown and fixed once readers accept the robot."""
        return self.moot and self.severity is Severity.INFO

    def __str__(self) -> str:
        """Return ``FILE:LINE:COLUMN: severity: message [rule]``, with the number of instances."""
        times = f" (in {self.expansions} expansions)" if self.expansions > 1 else ""
        return f"{self.location}: {self.severity.label}: {self.message}{times} [{self.code}]"
