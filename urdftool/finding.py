"""Findings: defects of a robot, each with its location in the source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Literal, NamedTuple

from .source.location import Call, Place


class Severity(IntEnum):
    """Severity of a finding.

    *Error*: a reader of the description rejects it, crashes, or loses part of it. *Warning*: the
    description loads, but behaves differently from its text. *Info*: portability or convention.
    """

    INFO = 1
    WARNING = 2
    ERROR = 3

    @property
    def label(self) -> str:
        """Return ``error``, ``warning`` or ``info``."""
        return self.name.lower()


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
    """

    by: Scope
    sentence: str


class Cause(NamedTuple):
    """Possible cause of a finding.

    Attributes:
        rules: Rules whose finding is the cause.
        site: Element that this cause concerns.
    """

    rules: tuple[str, ...]
    site: Site


class Replacement(NamedTuple):
    """Replacement of bytes in a source file.

    Attributes:
        place: Span to replace; empty for an insertion.
        data: New bytes.
    """

    place: Place
    data: bytes

    @property
    def text(self) -> str:
        """Return the new bytes decoded with the encoding of the file."""
        return self.data.decode(self.place.file.encoding, "replace")


class FileRewrite(NamedTuple):
    """File, such as a mesh, that a fix rewrites completely.

    Attributes:
        path: File to write; it may exist.
        origin: File from which the content is computed; may equal ``path``.
        how: Description of the content: ``binary STL``.
    """

    path: str
    origin: str
    how: str


class Fix(NamedTuple):
    """Change that resolves a finding.

    Attributes:
        safe: Whether readers that accepted the description get the same robot afterwards.
        message: Short description of the change: ``write 0 0 1``.
        replacements: Changed bytes, in the order of the source.
        rewrites: Files that are rewritten completely.
    """

    safe: bool
    message: str
    replacements: tuple[Replacement, ...]
    rewrites: tuple[FileRewrite, ...] = ()

    @property
    def applicability(self) -> str:
        """Return ``safe`` or ``unsafe``."""
        return "safe" if self.safe else "unsafe"

    @property
    def paths(self) -> set[str]:
        """Return the files that the fix changes."""
        changed = {replacement.place.path for replacement in self.replacements}
        return changed.union(rewrite.path for rewrite in self.rewrites)

    @property
    def option(self) -> str:
        """Return the command-line options that apply the fix."""
        meshes = " --fix-meshes" if self.rewrites else ""
        return ("--fix" if self.safe else "--fix --unsafe-fixes") + meshes


@dataclass(slots=True)
class Finding:
    """Defect of a robot at one location of the source.

    Attributes:
        rule: Name of the rule, such as ``zero-axis``.
        severity: Severity for the checked targets.
        message: One sentence: the fact and, where known, the correct value.
        place: Location in the source.
        kind: Kind of the object: ``link``, ``joint``, ``robot``, ``file``, …
        name: Name of the object.
        targets: Affected targets; empty means every reader.
        effects: Effect on a reader, by target.
        hint: Remedy in one sentence; empty if the message contains it.
        others: Further instances of the same macro: their names and the xacro calls that lead to
            them.
        expansions: Number of instances.
        variants: Sets of xacro arguments with which the defect occurs; empty means all tried sets.
        fix: Fix in the source, if known and requested.
        unchecked: Whether the defect prevents all other checks of the robot.
        site: Element that the finding concerns.
        group: Grouping with other findings of the rule; None if it is reported alone.
        cause: Possible cause.
        members: Findings that this one represents.
        consequences: Findings that this one explains; they are listed under it.
        data: Values that the rule computed, by name, so that no caller parses the message.
        moot: Whether all readers of which it speaks reject the robot for other defects; a report
            leaves out such a remark.
    """

    rule: str
    severity: Severity
    message: str
    place: Place
    kind: str = ""
    name: str = ""
    targets: tuple[str, ...] = ()
    effects: dict[str, str] = field(default_factory=dict)
    hint: str = ""
    others: list[tuple[str, tuple[Call, ...]]] = field(default_factory=list)
    expansions: int = 1
    variants: tuple[str, ...] = ()
    fix: Fix | None = None
    unchecked: bool = False
    site: Site | None = None
    group: Group | None = None
    cause: Cause | None = None
    members: list[Finding] = field(default_factory=list)
    consequences: list[Finding] = field(default_factory=list)
    data: Mapping[str, Any] = field(default_factory=dict)
    moot: bool = False

    @property
    def names(self) -> list[str]:
        """Return the distinct names of all objects that the finding concerns."""
        each = [self.name, *(name for name, _ in self.others)]
        return [name for name in dict.fromkeys(each) if name]

    @property
    def count(self) -> int:
        """Return the number of defects: instances of macros, and members of a group."""
        return sum(m.expansions for m in self.members) if self.members else self.expansions

    def __str__(self) -> str:
        """Return ``FILE:LINE:COLUMN: severity: message [rule]``, with the number of instances."""
        times = f" (in {self.expansions} expansions)" if self.expansions > 1 else ""
        return f"{self.place}: {self.severity.label}: {self.message}{times} [{self.rule}]"
