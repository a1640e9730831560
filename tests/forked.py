"""Processes of Python as forks of this one, which has imported what they would import."""

import gc
import os
import signal
import subprocess
import sys
import traceback
from time import monotonic, sleep


class ForkedPython:
    """Fork of this process in place of ``Popen([sys.executable, "-c", CODE, *ARGUMENTS])``.

    The libraries that this process has imported read their settings then, and so do not see the
    environment of the fork.
    """

    def __init__(self, words, *, stdin, stdout, stderr, env):
        """Start it; standard input and output are pipes."""
        assert words[:2] == [sys.executable, "-c"]
        assert stdin == stdout == subprocess.PIPE
        self.returncode = None
        requests, answers = os.pipe(), os.pipe()
        self.pid = os.fork()
        if not self.pid:
            _run(words[2], ["-c", *words[3:]], env, (requests[0], answers[1], stderr.fileno()))
        os.close(requests[0])
        os.close(answers[1])
        self.stdin = os.fdopen(requests[1], "wb", buffering=0)
        self.stdout = os.fdopen(answers[0], "rb")

    def poll(self):
        """The exit code; None while it runs."""
        return self._wait(os.WNOHANG)

    def wait(self, timeout=None):
        """Wait for its exit code."""
        until = None if timeout is None else monotonic() + timeout
        while (code := self._wait(0 if until is None else os.WNOHANG)) is None:
            if monotonic() > until:
                raise subprocess.TimeoutExpired("fork", timeout)
            sleep(0.005)
        return code

    def kill(self):
        """End it."""
        if self.poll() is None:
            os.kill(self.pid, signal.SIGKILL)

    def _wait(self, options):
        if self.returncode is None:
            pid, status = os.waitpid(self.pid, options)
            if pid:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode


def _run(code, words, environment, streams):
    """Run the code in the fork, and exit."""
    try:
        gc.freeze()  # what exists is not copied by a collection
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
        os.closerange(3, os.sysconf("SC_OPEN_MAX"))
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        sys.argv = words
        sys.stdin, sys.stdout, sys.stderr = (os.fdopen(n, mode) for n, mode in enumerate("rww"))
        os.environ.clear()
        os.environ.update(environment)
        exec(code, {"__name__": "__main__"})
        os._exit(0)
    except BaseException:
        traceback.print_exc(file=sys.stderr)
        sys.stderr.flush()
    finally:
        os._exit(1)
