"""Write the edited source files of a robot, unless they changed since they were read."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..source.location import SourceFile


def write_files(robot: Robot, edited: Mapping[str, bytes], output: str | None) -> list[str]:
    """Write the edited files, and return the names of those that changed.

    Raises:
        OutputError: A file cannot be written, or was changed since it was read.
    """
    from ..output import write_file
    from ..source.document import STDIN
    from ..source.location import SourceFile

    assert robot.source is not None
    files = {file.path: file for file in robot.source.files}
    for path in edited:
        if path != STDIN:
            _check_unchanged(path, files[path].data)
    if output is not None:
        main = robot.source.files[0]
        data = edited.get(main.path, main.data)
        if output != "-":
            data = _adjust_names(robot, SourceFile(main.path, data), output)
        _write_out(data, output, list(files))
        return [output]
    for path, data in edited.items():
        write_file(path, data)
    return list(edited)


def _adjust_names(robot: Robot, file: SourceFile, output: str) -> bytes:
    """Return the bytes of a description whose relative file names fit the folder of the output."""
    from ..source.moved_references import move_references

    assert robot.source is not None
    here = Path(os.path.realpath(robot.source.packages.file.parent))
    elements = robot.source.document.root.walk()
    return move_references(file, elements, here, Path(os.path.realpath(Path(output).parent)))


def _check_unchanged(path: str, data: bytes) -> None:
    """Refuse a file whose bytes differ from those that were read."""
    from ..errors import OutputError

    try:
        with open(path, "rb") as stream:
            now = stream.read()
    except OSError as error:
        raise OutputError(f"cannot be read before writing: {error.strerror}", path=path) from None
    if now.startswith((b"\xff\xfe", b"\xfe\xff", b"\x00\x00\xfe\xff")):
        raise OutputError("is in UTF-16 or UTF-32; convert it to UTF-8 to edit it", path=path)
    if now != data:
        raise OutputError("was changed by another program; run the command again", path=path)


def _write_out(data: bytes, output: str, inputs: list[str]) -> None:
    """Write the bytes unchanged to a file that is not an input, or to standard output."""
    from ..errors import OutputError
    from ..output import write_file, write_result

    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        if output == "-":
            raise OutputError(
                "is not in UTF-8 and cannot be printed; write it to a file with -o",
                path=inputs[0],
            ) from None
        for name in inputs:
            if os.path.exists(output) and os.path.exists(name) and os.path.samefile(name, output):
                raise OutputError("is an input; write to another file", path=name) from None
        write_file(output, data)
    else:
        write_result(text, output, inputs=inputs)
