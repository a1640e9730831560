"""Messages between the two processes: JSON after its length in four bytes."""

from __future__ import annotations

import json
import os
import select
import struct
from collections import deque
from typing import Any

_HEAD = struct.Struct("!I")


class Closed(Exception):  # noqa: N818 -- reads as what happened
    """Signal that the other process closed the pipe."""


def pack(message: Any) -> bytes:
    """Return a message as bytes."""
    data = json.dumps(message).encode("ascii")
    return _HEAD.pack(len(data)) + data


def unpack_length(head: bytes) -> int:
    """Return the length of the message after its first four bytes."""
    return int(_HEAD.unpack(head)[0])


class Inbox:
    """Messages that arrive at a file descriptor; they can be looked at without waiting."""

    def __init__(self, descriptor: int) -> None:
        """Read from a file descriptor."""
        self.descriptor = descriptor
        self.waiting: deque[dict[str, Any]] = deque()
        self._data = bytearray()

    def take(self) -> dict[str, Any]:
        """Wait for the next message and return it.

        Raises:
            Closed: There is none, and the pipe is closed.
        """
        while not self.waiting:
            self._read()
        return self.waiting.popleft()

    def poll(self) -> deque[dict[str, Any]]:
        """Read what has arrived, and return the messages that wait, the oldest first."""
        while select.select([self.descriptor], [], [], 0)[0]:
            self._read()
        return self.waiting

    def _read(self) -> None:
        data = os.read(self.descriptor, 1 << 20)
        if not data:
            raise Closed
        self._data += data
        while len(self._data) >= _HEAD.size:
            end = _HEAD.size + unpack_length(bytes(self._data[: _HEAD.size]))
            if len(self._data) < end:
                break
            self.waiting.append(json.loads(self._data[_HEAD.size : end]))
            del self._data[:end]
