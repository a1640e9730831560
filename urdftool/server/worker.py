"""Process that checks descriptions and answers questions about them, one after the other."""

from __future__ import annotations

import gc
import os
import traceback
from collections.abc import Callable
from typing import Any

from ..errors import UrdftoolError
from ..isolated import begin
from .frames import Closed, Inbox, pack
from .session import Session


class CheckEnded(Exception):  # noqa: N818 -- reads as what happened
    """Signal that a newer check waits, which makes the present one useless."""


def serve() -> None:
    """Handle the messages of standard input until it ends; the main function of the process.

    Standard output is kept for answers: what a library prints goes to standard error.
    """
    begin()
    gc.disable()  # ``run`` collects after each answer, so that memory stays as it is
    answers = os.dup(1)
    os.dup2(2, 1)
    Worker(Inbox(0), lambda data: _write(answers, data)).run()


def _write(descriptor: int, data: bytes) -> None:
    while data:
        data = data[os.write(descriptor, data) :]


class Worker:
    """Answers to messages."""

    def __init__(self, inbox: Inbox, send: Callable[[bytes], None]) -> None:
        """Create a worker without documents."""
        self.inbox = inbox
        self.send = send
        self.session = Session()

    def run(self) -> None:
        """Handle messages until the other process ends."""
        try:
            while True:
                self._send_answer(self.inbox.take())
                self.session.prepare()
                gc.collect()
        except (Closed, BrokenPipeError):
            return

    def _send_answer(self, question: dict[str, Any]) -> None:
        number = question["id"]
        for path, text in question.get("documents", {}).items():
            self.session.set_document(path, text)

        def emit(part: Any) -> None:
            self.send(pack({"id": number, "part": part}))

        try:
            result = self.session.compute_answer(
                question["method"], question["params"], emit, self._poll
            )
            answer = {"id": number, "result": result}
        except CheckEnded:
            answer = {"id": number, "result": None, "ended": True}
        except UrdftoolError as error:
            answer = {"id": number, "result": None, "error": error.message}
        except (Closed, BrokenPipeError):
            raise
        except Exception:
            answer = {"id": number, "result": None, "bug": traceback.format_exc(limit=-6)}
        self.send(pack(answer))

    def _poll(self) -> None:
        """Stop the present check if a newer one waits.

        Raises:
            CheckEnded: A check waits.
        """
        if any(question["method"] == "check" for question in self.inbox.poll()):
            raise CheckEnded
