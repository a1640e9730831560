"""Diagnostics: defects, losses and remarks, each with a code and data that other code reads.

A message is for people. Code that needs to know what a diagnostic is about reads ``code`` and
``data``; ``tests/test_architecture.py`` checks that it reads no message.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsFloat

if TYPE_CHECKING:
    from .source.location import Place


class Severity(IntEnum):
    """Severity of a diagnostic.

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
class Diagnostic:
    """Defect, loss or remark.

    Attributes:
        code: Identifier of what is reported, such as ``zero-axis``; the name of the rule for a
            finding of lint.
        severity: Severity; ``INFO`` for a remark.
        message: One sentence for people: the fact and, where known, the correct value.
        location: Location in the source; None if it concerns no file.
        data: Values that were computed, by name, so that no caller parses the message.
        fixes: Alternative changes of the source that resolve it, the best one first.
    """

    code: str
    severity: Severity
    message: str
    location: Place | None = None
    data: Mapping[str, Any] = field(default_factory=dict, kw_only=True)
    fixes: tuple[Fix, ...] = field(default=(), kw_only=True)

    @property
    def fix(self) -> Fix | None:
        """Return the best of the fixes; None if there is none."""
        return self.fixes[0] if self.fixes else None


def make_remark(code: str, message: str, **data: Any) -> Diagnostic:
    """Make a diagnostic of severity info that concerns no location."""
    return Diagnostic(code, Severity.INFO, message, data=data)


def make_warning(code: str, message: str, **data: Any) -> Diagnostic:
    """Make a diagnostic of severity warning that concerns no location."""
    return Diagnostic(code, Severity.WARNING, message, data=data)


def make_deprecated_name(old: str, new: str) -> property:
    """Make a property that returns another attribute, with a deprecation warning."""

    def read(self: object) -> Any:
        warnings.warn(f"'{old}' is now '{new}'", DeprecationWarning, stacklevel=2)
        return getattr(self, new)

    return property(read, doc=f"Return ``{new}``; deprecated.")


def freeze(value: object) -> object:
    """Return a hashable value that is equal for equal data.

    Args:
        value: Data of a diagnostic: texts, numbers, and sequences, sets and mappings of these.
    """
    if isinstance(value, Mapping):
        return frozenset((freeze(key), freeze(item)) for key, item in value.items())
    if isinstance(value, list | tuple):
        return tuple(map(freeze, value))
    if isinstance(value, set | frozenset):
        return frozenset(map(freeze, value))
    if isinstance(value, str | bool | int | None):
        return value
    return repr(float(value)) if isinstance(value, SupportsFloat) else repr(value)
