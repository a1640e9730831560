"""Places where a word of the list is right."""

EXCEPTIONS: tuple[tuple[str, str, str], ...] = (
    (r"tests/language/", r".", "lists the words"),
    (r"CHANGELOG", r".", "keeps what was printed"),
    (r"commands/simulate", r"--limp", "an option that users know"),
)
"""A pattern of paths, one of lines, and the reason."""
