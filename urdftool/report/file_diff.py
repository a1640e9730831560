"""What changed in a file, as ``--diff`` shows it."""

from __future__ import annotations

from io import StringIO

from .line_diff import unified_lines

NO_FILE = "/dev/null"


def file_diff(path: str, before: bytes | None, after: bytes) -> str:
    """A unified diff of a text, a line of a binary file.

    Args:
        path: What the file is called.
        before: What was in it; None where it was not there.
        after: What is in it now.
    """
    if b"\0" in after or b"\0" in (before or b""):
        was = "new" if before is None else f"{len(before)} bytes →"
        return f"binary file {path}: {was} {len(after)} bytes\n"
    old, new = (
        StringIO(data.decode("utf-8", "replace"), newline="\n").readlines()
        for data in (before or b"", after)
    )
    lines = []
    for line in unified_lines(old, new, NO_FILE if before is None else path, path):
        lines.append(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n")
    return "".join(lines)
