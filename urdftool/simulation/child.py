"""An engine in a process of its own: it may crash or hang, and the tool goes on.

The parent writes what is to be done to the child's standard input and reads what it tells, and the
answer at last, from its standard output, all pickled; what the engine prints goes to a file that is
read if it dies.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from queue import Empty, SimpleQueue
from threading import TIMEOUT_MAX, Thread
from time import monotonic
from typing import Any

from ..errors import UrdftoolError

_PARENT_ENDED = 1  # PR_SET_PDEATHSIG of prctl(2)

MODULES = __package__

_DYING = 2.0  # s
_AGES = 1e9  # s

_TOLD, _ANSWER, _DIED = "told", "answer", "died"

_READY = b"\0urdftool listens\n"
"""Said before anything else; what comes before it was printed while Python started."""

_START = f"import sys; sys.path[:] = sys.argv[2:]; from {__name__} import main; main()"
"""Python looks for modules where the parent does, and not in the folder it is started in."""


class EngineDied(UrdftoolError):  # noqa: N818 -- reads as what happened
    """The engine ended without an answer, or took too long."""


class Child:
    """A process that waits for a job; made early, it starts while the parent still prepares.

    Use it in a ``with``: however that ends, the process has ended, too.
    """

    def __init__(self, library: str) -> None:
        """Start the process, which imports an engine's library while it waits."""
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 -- closed in __exit__
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _START, library, *sys.path],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
        except BaseException:
            self._errors.close()
            raise
        self._listener: Thread | None = None

    def __enter__(self) -> Child:
        """Itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """End it; once it has ended, this does nothing."""
        if self._errors.closed:
            return
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        if self._listener is not None:
            self._listener.join()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(OSError):  # what it did not read is lost
                pipe.close()  # type: ignore[union-attr]
        self._errors.close()

    def call(
        self,
        module: str,
        function: str,
        *arguments: Any,
        time_limit: float,
        hear: Callable[[Any], None] | None = None,
    ) -> Any:
        """What a function of this package returns, called in the process.

        Args:
            module: Of this package, such as ``bullet``.
            function: In it.
            arguments: Anything that pickles.
            time_limit: The longest it may take [s].
            hear: Is given what the function tells before it returns; if so, it is given ``tell``.

        Raises:
            EngineDied: It took longer, or the process ended.
            UrdftoolError: As the function.
        """
        job = (f"{MODULES}.{module}", function, arguments, time_limit, hear is not None)
        said: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        listener = Thread(target=self._talk, args=(pickle.dumps(job), said), daemon=True)
        try:
            listener.start()
        except RuntimeError as error:  # the system gives no more threads
            raise EngineDied(f"the engine could not be given its work: {error}") from None
        self._listener = listener
        ends = monotonic() + min(time_limit, TIMEOUT_MAX)
        while True:
            try:
                kind, value = said.get(timeout=max(0.0, ends - monotonic()))
            except Empty:
                raise EngineDied(
                    f"the engine was not done after {time_limit:g} s and was ended; give it more "
                    "with --time-limit, or less to do with --duration"
                ) from None
            if kind == _DIED or (kind == _ANSWER and self._process.wait()):
                raise self._death()
            if kind == _ANSWER:
                break
            if hear is not None:
                hear(value)
        if isinstance(value, BaseException):
            raise value
        return value

    def _talk(self, job: bytes, said: SimpleQueue[tuple[str, Any]]) -> None:
        """Give the process its job, and pass on what it says, to its end."""
        pipes = self._process.stdin, self._process.stdout
        assert pipes[0] is not None
        assert pipes[1] is not None
        try:
            pipes[0].write(job)
            pipes[0].flush()  # and left open: that it closes tells the process that we ended
            for line in pipes[1]:
                if line.endswith(_READY):
                    break
            kind = ""
            while kind != _ANSWER:
                kind, value = pickle.load(pipes[1])
                said.put((kind, value))
        except Exception:  # whatever is not whole: it died
            said.put((_DIED, None))

    def _death(self) -> EngineDied:
        try:
            self._process.wait(timeout=_DYING)
        except subprocess.TimeoutExpired:  # what it said made no sense
            self._process.kill()
            self._process.wait()
        self._errors.seek(0)
        lines = self._errors.read().decode("utf-8", "replace").strip().splitlines()
        code = self._process.returncode
        how = f"exit code {code}"
        if code < 0:
            with suppress(ValueError):
                how = signal.Signals(-code).name
        return EngineDied(
            f"the engine died ({how}) without an answer; 'urdftool lint' may say what it choked on",
            notes=[line[:200] for line in lines[-3:]],
        )


def main() -> None:
    """Do one job."""
    if sys.platform == "linux":  # end with the parent, however it ends
        import ctypes

        ctypes.CDLL(None).prctl(_PARENT_ENDED, signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the parent, which ends its child
    answer = os.dup(1)
    os.dup2(2, 1)
    os.write(answer, _READY)
    import numpy  # noqa: F401 -- while the parent prepares

    with suppress(ImportError):
        import_module(sys.argv[1])
    module, function, arguments, time_limit, heard = pickle.load(sys.stdin.buffer)
    with suppress(RuntimeError):  # there may be no more threads
        Thread(target=_end_with_parent, daemon=True).start()
    _limit_time(time_limit)
    with os.fdopen(answer, "wb") as out:

        def tell(value: Any, kind: str = _TOLD) -> None:
            pickle.dump((kind, value), out)
            out.flush()

        try:
            more = {"tell": tell} if heard else {}
            result = getattr(import_module(module), function)(*arguments, **more)
        except UrdftoolError as error:
            result = error
        tell(result, _ANSWER)
    os._exit(0)  # an engine's own way out may crash


def _end_with_parent() -> None:
    """Wait until nobody holds the other end of standard input, and end."""
    with suppress(OSError):
        os.read(0, 1)  # not of sys.stdin, whose lock Python wants when it ends
    os._exit(1)


def _limit_time(seconds: float) -> None:
    """End the process after so much processor time [s], should the parent be gone."""
    try:
        import resource
    except ImportError:  # Windows: the parent's watch is all there is
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    most = int(min(seconds, _AGES)) + 5
    with suppress(ValueError):  # there is a lower one
        resource.setrlimit(resource.RLIMIT_CPU, (most, most + 1))
