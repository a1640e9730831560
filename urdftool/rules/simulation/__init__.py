"""Interpretation of a robot by simulators."""

FILES = ("stability", "spawn", "readers")
"""Files with rules, in reading order."""
