"""Process that keeps the process of the next expansion ready.

An editor expands a robot after each change. A fork of the checking process costs a fault for each
page of memory that one of both writes. Here a lean process of its own forks, before the next
change: the fork has its modules and memory, the trees of the files that the last expansions
included, and their compiled expressions. It gives up files, programs and network, waits for a
description, expands it, and ends.

Files are kept by their bytes, expressions by their text: no value of an expansion is in the next.
"""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol

from .expansion_channel import Channel, Ended
from .expansion_handle import ExpansionHandle, make_place
from .location import Place, SourceFile

MAX_KEPT = 8 << 20
"""Size of the included files that are kept [bytes]; chosen, those of 123 real robots have at most
0.5 MB each."""

MAX_TEXTS = 10_000
"""Number of expressions that are kept; chosen, 123 real expansions have at most 700 each."""

_MAX_STARTS = 5  # of the process, if it ends again and again; chosen
_PATIENCE = 30.0  # s without an answer; chosen, one takes milliseconds
_START = (
    "import sys; sys.path[:] = sys.argv[1:]; "
    f"from {__package__}.expansion_server_child import serve; serve()"
)
_FAILURES = (Ended, OSError, ValueError, TypeError, LookupError)


class _Process(Protocol):
    def kill(self) -> None:
        """End the process."""

    def wait(self) -> int:
        """Return its exit code."""


