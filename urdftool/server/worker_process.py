"""The checking process as the protocol process sees it: asked, watched, killed, started again."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from .frames import pack, unpack_length

PATIENCE = 60.0
"""Time [s] without an answer after which the process is killed; chosen: the limit of an expansion,
which the process keeps by itself, is far below."""

_TRIES = 2
"""Processes that are asked the same question; chosen, it may be what ends them."""

_START = "import sys; sys.path[:] = sys.argv[1:]; from urdftool.server.worker import serve; serve()"

Report = Callable[[str], None]
Receive = Callable[[Any], None]


class _Waiting:
    """Question that waits for its answer."""

    def __init__(self, receive: Receive | None) -> None:
        self.answer: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()
        self.receive = receive


class WorkerProcess:
    """Questions to the checking process.

    Attributes:
        documents: Text of each open document by path; sent with the next question if it changed.
        starts: Number of times that the process was started.
    """

    def __init__(self, report: Report, patience: float = PATIENCE) -> None:
        """Create the object; the process starts with the first question.

        Args:
            report: Receives a sentence when the process is killed or finds a bug.
            patience: Time [s] without an answer after which it is killed.
        """
        self.documents: dict[str, str] = {}
        self.starts = 0
        self._settings: Mapping[str, Any] | None = None
        self._unsent: dict[str, str | None] = {}
        self._waiting: dict[int, _Waiting] = {}
        self._number = 0
        self._process: asyncio.subprocess.Process | None = None
        self._starting = asyncio.Lock()
        self._report, self._patience = report, patience
        self._answered = 0.0
        self._endless = 0
        self._tasks: set[asyncio.Task[None]] = set()

    def set_document(self, path: str, text: str | None) -> None:
        """Store the text of a document; None closes it."""
        if text is None:
            self.documents.pop(path, None)
        else:
            self.documents[path] = text
        self._unsent[path] = text

    async def configure(self, settings: Mapping[str, Any]) -> None:
        """Send settings, also to each process that is started later."""
        self._settings = settings
        await self.ask("configure", settings)

    async def ask(
        self, method: str, params: Mapping[str, Any], receive: Receive | None = None
    ) -> Any:
        """Ask a question and return its answer; None if there is none.

        What waits when the process ends is asked again, except for a question that does not end.
        """
        for _ in range(_TRIES):
            await self._ensure_started()
            answer = await self._send(method, params, receive)
            if not answer.get("died"):
                break
        if "bug" in answer:
            self._report(f"'{method}' failed; please report it:\n{answer['bug']}")
        if "error" in answer:
            self._report(answer["error"])
        return answer.get("result")

    async def _send(
        self, method: str, params: Mapping[str, Any], receive: Receive | None
    ) -> dict[str, Any]:
        self._number += 1
        number = self._number
        waiting = self._waiting[number] = _Waiting(receive)
        documents, self._unsent = self._unsent, {}
        message = {"id": number, "method": method, "params": params, "documents": documents}
        loop = asyncio.get_running_loop()
        if len(self._waiting) == 1:
            self._answered = loop.time()
        process = self._process
        if process is None or process.stdin is None:
            return {"id": number, "result": None}
        with suppress(ConnectionError):
            process.stdin.write(pack(message))
        return await waiting.answer

    async def _ensure_started(self) -> None:
        async with self._starting:
            if self._process is not None and self._process.returncode is None:
                return
            self.starts += 1
            self._process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-c", _START, *sys.path),
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
            )
            self._unsent = dict(self.documents)
            self._start_task(self._read(self._process))
            self._start_task(self._watch(self._process))
            if self._settings is not None and self.starts > 1:
                await self._send("configure", self._settings, None)

    def _start_task(self, work: Any) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        """Pass on what the process sends, until it ends."""
        assert process.stdout is not None
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                length = unpack_length(await process.stdout.readexactly(4))
                self._receive(await process.stdout.readexactly(length))
        await process.wait()
        for number in list(self._waiting):
            self._finish(number, {"id": number, "result": None, "died": number != self._endless})

    def _receive(self, data: bytes) -> None:
        answer = json.loads(data)
        self._answered = asyncio.get_running_loop().time()
        waiting = self._waiting.get(answer["id"])
        if waiting is None:
            return
        if "part" in answer:
            if waiting.receive is not None:
                waiting.receive(answer["part"])
        else:
            self._finish(answer["id"], answer)

    def _finish(self, number: int, answer: dict[str, Any]) -> None:
        waiting = self._waiting.pop(number)
        if not waiting.answer.done():
            waiting.answer.set_result(answer)

    async def _watch(self, process: asyncio.subprocess.Process) -> None:
        """Kill the process when it does not answer."""
        loop = asyncio.get_running_loop()
        while process.returncode is None:
            await asyncio.sleep(self._patience / 10)
            if self._waiting and loop.time() - self._answered > self._patience:
                self._endless = min(self._waiting)  # it answers one after the other
                self._report(f"a check took longer than {self._patience:g} s and was ended")
                self.kill()
                return

    def kill(self) -> None:
        """End the process; the next question starts another one."""
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()
