"""What stops the tool.

What is wrong with a *robot* is a finding (``urdftool.finding``): data, and there may be many.
What stops the *tool* is one of these, raised where it is met and turned into a message and an
exit code in ``urdftool.cli`` alone::

    UrdftoolError
    ├── SourceError            the text cannot be read or used
    │   ├── XmlError           it is not well-formed
    │   ├── XacroError         its expansion failed
    │   └── PackageNotFound    $(find …) or package:// names no package that could be found
    ├── ModelError             well-formed, but not a robot that can be worked on
    ├── MeshError              a mesh cannot be read, or has no volume where one is needed
    ├── ConfigError            an unknown rule, option or value
    ├── OutputError            the result cannot be written
    ├── AddressError           a page cannot be served there
    └── MissingDependency      a library of an extra is not installed
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .source.location import Call, Place


class UrdftoolError(Exception):
    """A sentence that says what is wrong, with what would be right.

    Attributes:
        message: The sentence, without a place.
        path: The file it is about, if there is one.
        line: Line in that file, from 1, if it is known.
        column: Column in characters, from 1, if it is known.
        calls: The xacro calls and includes it came through, innermost first.
        notes: Further lines for whoever wants to know more, such as the places searched.
        rule: The lint rule that says the same of a file that is linted, if there is one.
        case: What of that rule's effects on readers holds, as conditions of their keys.
        data: Values that are known of it, by name; nothing reads them out of the message.
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
        """Take the facts; the text is made by ``str()``."""
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
        """``FILE:LINE:COLUMN``, as far as it is known."""
        return ":".join(str(part) for part in (self.path, self.line, self.column) if part)

    def __str__(self) -> str:
        """Place and sentence, in one line."""
        return f"{self.where}: {self.message}" if self.path else self.message


class SourceError(UrdftoolError):
    """The text of a description cannot be read or used."""


class XmlError(SourceError):
    """The text is not well-formed XML, or is XML of a kind that is refused."""


class XacroError(SourceError):
    """The expansion of a xacro file failed."""


class PackageNotFound(SourceError):  # noqa: N818 -- reads as what happened
    """A package is not in any of the places that were searched."""


class ModelError(UrdftoolError):
    """The description is well-formed, but no robot that can be worked on."""


class MeshError(UrdftoolError):
    """A mesh cannot be read, or is not what is needed of it."""


class ConfigError(UrdftoolError):
    """A configuration, option or comment names something that does not exist."""


class OutputError(UrdftoolError):
    """A result cannot be written."""


class AddressError(UrdftoolError):
    """A page cannot be served at an address."""


class MissingDependency(UrdftoolError):  # noqa: N818
    """A library or program that this command requires is not installed.

    Attributes:
        library: The optional library, by the name of its import; empty for a program.
    """

    def __init__(self, message: str, *, library: str = "") -> None:
        """Keep the message and the library."""
        super().__init__(message)
        self.library = library

    def __reduce__(self) -> tuple[object, ...]:
        """Make a copy in another process."""
        return _make_missing, (self.message, self.library)


def _make_missing(message: str, library: str) -> MissingDependency:
    return MissingDependency(message, library=library)
