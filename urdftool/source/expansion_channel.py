"""Channel to a process that is not trusted: JSON and bytes, limited in size and time."""

from __future__ import annotations

import json
import os
import sys
from contextlib import suppress
from typing import Any

MAX_VALUES = 8_000_000
"""Maximum number of separators in an answer; chosen, for 1 GB of memory."""

_HEAD = 16  # bytes: lengths of JSON and data, each as 8 digits in base 16


class Ended(Exception):  # noqa: N818 -- reads as what happened
    """Signal that the other end of a channel is closed."""


class Channel:
    """Two pipes that carry JSON values, each with bytes."""

    def __init__(self, source: int, target: int, patience: float | None = None) -> None:
        """Set the file descriptors to read from and to write to.

        Args:
            source: File descriptor to read from.
            target: File descriptor to write to.
            patience: Time [s] without an answer after which the other end counts as closed.
        """
        self._source, self._target, self._patience = source, target, patience

    def send(self, value: Any, data: bytes = b"") -> None:
        """Send a value.

        Raises:
            OSError: The other end is closed.
        """
        text = json.dumps(value, check_circular=False).encode("ascii")
        rest = memoryview(b"%08x%08x" % (len(text), len(data)) + text + data)
        while rest:
            rest = rest[os.write(self._target, rest) :]

    def receive(self, most: int = sys.maxsize) -> tuple[Any, bytes]:
        """Return the next value, of at most ``most`` bytes.

        Raises:
            Ended: The other end is closed, or sent more than ``most``.
        """
        head = self._read(_HEAD)
        length, size = int(head[:8], 16), int(head[8:], 16)
        if length + size > most:
            raise Ended
        text, data = self._read(length), self._read(size)
        if most < sys.maxsize:
            values = sum(part.count(sign) for part in (text, data) for sign in (b",", b"[", b"{"))
            if values > MAX_VALUES:
                raise Ended
        return json.loads(text), data

    def _read(self, size: int) -> bytes:
        parts = []
        while size:
            if self._patience is not None:
                self._wait(self._patience)
            part = os.read(self._source, min(size, 1 << 20))
            if not part:
                raise Ended
            parts.append(part)
            size -= len(part)
        return b"".join(parts)

    def _wait(self, seconds: float) -> None:
        """Wait until there is something to read."""
        import select

        if hasattr(select, "poll"):  # not on Windows
            poll = select.poll()
            poll.register(self._source, select.POLLIN)
            if not poll.poll(seconds * 1000):
                raise Ended

    def close(self) -> None:
        """Close both pipes."""
        for end in (self._source, self._target):
            with suppress(OSError):
                os.close(end)
