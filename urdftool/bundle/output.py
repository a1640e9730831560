"""Writing of bundles: a folder or a zip file, whole or not at all.

``bundle.json`` lists the digests of the files that urdftool wrote. A later bundle replaces these
files if they are unmodified, and removes those that it does not contain.
"""

from __future__ import annotations

import io
import os
import shutil
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..errors import OutputError, SourceError
from ..leftovers import restore_folder
from ..output import check_folder, check_links, write_file
from ..storage import read_regular_file, write_folder
from ..workspace import MAX_TEXT_BYTES
from .make import Bundle
from .manifest import MANIFEST, compute_digest, read_digests
from .store import Content
from .zip_file import open_zip

_BLOCK = 1 << 20
"""Bytes that are copied in one step. Chosen, no source."""

_DATE = (1980, 1, 1, 0, 0, 0)
"""Earliest date of a zip file, so that the same content gives the same bytes."""

_REGULAR_FILE = 0o100644 << 16
"""Mode of Unix in a zip file: a regular file that all read and its owner writes. Chosen."""

_OVERWRITE = "choose another output, or overwrite it with --overwrite"


def is_zip(path: str | Path) -> bool:
    """Tell whether an output is a zip file, by its suffix."""
    return str(path).lower().endswith(".zip")


def write_bundle(target: str | Path, bundle: Bundle, *, overwrite: bool = False) -> None:
    """Write a bundle to a folder, or to a zip file if the path ends in ``.zip``.

    Raises:
        OutputError: The output cannot be written; its previous state is unchanged.
    """
    sources = [*bundle.sources, *(c for c in bundle.files.values() if isinstance(c, Path))]
    if is_zip(target):
        check_zip(target, overwrite=overwrite)
        top = Path(bundle.description).stem
        write_file(target, zip_bytes(bundle.files, top), inputs=sources)
        return
    folder = Path(os.path.realpath(target))
    check_folder(folder.parent, target)
    restore_folder(folder)
    if os.path.lexists(folder) and not folder.is_dir():
        raise OutputError("is a file; give the name of a folder or of a .zip file", path=target)
    old = _check_files(folder, target, bundle.files, overwrite, sources)
    write_folder(target, bundle.files, dropped=old - set(bundle.files))


def zip_bytes(files: Mapping[str, Content], top: str) -> bytes:
    """Return a zip file that is equal for equal files."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for name in sorted(files):
            content = files[name]
            info = zipfile.ZipInfo(f"{top}/{name}", _DATE)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.create_system = 3
            info.external_attr = _REGULAR_FILE
            if isinstance(content, bytes):
                archive.writestr(info, content)
                continue
            info.file_size = content.stat().st_size
            with open(content, "rb") as source, archive.open(info, "w") as target:
                shutil.copyfileobj(source, target, _BLOCK)
    return stream.getvalue()


def check_zip(target: str | Path, *, overwrite: bool) -> None:
    """Check that a zip file may be written.

    Raises:
        OutputError: There is a file that urdftool did not write, or that was edited.
    """
    path = Path(target)
    if overwrite or not path.is_file():
        return
    try:
        with open_zip(path) as archive:
            names = [name for name in archive.namelist() if name.endswith("/" + MANIFEST)]
            top = names[0].removesuffix(MANIFEST) if len(names) == 1 else ""
            digests = read_digests(archive.read(names[0])) if top else None
            unmodified = digests is not None and all(
                compute_digest(archive.read(top + name)) == value for name, value in digests.items()
            )
            complete = digests is not None and len(archive.namelist()) == len(digests) + 1
    except (SourceError, KeyError, ValueError):
        unmodified = complete = False
    if not (unmodified and complete):
        raise OutputError(f"is not an unmodified bundle; {_OVERWRITE}", path=target)


def _check_files(
    folder: Path,
    target: str | Path,
    files: Mapping[str, Content],
    overwrite: bool,
    inputs: Iterable[Path],
) -> set[str]:
    """Refuse to replace files that are not those of an earlier bundle.

    Returns:
        The unmodified files of the earlier bundle.
    """
    read = {os.path.realpath(path) for path in inputs}
    old: dict[str, str] = {}
    if folder.is_dir() and any(folder.iterdir()):
        check_links(folder / MANIFEST)
        try:
            old = read_digests(read_regular_file(folder / MANIFEST, MAX_TEXT_BYTES)) or {}
        except OSError:
            old = {}
        if not old and not overwrite:
            raise OutputError(f"is a folder that is not a bundle; {_OVERWRITE}", path=target)
    for name in files:
        place = folder / name
        check_links(place)
        if os.path.realpath(place) in read:
            raise OutputError("is an input of the bundle; choose another output", path=place)
        if place.is_dir():
            raise OutputError("is a folder, but the bundle has a file of this name", path=place)
        if overwrite or name == MANIFEST or not os.path.lexists(place):
            continue
        if name not in old:
            raise OutputError(f"was not written by urdftool; {_OVERWRITE}", path=place)
        if compute_digest(place) not in (old[name], compute_digest(files[name])):
            raise OutputError(f"was edited since it was bundled; {_OVERWRITE}", path=place)
    return {name for name in old if _is_unmodified(folder, name, old[name], read)}


def _is_unmodified(folder: Path, name: str, value: str, read: set[str]) -> bool:
    """Tell whether a file of an earlier bundle is inside the folder and unmodified."""
    place = folder / name
    inside = os.path.realpath(place).startswith(str(folder) + os.sep)
    if not inside or os.path.islink(place) or not place.is_file():
        return False
    return os.path.realpath(place) not in read and compute_digest(place) == value
