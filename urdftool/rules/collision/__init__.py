"""Collision geometry."""

FILES = ("presence", "shapes", "visual_mismatch", "displaced", "wheels", "overlap")
"""Files with rules, in reading order."""
