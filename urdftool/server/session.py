"""What the checking process knows: open documents, robots of the workspace, their last checks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .actions import list_actions, list_safe_edits
from .checks import Checks
from .completion import list_completions
from .formatting import format_document
from .hover import describe_position
from .knowledge import Knowledge
from .navigation import list_definitions, list_references
from .rename import prepare_rename, rename
from .symbols import list_symbols

Emit = Callable[[Any], None]
Question = Callable[[Knowledge, dict[str, Any]], Any]

_QUESTIONS: dict[str, Question] = {
    "actions": list_actions,
    "completion": list_completions,
    "definition": list_definitions,
    "fix-all": list_safe_edits,
    "format": format_document,
    "hover": describe_position,
    "prepare-rename": prepare_rename,
    "references": list_references,
    "rename": rename,
    "symbols": list_symbols,
}


class Session:
    """Answers to the messages of the protocol process."""

    def __init__(self) -> None:
        """Create a session without documents."""
        self.knowledge = Knowledge()
        self.knowledge.read_robots = self._read_robots

    def set_document(self, path: str, text: str | None) -> None:
        """Store the text of an open document; None for one that was closed."""
        self.knowledge.set_document(path, text)

    def compute_answer(
        self, method: str, params: dict[str, Any], emit: Emit, poll: Callable[[], None]
    ) -> Any:
        """Return the answer to a message, as JSON.

        Raises:
            UrdftoolError: It cannot be answered.
        """
        if method == "configure":
            return self.knowledge.configure(**params)
        if method == "refresh":
            return self.knowledge.refresh()
        if method == "check":
            return Checks(self.knowledge, emit, poll).check(params["paths"])
        self._read_robots(params["path"])
        return _QUESTIONS[method](self.knowledge, params)

    def prepare(self) -> None:
        """Prepare the next check, while there is nothing to answer."""
        self.knowledge.expansion_server.prepare()

    def _read_robots(self, path: str) -> None:
        """Read the robots of a file again, if no check has read them as they are."""
        states = self.knowledge.list_states(path)
        if not states or any(one.version != self.knowledge.version for one in states):
            Checks(self.knowledge, lambda part: None, lambda: None).read(path)
