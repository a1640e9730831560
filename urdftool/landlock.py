"""Denial of files and network to this process, by Landlock of Linux.

The process keeps its open files and pipes. The restriction cannot be lifted, and its children
inherit it. See ``landlock(7)``; the numbers below are those of ``linux/landlock.h``.
"""

from __future__ import annotations

import os
import sys

_CREATE_RULESET, _RESTRICT_SELF = 444, 446  # numbers of the system calls, equal on all processors
_VERSION = 1  # flag of the first call: return the version
_NO_NEW_PRIVILEGES = 38  # prctl(2); required of processes without privileges

_FILE_RIGHTS = {1: 13, 2: 14, 3: 15, 5: 16}
_NETWORK_RIGHTS = {4: 2}  # TCP: bind and connect
_SCOPES = {6: 2}  # abstract UNIX sockets, signals
"""Number of rights by the version that introduced them."""


def disable_files_and_network() -> bool:
    """Disable all files, programs, TCP connections and signals to other processes.

    Returns:
        Whether the system supports it.
    """
    if sys.platform != "linux":
        return False
    import ctypes

    library = ctypes.CDLL(None)
    version = library.syscall(_CREATE_RULESET, None, 0, _VERSION)
    if version < 1:
        return False
    rights = [_count(table, version) for table in (_FILE_RIGHTS, _NETWORK_RIGHTS, _SCOPES)]
    while not rights[-1]:
        rights.pop()
    masks = (ctypes.c_uint64 * len(rights))(*((1 << count) - 1 for count in rights))
    rules = library.syscall(_CREATE_RULESET, ctypes.byref(masks), ctypes.sizeof(masks), 0)
    if rules < 0:
        return False
    denied = not library.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    denied = denied and not library.syscall(_RESTRICT_SELF, rules, 0)
    os.close(rules)
    return denied


def _count(rights: dict[int, int], version: int) -> int:
    return max((count for since, count in rights.items() if since <= version), default=0)
