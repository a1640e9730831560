"""Analysis limits and comments that suppress findings."""

FILES = ("suppressions", "analysis", "comments")
"""Files with rules, in reading order."""
