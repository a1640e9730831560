"""What an expansion requested and compiled, for the next one of the same description.

An editor expands a robot after each change, and a fix after each trial. The next process, a fork,
begins with the answers to the requests of the last one, with the trees of the files that it
included, and with its compiled expressions. The requests are answered again each time, by the rules
of the sandbox; what cannot be answered is left to the process, which requests it.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from typing import Any

from ..errors import UrdftoolError
from .expansion_files import ExpansionFiles
from .expansion_json import Piece
from .expressions import Expression, compile_expression
from .location import SourceFile
from .xacro_parse import parse_xacro

ANSWERED = frozenset(("find", "locate", "include"))
"""Requests that are answered before they are made: their answers do not change anything."""

MAX_TEXT = 200
"""Length of an expression that is compiled before it is evaluated [characters]; chosen."""

_MAX_REQUESTS = 2000  # chosen: the largest of 123 real expansions makes 98
_MAX_EXPRESSIONS = 2000  # chosen: the largest of 123 real expansions has 700

Words = tuple[str, ...]


class Prepared:
    """What an expansion has when it begins.

    Attributes:
        answers: Answers by request: a folder, a path, or the index of an included file.
        codes: Compiled expressions by text.
    """

    def __init__(self) -> None:
        """Create an object without answers and expressions."""
        self.answers: dict[Words, Any] = {}
        self.codes: dict[str, Expression] = {}


class LastExpansion:
    """Requests and expressions of the last expansion of a description with its arguments.

    Attributes:
        pieces: Its nodes by their JSON, if a server prepares the next one; they can be written as
            XML.
    """

    def __init__(self) -> None:
        """Create a memory without requests and expressions."""
        self._requests: dict[Words, None] = {}
        self._codes: dict[str, Expression | None] = {}
        self.pieces: dict[bytes, Piece] = {}

    @property
    def texts(self) -> Iterable[str]:
        """Return the texts of the expressions."""
        return self._codes.keys()

    def prepare(self, files: ExpansionFiles, *, only_answers: bool = False) -> Prepared:
        """Find the answers, read and parse the included files, and compile expressions.

        Args:
            files: Answers to requests.
            only_answers: Whether the process has trees and compiled expressions.
        """
        prepared = Prepared()
        for words in self._requests:
            with suppress(UrdftoolError, OSError, ValueError):
                prepared.answers[words] = _find_answer(files, words, parse=not only_answers)
        if only_answers:
            return prepared
        self._compile(trusted=files.trusted)
        prepared.codes = {text: code for text, code in self._codes.items() if code is not None}
        return prepared

    def _compile(self, *, trusted: bool) -> None:
        """Compile the expressions of which only the text is known."""
        for text in [text for text, code in self._codes.items() if code is None]:
            try:
                self._codes[text] = compile_expression(text, trusted=trusted)
            except Exception:  # the expansion reports it
                del self._codes[text]

    def add_request(self, name: str, arguments: Iterable[str]) -> None:
        """Store a request that was answered."""
        words = name, *arguments
        if name in ANSWERED and len(self._requests) < _MAX_REQUESTS:
            self._requests[words] = None

    def finish(self, prepared: Prepared, used: Any, texts: Any) -> None:
        """Remove the answers that an expansion did not use, and store its expressions.

        Raises:
            TypeError, LookupError: A value is not as expected.
        """
        answered = list(prepared.answers)
        unused = set(answered).difference([answered[index] for index in used])
        self._requests = {words: None for words in self._requests if words not in unused}
        room = _MAX_EXPRESSIONS - len(self._codes)
        for text in texts[: max(room, 0)]:
            if type(text) is str and len(text) <= MAX_TEXT:
                self._codes.setdefault(text, None)


def _find_answer(files: ExpansionFiles, words: Words, *, parse: bool) -> Any:
    name, *arguments = words
    if name != "include":
        return files.requests[name](*arguments)
    index, file = files.read_xml(*arguments)
    if parse and file.tree is None:
        file.tree = parse_xacro(file)
    return index


def get_last_expansion(
    files: ExpansionFiles, file: SourceFile, arguments: dict[str, str]
) -> LastExpansion:
    """Return what is remembered of a description with its arguments, in its workspace."""
    key = LastExpansion, file.path, files.trusted, *sorted(arguments.items())
    return files.get_kept(key, LastExpansion)
