"""Requests of the process that expands: files, packages and variables."""

from __future__ import annotations

import struct
import sys
from importlib import import_module
from typing import Any

from ..errors import PackageNotFound, SourceError, XacroError, XmlError
from .expansion_channel import Channel
from .last_expansion import Words
from .location import SourceFile

_ERRORS = {kind.__name__: kind for kind in (SourceError, XmlError, XacroError, PackageNotFound)}
PLACE = struct.Struct("qq")
"""File and first byte of the element that is evaluated."""


class RequestedFiles:
    """Files, packages and variables, requested of the other side.

    Attributes:
        files: XML files received, in the order of the other side.
    """

    def __init__(
        self, files: list[SourceFile], answers: dict[Words, Any], channel: Channel, mark: Any
    ) -> None:
        """Create the side that requests."""
        self.files = files
        self._indices = {id(file): index for index, file in enumerate(files)}
        self._answers = answers
        self._used: dict[Words, None] = {}
        self._channel = channel
        self._mark = mark
        self._known: dict[tuple[str, ...], Any] = {}

    def find_package(self, name: str) -> str:
        """Return the folder of a package; see :meth:`ExpansionFiles.find_package`."""
        return str(self._request_once("find", name))

    def locate_file(self, path: str) -> str:
        """Return a path; see :meth:`ExpansionFiles.locate_file`."""
        return str(self._request_once("locate", path))

    def read_xml(self, path: str) -> SourceFile:
        """Return a file to include; see :meth:`ExpansionFiles.read_xml`."""
        words = "include", path
        if words in self._answers:
            self._used[words] = None
            known: int = self._answers[words]
            return self.files[known]
        (place, found), data = self._request(*words)
        index = int(place)
        if index == len(self.files):
            file = SourceFile(found, data)
            self.files.append(file)
            self._indices[id(file)] = index
        return self.files[index]

    def import_yaml(self) -> Any:
        """Return the module yaml; the expansion starts again if it is not imported."""
        if "yaml" not in sys.modules:
            self._request("import", "yaml")
        return import_module("yaml")

    def read_yaml(self, path: str) -> bytes:
        """Return the contents of a YAML file; see :meth:`ExpansionFiles.read_yaml`."""
        return self._request("yaml", path)[1]

    def list_matches(self, pattern: str) -> list[str]:
        """Return the paths that match a pattern."""
        return list(self._request("match", pattern)[0])

    def read_variable(self, name: str) -> str:
        """Return the value of ``$(env NAME)``."""
        return str(self._request("env", name)[0])

    def read_optional_variable(self, name: str, default: str = "") -> str:
        """Return the value of ``$(optenv NAME DEFAULT)``."""
        return str(self._request("optenv", name, default)[0])

    def suggest_path(self, path: str) -> tuple[str, str]:
        """Return parts of an error message; see :meth:`ExpansionFiles.suggest_path`."""
        missing, nearest = self._request("suggest", path)[0]
        return str(missing), str(nearest)

    def add_message(self, text: str) -> None:
        """Print a message of the description."""
        self._request("message", text)

    def mark_place(self, file: SourceFile, start: int) -> None:
        """Store the location of the element that is evaluated, for the other side."""
        if self._mark is not None:
            PLACE.pack_into(self._mark, 0, self._indices[id(file)], start)

    def _request_once(self, *words: str) -> Any:
        """Return the value of a request, of which the answer stays the same."""
        if words in self._answers:
            self._used[words] = None
            return self._answers[words]
        if words not in self._known:
            self._known[words] = self._request(*words)[0]
        return self._known[words]

    def list_used(self) -> list[int]:
        """Return the indices of the known answers that were used."""
        return [index for index, words in enumerate(self._answers) if words in self._used]

    def _request(self, *words: str) -> tuple[Any, bytes]:
        self._channel.send(words)
        answer, data = self._channel.receive()
        if answer.get("error") == "OSError":
            raise OSError(0, answer["message"], answer["path"])
        if "error" in answer:
            kind = _ERRORS.get(answer.pop("error"), XacroError)
            raise kind(**answer)
        return answer["value"], data
