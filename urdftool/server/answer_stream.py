"""Stream of answers to an editor, which may stop reading."""

from __future__ import annotations

import os
import sys
import threading
from collections import deque

MAX_UNSENT = 64 << 20
"""Size [bytes] of answers that an editor has not read; chosen: a large one has 1 MB."""

_PATIENCE = 5.0
"""Time [s] that the editor has for the last answers when the server ends; chosen."""


class AnswerStream:
    """Binary stream that a thread writes, so that the server does not wait for the editor.

    The process ends when the editor leaves more than a limit unread: it would only grow.
    """

    def __init__(self, descriptor: int, limit: int = MAX_UNSENT) -> None:
        """Start the thread."""
        self._descriptor, self._limit = descriptor, limit
        self._parts: deque[bytes] = deque()
        self._unsent = 0
        self._is_closed = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def write(self, data: bytes) -> int:
        """Append bytes; return their number."""
        with self._changed:
            self._parts.append(data)
            self._unsent += len(data)
            self._changed.notify_all()
            is_stuck = self._unsent > self._limit
        if is_stuck:
            end_process(f"the editor left more than {self._limit >> 20} MiB of answers unread")
        return len(data)

    def flush(self) -> None:
        """Return immediately; the thread writes."""

    def close(self) -> None:
        """Wait until all is written, for a limited time; the thread ends."""
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()
        self._thread.join(_PATIENCE)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._parts or self._is_closed)
                if not self._parts:
                    return
                data = self._parts.popleft()
            try:
                _write_all(self._descriptor, data)
            except OSError:
                end_process("")  # the editor is gone
            with self._changed:
                self._unsent -= len(data)
                self._changed.notify_all()


def _write_all(descriptor: int, data: bytes) -> None:
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]


def end_process(reason: str) -> None:
    """End this process immediately; its children end with it."""
    if reason:
        sys.stderr.write(f"urdftool server: {reason}\n")
    os._exit(1 if reason else 0)
