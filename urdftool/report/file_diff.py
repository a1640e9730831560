"""Changes of a file, as ``--diff`` shows them."""

from __future__ import annotations

from io import StringIO

from .line_diff import format_unified_lines

NO_FILE = "/dev/null"


def format_file_diff(path: str, before: bytes | None, after: bytes) -> str:
    """Return a unified diff of a text file, or one line for a binary file.

    Args:
        path: Name of the file in the diff.
        before: Previous content; None if the file did not exist.
        after: New content.
    """
    if b"\0" in after or b"\0" in (before or b""):
        was = "new" if before is None else f"{len(before)} bytes →"
        return f"binary file {path}: {was} {len(after)} bytes\n"
    old, new = (
        StringIO(data.decode("utf-8", "replace"), newline="\n").readlines()
        for data in (before or b"", after)
    )
    lines = []
    for line in format_unified_lines(old, new, NO_FILE if before is None else path, path):
        lines.append(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n")
    return "".join(lines)
