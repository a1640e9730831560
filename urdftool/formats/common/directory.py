"""Writing of exports to disk: a folder, or a file with its companions, all or nothing.

The first comment of every text file names urdftool and holds a digest of the content. A later
export therefore recognizes its own unmodified files. It does not replace edited files, nor files
that urdftool did not write.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory

from ... import __version__
from ...errors import OutputError
from ...leftovers import restore_folder
from ...output import check_folder, check_links
from ...storage import write_files, write_folder
from ..written import Written

_MARK = re.compile(rb"(?:<!--|#) Exported by urdftool [^;\n]*; ([0-9a-f]{12})(?: -->)?\n?")
_HEAD = 4096
"""Bytes in which the mark of an export must begin. Chosen, no source."""


def mark(xml: bytes, source: str) -> bytes:
    """Return an XML file with the mark before its root element."""
    start = xml.find(b"?>") + 2 if xml.startswith(b"<?xml") else 0
    head, rest = xml[:start], xml[start:].lstrip(b"\n")
    comment = f"<!-- {_format_sentence(rest, source)} -->\n".encode()
    return (head + b"\n" if head else b"") + comment + rest


def mark_usda(text: bytes, source: str) -> bytes:
    """Return a layer of USD as text with the mark after its first line."""
    head, _, rest = text.partition(b"\n")
    return head + f"\n# {_format_sentence(rest, source)}\n".encode() + rest


@contextmanager
def place_export(
    written: Written, output: str | Path | None, name: str, *, single: bool
) -> Iterator[Path]:
    """Provide the path of an export on disk during a ``with`` block.

    Without an output, it is a temporary copy of a name.
    """
    if output is not None:
        yield Path(output)
        return
    with TemporaryDirectory(prefix="urdftool-") as folder:
        copy = Path(folder) / name
        write_export(copy, written, single=single)
        yield copy


def _format_sentence(rest: bytes, source: str) -> str:
    name = re.sub(r"[-;<>]*[;<>][-;<>]*|-{2,}|[\r\n]+", "-", source)
    return f"Exported by urdftool {__version__} from {name}; {_format_digest(rest)}"


def is_ours(data: bytes) -> bool:
    """Tell whether urdftool wrote these bytes and they were not modified since."""
    found = _MARK.search(data, 0, _HEAD)
    return found is not None and found[1].decode() == _format_digest(data[found.end() :])


def write_directory(
    target: str | Path,
    files: Mapping[str, bytes | Path],
    *,
    main: str,
    overwrite: bool = False,
    inputs: Iterable[str | Path] = (),
) -> None:
    """Write an export to a folder: first to a temporary folder next to it, which is then moved.

    The files of an earlier export are replaced; other files in the folder stay.

    Args:
        target: The folder.
        files: Content by relative path: bytes, or the path of a file to copy.
        main: File by which the folder of an earlier export is recognized.
        overwrite: Also replace files that urdftool did not write, or that were edited.
        inputs: Input files, which must not be replaced.

    Raises:
        OutputError: The target must not be replaced or cannot be written. Existing files are
            unchanged.
    """
    folder = Path(os.path.realpath(target))
    _check_place(folder, target)
    restore_folder(folder)
    if folder.is_file():
        raise OutputError("is a file; give the name of a folder", path=target)
    there = folder.is_dir() and any(folder.iterdir())
    if there and not overwrite and not (folder / main).is_file():
        raise OutputError(
            (
                "is a folder that urdftool did not write; choose another, or overwrite it with "
                "--overwrite"
            ),
            path=target,
        )
    _check_files(folder, files, overwrite, inputs)
    write_folder(target, files)


def write_beside(
    target: str | Path,
    files: Mapping[str, bytes | Path],
    *,
    main: str,
    overwrite: bool = False,
    inputs: Iterable[str | Path] = (),
) -> None:
    """Write an export as one file with its companions in the same folder; the file is written last.

    Arguments are those of :func:`write_directory`; ``main`` becomes the target.

    Raises:
        OutputError: A file must not be replaced or cannot be written.
    """
    path = Path(os.path.realpath(target))
    if path.is_dir():
        raise OutputError("is a folder; give the name of a file", path=target)
    _check_place(path, target)
    named = {path.name if name == main else name: content for name, content in files.items()}
    _check_files(path.parent, named, overwrite, inputs)
    ordered = sorted(named, key=lambda name: (name == path.name, name))
    write_files({path.parent / name: named[name] for name in ordered}, follow_links=False)


def write_export(
    target: str | Path,
    written: Written,
    *,
    single: bool,
    overwrite: bool = False,
    inputs: Iterable[str | Path] = (),
) -> None:
    """Write an export to disk.

    ``single``: the target is a file, with its companions in the same folder.

    Raises:
        OutputError: A file must not be replaced or cannot be written.
    """
    write = write_beside if single else write_directory
    write(target, written.files, main=written.main, overwrite=overwrite, inputs=inputs)


def _check_place(path: Path, shown: str | Path) -> None:
    check_folder(path.parent, shown)
    if path.exists() and not (path.is_dir() or path.is_file()):
        raise OutputError("is neither a file nor a folder", path=shown)


def _check_files(
    folder: Path,
    files: Mapping[str, bytes | Path],
    overwrite: bool,
    inputs: Iterable[str | Path],
) -> None:
    """Refuse to replace an input, or a text file that urdftool did not write or that was edited."""
    read = {os.path.realpath(name) for name in inputs}
    read |= {os.path.realpath(content) for content in files.values() if isinstance(content, Path)}
    for name, content in files.items():
        place = folder / name
        check_links(place)
        if os.path.realpath(place) in read:
            raise OutputError("is an input of the export; choose another output", path=place)
        if place.is_dir():
            raise OutputError("is a folder, but the export writes a file of this name", path=place)
        if overwrite or not place.is_file() or not isinstance(content, bytes):
            continue
        if not _MARK.search(content, 0, _HEAD):
            continue  # a converted mesh next to a model that urdftool wrote
        data = place.read_bytes()
        if is_ours(data) or data == content:
            continue
        edited = _MARK.search(data, 0, _HEAD)
        why = "was edited since it was exported" if edited else "was not written by urdftool"
        raise OutputError(f"{why}; keep it, or overwrite it with --overwrite", path=place)


def _format_digest(data: bytes) -> str:
    return sha256(data).hexdigest()[:12]
