"""Links and joints as one tree."""

FILES = ("links", "roots")
"""Files with rules, in reading order."""
