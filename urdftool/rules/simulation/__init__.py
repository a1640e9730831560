"""Interpretation of a robot by simulators."""

FILES = ("stability", "spawn", "readers", "usd_importers", "stages")
"""Files with rules, in reading order."""
