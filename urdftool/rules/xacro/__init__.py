"""Rules on xacro files and their expansion."""

FILES = (
    "expansion",
    "tags",
    "leftovers",
    "unreached_expressions",
    "unreached_typos",
    "expansion_warnings",
    "unused",
)
"""Files with rules, in reading order."""
