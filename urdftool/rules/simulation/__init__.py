"""Interpretation of a robot by simulators."""

FILES = ("stability", "spawn", "readers", "usd_importers")
"""Files with rules, in reading order."""
