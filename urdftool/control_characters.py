"""Characters that a terminal obeys or that no reader sees, made visible in text from a file."""

from __future__ import annotations

LINES = "\t\n"
"""Control characters that a text of several lines keeps."""


def escape_controls(text: str, keep: str = "") -> str:
    """Escape all characters of a text that are not printable.

    These are control characters, also those of C1, marks of text direction and other invisible
    characters, separators other than the blank, and lone surrogates, which stand for bytes of a
    file name that are not UTF-8.

    Args:
        text: Name, path, message or line from a file, an argument or the environment.
        keep: Characters to keep: none in a name or one line, ``LINES`` in a message.
    """
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() or c in keep else c.encode("unicode_escape").decode() for c in text
    )
