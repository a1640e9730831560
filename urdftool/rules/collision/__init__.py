"""Collision geometry."""

FILES = ("presence", "shapes", "likeness", "displaced", "wheels", "overlap")
"""Files with rules, in reading order."""
