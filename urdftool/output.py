"""Results on disk and on standard output: whole or not at all."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from .errors import OutputError
from .storage import write_files


def write_result(text: str, target: str | None, *, inputs: Iterable[str | Path] = ()) -> None:
    """Write a result to standard output (``-`` or None) or to a file.

    Args:
        text: The result.
        target: Where it goes.
        inputs: Files that were read for it, which it must not overwrite.

    Raises:
        OutputError: It cannot be written, or would overwrite an input. The file is as it was.
    """
    if target is None or target == "-":
        _write_stdout(text)
        return
    write_file(target, text.encode("utf-8"), inputs=inputs)


def _write_stdout(text: str) -> None:
    """Write all of a text, also where PYTHONUNBUFFERED makes each write a partial one."""
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
        raise OutputError("standard output was closed before all was written") from None


def _same_file(one: str | Path, other: str | Path) -> bool:
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False


def check_target(target: str | Path, *, inputs: Iterable[str | Path] = ()) -> None:
    """Refuse an output that cannot be, before there is any.

    Args:
        target: Where it is to go.
        inputs: Files that are read for it, which it must not overwrite.

    Raises:
        OutputError: It is an input, a folder, read-only, or its folder cannot be made.
    """
    for source in inputs:
        if _same_file(source, target):
            raise OutputError(
                f"is read as an input ({source}); write the output to another file", path=target
            )
    path = Path(os.path.realpath(target))
    if path.is_dir():
        raise OutputError("is a folder; the name of a file is wanted", path=target)
    check_folder(path.parent, target)
    if path.is_file() and not os.access(path, os.W_OK):
        raise OutputError("may not be written (it is read-only)", path=target)


def check_folder(folder: Path, target: str | Path) -> None:
    """Refuse an output whose folder neither exists nor can be made.

    Args:
        folder: The folder of the output, as a real path.
        target: The output, for the message.

    Raises:
        OutputError: A part of the path is a file, or its last existing folder is read-only.
    """
    if folder.is_dir():
        return
    above = folder
    while not os.path.lexists(above):
        above = above.parent
    if not above.is_dir():
        raise OutputError(
            f"the folder {folder} cannot be made: {above} is not a folder", path=target
        )
    if not os.access(above, os.W_OK):
        raise OutputError(f"the folder {folder} cannot be made: {above} is read-only", path=target)


def check_targets(
    targets: Iterable[str | Path | None], *, inputs: Iterable[str | Path] = ()
) -> None:
    """Refuse outputs of one command before any is written; None and ``-`` are none.

    Args:
        targets: Where they are to go.
        inputs: Files that are read for them, which they must not overwrite.

    Raises:
        OutputError: One of them cannot be, or two are the same file.
    """
    sources, seen = list(inputs), set[str]()
    for target in targets:
        if target is None or str(target) == "-":
            continue
        check_target(target, inputs=sources)
        path = os.path.realpath(target)
        if path in seen and (os.path.isfile(path) or not os.path.exists(path)):
            raise OutputError("is named for two outputs; give each its own", path=target)
        seen.add(path)


def write_file(target: str | Path, data: bytes, *, inputs: Iterable[str | Path] = ()) -> None:
    """Write a file, whole or not at all.

    A link is followed, and the mode of a file that is there is kept.

    Args:
        target: Where it goes.
        data: What is in it.
        inputs: Files that were read for it, which it must not overwrite.

    Raises:
        OutputError: It cannot be written, or would overwrite an input; what was there is as it was.
    """
    check_target(target, inputs=inputs)
    path = Path(os.path.realpath(target))
    if path.exists() and not path.is_file():  # /dev/null, a named pipe: no neighbour to rename
        try:
            path.write_bytes(data)
        except OSError as error:
            raise OutputError(f"cannot be written: {error.strerror}", path=target) from None
        return
    write_files({Path(target): data})


def rewrite(before: Mapping[str, bytes | None], after: Mapping[str, bytes]) -> None:
    """Write edited files in place: all of them, or none.

    Args:
        before: What each file was when it was read; one that is something else now is not written.
            None where it was not there.
        after: What each is to be.

    Raises:
        OutputError: A file was changed meanwhile, or cannot be written.
    """
    for path in after:
        _check_unchanged(path, before[path])
        if before[path] is not None and not os.access(path, os.W_OK):
            raise OutputError("is not fixed: it is read-only", path=path)
    write_files({Path(path): data for path, data in after.items()})


def _check_unchanged(path: str, data: bytes | None) -> None:
    if data is None:
        if os.path.lexists(path):
            raise OutputError("is not written: it is there now; run again", path=path)
        return
    try:
        with open(path, "rb") as stream:
            now = stream.read()
    except OSError as error:
        raise OutputError(f"cannot be read again: {error.strerror}", path=path) from None
    if now != data:
        raise OutputError("is not fixed: it was changed meanwhile; run again", path=path)
