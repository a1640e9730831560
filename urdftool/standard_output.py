"""Results on standard output: complete texts."""

from __future__ import annotations

import os
import sys

from .errors import OutputError


def write_stdout(text: str) -> None:
    """Write a complete text, also if PYTHONUNBUFFERED causes partial writes.

    Raises:
        OutputError: The reader of standard output has closed it.
    """
    stream = getattr(sys.stdout, "buffer", None)
    try:
        sys.stdout.flush()
        if stream is None:
            sys.stdout.write(text)
        else:
            rest = memoryview(text.encode("utf-8"))
            while rest:
                rest = rest[stream.write(rest) or 0 :]
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OutputError("standard output was closed before all output was written") from None
