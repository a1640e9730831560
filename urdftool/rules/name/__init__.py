"""Names and conventions."""

FILES = ("spelling", "frames")
"""Files with rules, in reading order."""
