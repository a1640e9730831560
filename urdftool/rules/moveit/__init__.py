"""MoveIt's files beside a description."""

FILES = ("semantic", "configuration", "adjacent")
"""Files with rules, in reading order."""
