"""Interpretation of a robot by simulators."""

FILES = ("stability", "spawn", "readers", "mujoco_element", "usd_importers", "stages")
"""Files with rules, in reading order."""
