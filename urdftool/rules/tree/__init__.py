"""Links and joints as one tree."""

FILES = ("links", "ends", "roots")
"""Files with rules, in reading order."""
