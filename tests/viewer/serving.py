"""``urdftool view`` in a process of its own."""

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager


def free_port():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


@contextmanager
def served(*words, port=None, expect=130):
    """Serve a page; gives its URL, and ends it with Ctrl-C."""
    process = subprocess.Popen(
        [sys.executable, "-m", "urdftool", "view", *map(str, words), "--port",
         str(port or free_port())],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    try:
        url = process.stdout.readline().strip()
        if not url:
            raise AssertionError(process.stderr.read())
        yield url
    finally:
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
        if expect is not None and not sys.exc_info()[1]:
            # a shell reports the signal as 130, too
            codes = (130, -signal.SIGINT) if expect == 130 else (expect,)
            assert process.returncode in codes, (process.returncode, err)
            assert out == "", out
            assert "Traceback" not in err, err


def wait_for(condition, patience=20.0):
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError("it never came true")
