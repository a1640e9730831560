"""Paths of the author's machine in the notes of COLLADA files."""

from __future__ import annotations

import re

_NOTES = re.compile(rb"<(source_data|comments)>([^<]*)</\1\s*>")
_PATH = re.compile(
    rb"""(?:file:/{0,3})?(?:[A-Za-z]:[\\/]|/(?:home|Users|root|mnt|media|tmp|data)/)[^\s<>"';|]*"""
)
_HEAD = 1 << 16
"""Bytes of a file in which its notes are searched; ``<asset>`` is the first element (COLLADA 1.4.1,
chapter 5)."""


def drop_author_paths(data: bytes) -> bytes:
    """Return a COLLADA file whose notes have names of files in place of absolute paths.

    Elements ``<source_data>`` and ``<comments>`` of ``<asset>`` name the source of the file;
    nothing reads them.

    Args:
        data: The content of the file.
    """
    head, rest = data[:_HEAD], data[_HEAD:]
    changed = _NOTES.sub(lambda note: _PATH.sub(_get_name, note[0]), head)
    return data if changed == head else changed + rest


def _get_name(path: re.Match[bytes]) -> bytes:
    return re.split(rb"[\\/]", path[0].rstrip(b"\\/"))[-1]
