"""What is wrong with a robot: a fact with a place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Literal, NamedTuple

from .source.location import Call, Place


class Severity(IntEnum):
    """How much it matters.

    An *error*: a reader of the description rejects it, crashes, or loses part of it. A *warning*:
    it loads, and behaves differently from what the text says. *Info*: portability, convention.
    """

    INFO = 1
    WARNING = 2
    ERROR = 3

    @property
    def label(self) -> str:
        """``error``, ``warning`` or ``info``."""
        return self.name.lower()


Scope = Literal["robot", "repository"]
"""What the findings of a rule may be reported once for."""

Site = tuple[str, int]
"""Where an element starts: the path of its file, and the byte."""


class Group(NamedTuple):
    """How a finding is reported with others of its rule.

    Attributes:
        by: What they are reported once for.
        sentence: The message for several, with ``{count}`` and ``{names}``; empty for the first
            message followed by the other names.
    """

    by: Scope
    sentence: str


class Cause(NamedTuple):
    """What may explain a finding.

    Attributes:
        rules: The rules whose finding does.
        site: The element that it is about.
    """

    rules: tuple[str, ...]
    site: Site


class Replacement(NamedTuple):
    """Bytes of a source file that become others.

    Attributes:
        place: The bytes that go; where something is inserted, none.
        data: The bytes that come.
    """

    place: Place
    data: bytes

    @property
    def text(self) -> str:
        """What comes, as text."""
        return self.data.decode(self.place.file.encoding, "replace")


class FileRewrite(NamedTuple):
    """A file, such as a mesh, that a fix writes whole.

    Attributes:
        path: File to write, which may be there already.
        origin: File it is computed from, which may be the same.
        how: Description of what is written: ``binary STL``.
    """

    path: str
    origin: str
    how: str


class Fix(NamedTuple):
    """What mends a finding.

    Attributes:
        safe: Whether the robot is the same afterwards to whatever read it before.
        message: What is done, in words: ``write 0 0 1``.
        replacements: The bytes that change, in the order of the source.
        rewrites: Files that are written whole.
    """

    safe: bool
    message: str
    replacements: tuple[Replacement, ...]
    rewrites: tuple[FileRewrite, ...] = ()

    @property
    def applicability(self) -> str:
        """``safe`` or ``unsafe``."""
        return "safe" if self.safe else "unsafe"

    @property
    def paths(self) -> set[str]:
        """The files that it changes."""
        changed = {replacement.place.path for replacement in self.replacements}
        return changed.union(rewrite.path for rewrite in self.rewrites)

    @property
    def option(self) -> str:
        """What applies it on the command line."""
        meshes = " --fix-meshes" if self.rewrites else ""
        return ("--fix" if self.safe else "--fix --unsafe-fixes") + meshes


@dataclass(slots=True)
class Finding:
    """One thing that is wrong, at one place of the source.

    Attributes:
        rule: Name of the rule, such as ``zero-axis``.
        severity: How much it matters for the targets.
        message: One sentence: what is wrong, with what would be right.
        place: Where it was written.
        kind: What it is about: ``link``, ``joint``, ``robot``, ``file``, …
        name: The name of that.
        targets: The targets it matters for; empty means every reader.
        effects: What a reader does with the defect, by target.
        hint: What would mend it, in a sentence; empty where the message says it.
        others: The instances of one macro are one finding; these are the names of the others and
            the calls they came through.
        expansions: How many instances there are.
        variants: The sets of xacro arguments it is there with; empty means all that were tried.
        fix: What mends it in the source, where that is known and was asked for.
        unchecked: Whether because of it nothing else of the robot was checked.
        site: The element that it is about.
        group: How it is reported with others of its rule; None where it stands alone.
        cause: What may explain it.
        members: The findings that this one stands for, where several are reported as one.
        consequences: The findings that this one explains, which are listed under it.
        data: Values that the rule knows, by name; nothing reads them out of the message.
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

    @property
    def names(self) -> list[str]:
        """The names of all that it is about, each once."""
        each = [self.name, *(name for name, _ in self.others)]
        return [name for name in dict.fromkeys(each) if name]

    @property
    def count(self) -> int:
        """How many facts it stands for: instances of macros, and members of a group."""
        return sum(m.expansions for m in self.members) if self.members else self.expansions

    def __str__(self) -> str:
        """``FILE:LINE:COLUMN: severity: message [rule]``, with the number of instances."""
        times = f" (in {self.expansions} expansions)" if self.expansions > 1 else ""
        return f"{self.place}: {self.severity.label}: {self.message}{times} [{self.rule}]"
