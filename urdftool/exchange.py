"""Exchange of two names in a file system in one step, where the system can do it."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

_UNSUPPORTED = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP)
_AT_CURRENT_FOLDER = -100  # AT_FDCWD of Linux
_LINUX_EXCHANGE = 2  # RENAME_EXCHANGE of renameat2(2) of Linux
_MACOS_SWAP = 2  # RENAME_SWAP of renamex_np of macOS


def exchange_names(one: Path, other: Path) -> bool:
    """Exchange the names of two files or folders: at each moment both names exist.

    Returns:
        Whether the names are exchanged; False if the system cannot do it.

    Raises:
        OSError: A path does not exist or must not be renamed.
    """
    function = "renameat2" if sys.platform == "linux" else "renamex_np"
    if sys.platform not in ("linux", "darwin"):
        return False
    import ctypes

    call = getattr(ctypes.CDLL(None, use_errno=True), function, None)
    if call is None:
        return False
    first, second = os.fsencode(one), os.fsencode(other)
    if sys.platform == "linux":
        here = _AT_CURRENT_FOLDER
        result = call(here, first, here, second, ctypes.c_uint(_LINUX_EXCHANGE))
    else:
        result = call(first, second, ctypes.c_uint(_MACOS_SWAP))
    if result == 0:
        return True
    number = ctypes.get_errno()
    if number in _UNSUPPORTED:
        return False
    raise OSError(number, os.strerror(number), str(one), None, str(other))
