"""An engine in a process of its own: it may crash or hang, and the tool goes on.

The parent writes what is to be done to the child's standard input and reads the answer from its
standard output, both pickled; what the engine prints goes to a file that is read if it dies.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
from contextlib import suppress
from importlib import import_module
from typing import Any

from ..errors import UrdftoolError

_PARENT_ENDED = 1  # PR_SET_PDEATHSIG of prctl(2)

MODULES = __package__


class EngineDied(UrdftoolError):  # noqa: N818 -- reads as what happened
    """The engine ended without an answer, or took too long."""


class Child:
    """A process that waits for a job; made early, it starts while the parent still prepares.

    Use it in a ``with``: however that ends, the process has ended, too.
    """

    def __init__(self, library: str) -> None:
        """Start the process, which imports an engine's library while it waits."""
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 -- closed in __exit__
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, library],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )

    def __enter__(self) -> Child:
        """Itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """End it; once it has ended, this does nothing."""
        if self._errors.closed:
            return
        if self._process.poll() is None:
            self._process.kill()
        self._process.communicate()
        self._errors.close()

    def call(self, module: str, function: str, *arguments: Any, time_limit: float) -> Any:
        """What a function of this package returns, called in the process.

        Args:
            module: Of this package, such as ``bullet``.
            function: In it.
            arguments: Anything that pickles.
            time_limit: The longest it may take [s].

        Raises:
            EngineDied: It took longer, or the process ended.
            UrdftoolError: As the function.
        """
        job = pickle.dumps((f"{MODULES}.{module}", function, arguments, time_limit))
        try:
            out, _ = self._process.communicate(job, timeout=time_limit)
        except subprocess.TimeoutExpired:
            raise EngineDied(
                f"the engine was not done after {time_limit:g} s and was ended; give it more with "
                "--time-limit, or less to do with --duration"
            ) from None
        if self._process.returncode or not out:
            raise self._death()
        answer = pickle.loads(out)
        if isinstance(answer, BaseException):
            raise answer
        return answer

    def _death(self) -> EngineDied:
        self._errors.seek(0)
        lines = self._errors.read().decode("utf-8", "replace").strip().splitlines()
        code = self._process.returncode
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
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
    import numpy  # noqa: F401 -- while the parent prepares

    with suppress(ImportError):
        import_module(sys.argv[1])
    module, function, arguments, time_limit = pickle.load(sys.stdin.buffer)
    _limit_time(time_limit)
    try:
        result = getattr(import_module(module), function)(*arguments)
    except UrdftoolError as error:
        result = error
    with os.fdopen(answer, "wb") as out:
        pickle.dump(result, out)
        out.flush()
    os._exit(0)  # an engine's own way out may crash


def _limit_time(seconds: float) -> None:
    """End the process after so much processor time [s], should the parent be gone."""
    try:
        import resource
    except ImportError:  # Windows: the parent's watch is all there is
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 5, int(seconds) + 6))


if __name__ == "__main__":
    main()
