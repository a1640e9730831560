"""Memory of this process that exists before it is used, so that its first use causes no fault."""

from __future__ import annotations

import sys
from contextlib import suppress

_POPULATE_WRITE = 23  # source: MADV_POPULATE_WRITE of madvise(2), since Linux 5.14
_HEAP = 16 << 20
"""Memory that an expansion gets without a fault [bytes]; chosen, the largest of 123 real ones
needs 14 MiB."""

_PIECE = 256  # bytes; chosen: Python takes up to 512 of its arenas
_ARENA = 1 << 20  # bytes; source: an arena of Python 3.10, kept as long as a piece is used


def list_writable_ranges() -> list[tuple[int, int]]:
    """Return the private memory that this process may write, as addresses and lengths [bytes]."""
    found = []
    with suppress(OSError), open("/proc/self/maps", encoding="ascii", errors="replace") as lines:
        for line in lines:
            span, mode = line.split()[:2]
            if mode.startswith("rw") and mode.endswith("p") and "[" not in line[-20:]:
                start, end = (int(word, 16) for word in span.split("-"))
                found.append((start, end - start))
    return found


def map_pages(ranges: list[tuple[int, int]]) -> None:
    """Map each page of memory for this process alone, where the system supports it."""
    if sys.platform != "linux":
        return
    import ctypes

    madvise = ctypes.CDLL(None).madvise
    madvise.argtypes = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int
    for start, length in ranges:
        madvise(start, length, _POPULATE_WRITE)


def get_heap() -> list[bytes]:
    """Get memory and free it; return what keeps it in this process."""
    pieces = [bytes(_PIECE) for _ in range(_HEAP // _PIECE)]
    return pieces[:: _ARENA // _PIECE]
