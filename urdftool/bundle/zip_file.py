"""Zip files of bundles, read within limits that are checked before anything is unpacked."""

from __future__ import annotations

import stat
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from ..errors import SourceError

MAX_BYTES = 2 << 30
"""Size [bytes] of all files in a zip file, unpacked. Chosen; large robots have some 100 MB."""

MAX_RATIO = 100
"""Size of all files relative to that of the zip file, above :data:`SMALL` bytes. Texts and meshes
of robots have up to 20. Chosen, no source.
"""

SMALL = 100 << 20
"""Size [bytes] of all files up to which their ratio does not matter."""

MAX_ENTRIES = 20_000
"""Number of files and folders. Chosen, no source."""


@contextmanager
def open_zip(path: str | Path) -> Iterator[zipfile.ZipFile]:
    """Open a zip file whose entries may be unpacked.

    The sizes in its directory are those that count: Python's ``zipfile`` unpacks no more of an
    entry than its directory says.

    Raises:
        SourceError: It cannot be read; it has a link or an entry outside of its folder, encrypted
            or compressed in another way than bundles are; or it exceeds a limit.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            _check_entries(archive, path)
            yield archive
    except (
        *(zipfile.BadZipFile, zlib.error, OSError),
        *(NotImplementedError, RuntimeError, EOFError),
    ) as error:
        raise SourceError(f"cannot be read as a zip file: {error}", path=path) from None


def _check_entries(archive: zipfile.ZipFile, path: str | Path) -> None:
    entries = archive.infolist()
    if len(entries) > MAX_ENTRIES:
        raise SourceError(
            f"has {len(entries)} entries, more than the limit of {MAX_ENTRIES}", path=path
        )
    for entry in entries:
        name = PurePosixPath(entry.filename.replace("\\", "/"))
        if name.is_absolute() or ".." in name.parts or ":" in entry.filename:
            raise SourceError(f"has an entry outside of its folder: {entry.filename}", path=path)
        if stat.S_ISLNK(entry.external_attr >> 16):
            raise SourceError(f"has a symbolic link: {entry.filename}", path=path)
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise SourceError(
                f"has an entry that is neither stored nor deflated: {entry.filename}", path=path
            )
    size, packed = sum(entry.file_size for entry in entries), Path(path).stat().st_size
    limit = min(MAX_BYTES, max(SMALL, MAX_RATIO * packed))
    if size > limit:
        raise SourceError(
            f"has {size} bytes of content, more than the limit of {limit} for a zip file of "
            f"{packed} bytes; remove files that the robot does not need",
            path=path,
        )