class ExpansionServer:
    """The process that forks, and the one process that waits for a description.

    Attributes:
        used: Processor time [s] of expansions since each was given its description.
        prepared: Processor time [s] of what was done before that.
        patience: Time [s] without an answer after which an expansion counts as ended.
    """

    def __init__(
        self,
        start: Callable[[socket.socket], _Process] | None = None,
        *,
        at_once: bool = False,
    ) -> None:
        """Create the object; the process starts with the first preparation after an expansion."""
        self._is_needed = at_once
        self._starts = 0
        self.used = self.prepared = 0.0
        self.patience: float | None = None
        self._connection: socket.socket | None = None
        self._start = start or _start_interpreter
        self._process: _Process | None = None
        self._owner = os.getpid()
        self._forget()

    def _forget(self) -> None:
        self._kept: dict[tuple[str, bytes], int] = {}
        self._ready: set[int] = set()  # numbers of the files that the waiting process has
        self._count = 0
        self._unsent: list[tuple[int, SourceFile]] = []
        self._dropped: list[int] = []
        self._texts: dict[tuple[bool, str], None] = {}
        self._unsent_texts: list[tuple[bool, str]] = []
        self._modules: set[str] = set()
        self._waits = False

    @property
    def is_usable(self) -> bool:
        """Tell whether this process can use it: on Linux, in the process that made it."""
        return sys.platform == "linux" and os.getpid() == self._owner

    def keep(self, files: Sequence[SourceFile], texts: Iterable[str], *, trusted: bool) -> None:
        """Keep what an expansion used for the processes that are prepared from now on."""
        self._is_needed = True
        for file in files:
            key = file.path, file.data
            number = self._kept.pop(key, None)
            if number is None:
                number = self._count = self._count + 1
                self._unsent.append((number, file))
            self._kept[key] = number  # the last one used is the last
        self._drop_files()
        for text in texts:
            if (trusted, text) not in self._texts and len(self._texts) < MAX_TEXTS:
                self._texts[trusted, text] = None
                self._unsent_texts.append((trusted, text))

    def _drop_files(self) -> None:
        """Drop files that were not used for a while, so that the rest is below ``MAX_KEPT``."""
        size = sum(len(data) for _, data in self._kept)
        for key in list(self._kept):
            if size <= MAX_KEPT:
                return
            size -= len(key[1])
            self._dropped.append(self._kept.pop(key))

    def prepare(self) -> None:
        """Begin to prepare the process of the next expansion, without waiting for it."""
        if self._waits or not self.is_usable or not self._is_needed:
            return
        try:
            if self._process is None:
                if self._starts == _MAX_STARTS:
                    return
                self._starts += 1
                self._begin()
            self._send_preparation()
        except _FAILURES:
            self.close()

    def _begin(self) -> None:
        self._connection, other = socket.socketpair()
        with other:
            self._process = self._start(other)
        number = self._connection.fileno()
        self._channel = Channel(number, number, _PATIENCE)

    def _send_preparation(self) -> None:
        unsent = [(number, file) for number, file in self._unsent if self._is_kept(number, file)]
        message = {
            "do": "prepare",
            "files": [(n, file.path, file.encoding, len(file.data)) for n, file in unsent],
            "drop": self._dropped,
            "texts": self._unsent_texts,
            "modules": sorted(self._modules),
        }
        self._channel.send(message, b"".join(file.data for _, file in unsent))
        self._unsent, self._dropped, self._unsent_texts = [], [], []
        self._ready = set(self._kept.values())
        self._waits = True

    def _is_kept(self, number: int, file: SourceFile) -> bool:
        return self._kept.get((file.path, file.data)) == number

    def start_expansion(
        self,
        job: dict[str, Any],
        data: bytes,
        files: Sequence[SourceFile],
        answers: dict[tuple[str, ...], Any],
    ) -> ServedExpansion | None:
        """Give the waiting process a description, and return it; None if that is not possible."""
        if not self.is_usable or not self._is_needed:
            return None
        try:
            if self._waits and not self._modules.issuperset(job["modules"]):
                self._receive().end()
            self._modules.update(job["modules"])
            self.prepare()
            expansion = self._receive()
            numbers = [self._kept.get((file.path, file.data), 0) for file in files[1:]]
            known = [number if number in self._ready else 0 for number in numbers]
            rest = [file for file, number in zip(files[1:], known, strict=True) if not number]
            more = {
                "known": known,
                "files": [(file.path, file.encoding, len(file.data)) for file in rest],
                "answers": list(answers.items()),
            }
            parts = [data, *(file.data for file in rest)]
            expansion.channel.send({**job, **more, "length": len(data)}, b"".join(parts))
            return expansion
        except _FAILURES:
            self.close()
            return None

    def _receive(self) -> ServedExpansion:
        """Return the process that waits."""
        if not self._waits or self._connection is None:
            raise Ended
        self._waits = False
        value, _ = self._channel.receive()
        self.prepared += float(value["used"])
        _, descriptors, _, _ = socket.recv_fds(self._connection, 1, 2)
        source, target = descriptors
        return ServedExpansion(self, Channel(source, target, self.patience))

    def end_expansion(self) -> tuple[int, tuple[int, int]]:
        """End the process that expands.

        Returns:
            Its exit code, and the index of the file and the first byte of its last element.
        """
        try:
            self._channel.send({"do": "end"})
            value, _ = self._channel.receive()
            self.used += float(value["used"])
            self.prepared += float(value["prepared"])
            return int(value["code"]), (int(value["place"][0]), int(value["place"][1]))
        except _FAILURES:
            self.close()
            return 1, (-1, -1)

    def close(self) -> None:
        """End the processes."""
        process, self._process = self._process, None
        if process is not None and self._connection is not None:
            self._connection.close()
            process.kill()
            process.wait()
        self._forget()


class ServedExpansion(ExpansionHandle):
    """Process that a server prepared."""

    def __init__(self, server: ExpansionServer, channel: Channel) -> None:
        """Set the server and the channel to the process."""
        self.channel = channel
        self._server = server
        self._ended: tuple[int, tuple[int, int]] | None = None

    def find_place(self, files: list[SourceFile]) -> Place | None:
        """Return the location of the last evaluated element; the process ends."""
        self.end()
        assert self._ended is not None
        return make_place(files, *self._ended[1])

    def end(self) -> int:
        """End the process; see :meth:`ExpansionHandle.end`."""
        if self._ended is None:
            self.channel.close()
            self._ended = self._server.end_expansion()
        return self._ended[0]


def _start_interpreter(connection: socket.socket) -> _Process:
    """Start a new interpreter, without the environment of this process."""
    import subprocess

    variables = ("LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH")
    return subprocess.Popen(
        [sys.executable, "-c", _START, *sys.path],
        stdin=connection.fileno(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={name: os.environ[name] for name in variables if name in os.environ},
    )
