"""Errors that stop the tool.

Defects of a *robot* are findings (``urdftool.finding``): data, any number of them. Failures of the
*tool* are the exceptions below; ``urdftool.cli`` turns them into a message and an exit code::

    UrdftoolError
    ├── SourceError            the text cannot be read or used
    │   ├── XmlError           it is not well-formed
    │   ├── XacroError         its expansion failed
    │   ├── AccessError        it names a file that it may not read
    │   └── PackageNotFound    the package of $(find …) or package:// was not found
    ├── ModelError             well-formed, but not a usable robot description
    ├── MeshError              a mesh cannot be read, or lacks a required volume
    ├── ConfigError            an unknown rule, option or value
    ├── OutputError            the result cannot be written
    ├── AddressError           a page cannot be served at an address
    └── MissingDependency      a library of an extra is not installed
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .source.location import Call, Place


class UrdftoolError(Exception):
    """Error with a message that names the problem and, where known, its remedy.

    Attributes:
        message: One sentence, without a location.
        path: File that the error concerns, if any.
        line: Line in that file, from 1, if known.
        column: Column in characters, from 1, if known.
        calls: xacro calls and includes that lead to the location, innermost first.
        notes: Additional lines, such as the searched folders.
        rule: Lint rule that reports the same problem, if any.
        case: Case of that rule's effects on readers, as a condition of their keys.
        data: Values of the problem by name, so that no caller parses the message.
    """

    def __init__(
        self,
        message: str,
        *,
        path: str | Path | None = None,
        line: int | None = None,
        column: int | None = None,
        at: Place | None = None,
        calls: Sequence[Call] = (),
        notes: Sequence[str] = (),
        rule: str = "",
        case: str = "",
        data: Mapping[str, Any] | None = None,
    ) -> None:
        """Store the facts; ``at`` sets path, line, column and, by default, calls."""
        if at is not None:
            path = at.file.path
            line, column = at.line, at.column
            calls = calls or at.calls
        super().__init__(message)
        self.message = message
        self.path = None if path is None else str(path)
        self.line = line
        self.column = column
        self.calls = tuple(calls)
        self.notes = tuple(notes)
        self.at = at
        self.rule = rule
        self.case = case
        self.data: Mapping[str, Any] = data or {}

    @property
    def where(self) -> str:
        """Return ``FILE:LINE:COLUMN``, as far as known."""
        if self.at is not None and self.at.file.part:
            return str(self.at)
        return ":".join(str(part) for part in (self.path, self.line, self.column) if part)

    def __str__(self) -> str:
        """Return location and message in one line."""
        return f"{self.where}: {self.message}" if self.path else self.message


class SourceError(UrdftoolError):
    """Error for a description whose text cannot be read or used."""


class XmlError(SourceError):
    """Error for text that is not well-formed XML, or is XML of a rejected kind."""


class XacroError(SourceError):
    """Error for a failed xacro expansion."""


class AccessError(SourceError):
    """Error for a file that a description may not read."""


class PackageNotFound(SourceError):  # noqa: N818 -- reads as what happened
    """Error for a package that is in none of the searched folders."""


class ModelError(UrdftoolError):
    """Error for a well-formed description that is not a usable robot."""


class LimitError(ModelError):
    """Error for a description that may be right: reading it exceeds a limit of urdftool."""


class MeshError(UrdftoolError):
    """Error for a mesh that cannot be read or does not meet a requirement."""


class ConfigError(UrdftoolError):
    """Error for a configuration, option or comment that names something unknown."""


class OutputError(UrdftoolError):
    """Error for a result that cannot be written."""


class AddressError(UrdftoolError):
    """Error for a page that cannot be served at an address."""


class MissingDependency(UrdftoolError):  # noqa: N818
    """Error for a required library or program that is not installed.

    Attributes:
        library: Import name of the optional library; empty for a program.
    """

    def __init__(self, message: str, *, library: str = "") -> None:
        """Store the message and the library."""
        super().__init__(message)
        self.library = library

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the message and the library."""
        return _make_missing, (self.message, self.library)


def _make_missing(message: str, library: str) -> MissingDependency:
    return MissingDependency(message, library=library)
