"""Files that a workspace refuses: the error for them, and those that may never end."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Any


class AccessRefused(OSError):  # noqa: N818 -- reads as what happened
    """Error for a file that may not be read; ``strerror`` is the reason."""

    def __init__(self, reason: str, path: str | Path) -> None:
        """Store the reason and the path."""
        super().__init__(errno.EACCES, reason, os.fspath(path))

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle with both arguments."""
        return AccessRefused, (self.strerror, self.filename)


IRREGULAR = "is a device or a pipe, not a file"
"""Reason for which no command reads a file that may never end."""

_KERNEL = ("/proc/", "/sys/")
"""Folders of Linux whose files wait, or have no size and no end, although they look regular."""

_STREAMS = ("/dev/fd/", "/proc/self/fd/")


def is_irregular(path: str | Path) -> bool:
    """Tell whether a path leads to a device, pipe, socket or kernel file, without opening it."""
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):
        return False
    if stat.S_ISDIR(mode):
        return False
    return not stat.S_ISREG(mode) or os.path.realpath(path).startswith(_KERNEL)


def is_stream(path: str | Path) -> bool:
    """Tell whether a path is an open stream of this process, such as ``<(command)`` of a shell.

    A named pipe, which may have no writer, is none.
    """
    name = os.fspath(path)
    if name != "/dev/stdin" and not name.startswith(_STREAMS):
        return False
    try:
        return not stat.S_ISBLK(os.stat(path).st_mode)
    except (OSError, ValueError):
        return False
