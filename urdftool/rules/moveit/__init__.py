"""Rules on MoveIt files next to a description."""

FILES = ("semantic", "parts", "configuration", "consistency", "adjacent", "pairs")
"""Files with rules, in reading order."""
