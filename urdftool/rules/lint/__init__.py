"""The linter itself."""

FILES = ("suppressions", "analysis", "comments")
"""Files with rules, in reading order."""
