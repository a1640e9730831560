"""Rules on xacro files and their expansion."""

FILES = ("expansion", "tags", "leftovers", "unreached_expressions", "expansion_warnings", "unused")
"""Files with rules, in reading order."""
