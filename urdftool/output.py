"""Results written to files and to standard output: complete or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from .errors import OutputError
from .projects import explain_link_out
from .standard_output import write_stdout
from .storage import write_files
from .workspace import Workspace


def write_result(text: str, target: str | None, *, inputs: Iterable[str | Path] = ()) -> None:
    """Write a result to standard output (``-`` or None), or to a file that is none of the inputs.

    Raises:
        OutputError: The target cannot be written or is an input; the file is unchanged.
    """
    if target is None or target == "-":
        write_stdout(text)
        return
    write_file(target, text.encode("utf-8"), inputs=inputs)


def _is_same_file(one: str | Path, other: str | Path) -> bool:
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False


def check_target(target: str | Path, *, inputs: Iterable[str | Path] = ()) -> None:
    """Check that an output can be written and is none of the inputs, before the result is computed.

    Raises:
        OutputError: It is an input, a folder or read-only, or its folder cannot be created.
    """
    for source in inputs:
        if _is_same_file(source, target):
            raise OutputError(
                f"is an input ({source}); write the output to another file", path=target
            )
    path = Path(os.path.realpath(target))
    if path.is_dir():
        raise OutputError("is a folder, not a file", path=target)
    check_folder(path.parent, target)
    if path.is_file() and not os.access(path, os.W_OK):
        raise OutputError("is read-only", path=target)


def check_folder(folder: Path, target: str | Path) -> None:
    """Check that the folder of an output exists or can be created.

    Raises:
        OutputError: A part of the path is a file or a link out of its project, or its last
            existing folder is read-only.
    """
    check_links(target)
    if folder.is_dir():
        return
    above = folder
    while not os.path.lexists(above):
        above = above.parent
    if not above.is_dir():
        raise OutputError(
            f"folder {folder} cannot be created: {above} is not a folder", path=target
        )
    if not os.access(above, os.W_OK):
        raise OutputError(f"folder {folder} cannot be created: {above} is read-only", path=target)


def check_links(target: str | Path) -> None:
    """Check that no link that may have come with a project leads an output out of it.

    Raises:
        OutputError: A link does.
    """
    reason = explain_link_out(target, Workspace())
    if reason:
        raise OutputError(f"is not written: it {reason}", path=target)


def check_targets(
    targets: Iterable[str | Path | None], *, inputs: Iterable[str | Path] = ()
) -> None:
    """Check all outputs of a command before any is written; None and ``-`` are skipped.

    Raises:
        OutputError: An output cannot be written, or two outputs are the same file.
    """
    sources, seen = list(inputs), set[str]()
    for target in targets:
        if target is None or str(target) == "-":
            continue
        check_target(target, inputs=sources)
        path = os.path.realpath(target)
        if path in seen and (os.path.isfile(path) or not os.path.exists(path)):
            raise OutputError("is the file of two outputs; use different files", path=target)
        seen.add(path)


def write_file(target: str | Path, data: bytes, *, inputs: Iterable[str | Path] = ()) -> None:
    """Write a file completely or not at all.

    Symbolic links are followed; the mode of an existing file is kept.

    Raises:
        OutputError: The file cannot be written or is an input; its old contents are unchanged.
    """
    check_target(target, inputs=inputs)
    path = Path(os.path.realpath(target))
    if path.exists() and not path.is_file():  # /dev/null or a named pipe cannot be replaced
        try:
            path.write_bytes(data)
        except OSError as error:
            raise OutputError(f"cannot be written: {error.strerror}", path=target) from None
        return
    write_files({Path(target): data})


def rewrite(before: Mapping[str, bytes | None], after: Mapping[str, bytes]) -> None:
    """Rewrite edited files in place: all of them, or none.

    Args:
        before: Expected present contents by path; None for a file that must not exist.
        after: New contents by path.

    Raises:
        OutputError: A file has other contents than expected, or cannot be written.
    """
    for path in after:
        check_links(path)
        _check_unchanged(path, before[path])
        if before[path] is not None and not os.access(path, os.W_OK):
            raise OutputError("not fixed, because the file is read-only", path=path)
    write_files({Path(path): data for path, data in after.items()})


def _check_unchanged(path: str, data: bytes | None) -> None:
    if data is None:
        if os.path.lexists(path):
            raise OutputError(
                "not written, because another program created the file; run the command again",
                path=path,
            )
        return
    try:
        with open(path, "rb") as stream:
            now = stream.read()
    except OSError as error:
        raise OutputError(f"cannot be read before writing: {error.strerror}", path=path) from None
    if now != data:
        raise OutputError(
            "not fixed, because another program changed the file; run the command again", path=path
        )
