"""The process that forks the processes of expansions, and these until they expand."""

from __future__ import annotations

import gc
import mmap
import os
import signal
import socket
import struct
import time
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

from ..parallel import ignore_interrupts
from ..resident_memory import get_heap, list_writable_ranges, map_pages
from .expansion_channel import Channel, Ended
from .expansion_child import close_files, expand_job, import_modules, restrict_process
from .expansion_requests import PLACE
from .expressions import Expression, compile_expression
from .last_expansion import Prepared
from .location import SourceFile
from .xacro_parse import parse_xacro
from .xacro_tree import XacroElement

MODULES = (
    "ctypes",
    "urdftool.source.tags",
    "difflib",
    "resource",
    "unicodedata",
    "xml.parsers.expat",
)
_READY = struct.Struct("d")  # processor time [s] of a process when it is ready


def serve() -> NoReturn:
    """Serve the checking process until it ends; the main function of a new interpreter."""
    with socket.socket(fileno=os.dup(0)) as connection:
        os.dup2(1, 0)  # the null device
        serve_connection(connection)
    os._exit(0)


def serve_connection(connection: socket.socket) -> None:
    """Serve a connection until the other side closes it."""
    ignore_interrupts()
    gc.disable()
    import_modules(MODULES)
    server = _Server(connection)
    with suppress(Ended, OSError):
        server.run()
    server.end()


class _Server:
    """Files and expressions by what they are, and the process that was forked last."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._channel = Channel(connection.fileno(), connection.fileno())
        self._files: dict[int, SourceFile] = {}
        self._codes: dict[bool, dict[str, Expression]] = {False: {}, True: {}}
        self._pid: int | None = None
        self._mark = mmap.mmap(-1, PLACE.size + _READY.size)
        self._counted = 0.0
        self._split_text = import_module(".xacro_hooks", __package__).split_text

    def run(self) -> None:
        """Handle messages."""
        while True:
            message, data = self._channel.receive()
            if message["do"] == "prepare":
                self._keep(message, data)
                self._start_fork()
            else:
                self._channel.send(self.end())

    def _count_time(self) -> float:
        """Return the processor time of this process since the last call [s]."""
        before, self._counted = self._counted, time.process_time()
        return self._counted - before

    def _keep(self, message: dict[str, Any], data: bytes) -> None:
        """Parse the files and compile the expressions of a message, and drop what it names."""
        import_modules(message["modules"])
        for number in message["drop"]:
            self._files.pop(number, None)
        start = 0
        for number, path, encoding, length in message["files"]:
            file = SourceFile(path, data[start : start + length], encoding)
            start += length
            with suppress(Exception):  # the expansion reports it
                file.tree = tree = parse_xacro(file)
                self._split_values(tree.documentElement)
            self._files[number] = file
        for trusted, text in message["texts"]:
            with suppress(Exception):  # the expansion reports it
                self._codes[trusted][text] = compile_expression(text, trusted=trusted)

    def _split_values(self, element: XacroElement) -> None:
        """Find the expressions in the attributes of an element and those below it."""
        for value in element.attributes.values():
            if "$" in value:
                self._split_text(value)
        for child in element.childNodes:
            if isinstance(child, XacroElement):
                self._split_values(child)

    def _start_fork(self) -> None:
        """Start the process of the next expansion, and send its ends of two pipes."""
        self.end()
        requests, answers = os.pipe(), os.pipe()
        self._mark[:] = bytes(len(self._mark))
        self._pid = os.fork()
        if not self._pid:
            code = 1
            try:
                self._run_fork(Channel(answers[0], requests[1]), (answers[0], requests[1]))
                code = 0
            finally:
                os._exit(code)
        self._channel.send({"used": self._count_time()})
        socket.send_fds(self._connection, [b"f"], [requests[0], answers[1]])
        for end in (*requests, *answers):
            os.close(end)

    def _run_fork(self, channel: Channel, descriptors: tuple[int, int]) -> None:
        """Restrict this process, wait for a description, and expand it."""
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        close_files(keep=descriptors)
        ranges = list_writable_ranges()
        restrict_process()
        reserve = get_heap()
        map_pages(ranges)
        _READY.pack_into(self._mark, PLACE.size, time.process_time())
        job, data = channel.receive()
        included = self._find_files(job, memoryview(data)[job["length"] :])
        prepared = Prepared()
        prepared.answers = {tuple(words): value for words, value in job["answers"]}
        prepared.codes = self._codes[job["trusted"]]
        expand_job(job, data[: job["length"]], channel, self._mark, included, prepared)
        del reserve

    def _find_files(self, job: dict[str, Any], data: memoryview) -> list[SourceFile]:
        """Return the included files of a job: those that are kept, and those that were sent."""
        sent = []
        for path, encoding, length in job["files"]:
            sent.append(SourceFile(path, bytes(data[:length]), encoding))
            data = data[length:]
        rest = iter(sent)
        return [self._files[number] if number else next(rest) for number in job["known"]]

    def end(self) -> dict[str, Any]:
        """End the forked process; return its exit code, last place and processor time [s]."""
        if self._pid is None:
            return {"code": 1, "place": (-1, -1), "used": 0.0, "prepared": 0.0}
        with suppress(ProcessLookupError):
            os.kill(self._pid, signal.SIGKILL)
        _, status, usage = os.wait4(self._pid, 0)
        self._pid = None
        prepared = _READY.unpack_from(self._mark, PLACE.size)[0]
        return {
            "code": os.waitstatus_to_exitcode(status),
            "place": PLACE.unpack_from(self._mark),
            "prepared": prepared,
            "used": usage.ru_utime + usage.ru_stime - prepared + self._count_time(),
        }
