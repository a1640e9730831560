"""Mass and inertia."""

FILES = ("presence", "mass", "density", "tensor", "slips", "size", "center", "frame", "sides")
"""Files with rules, in reading order."""
