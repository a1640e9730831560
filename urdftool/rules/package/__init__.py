"""The package around a description."""

FILES = ("resolution", "manifest", "launching")
"""Files with rules, in reading order."""
