"""Analysis limits, and comments that suppress what is not found."""

FILES = ("suppressions", "analysis")
"""Files with rules, in reading order."""
