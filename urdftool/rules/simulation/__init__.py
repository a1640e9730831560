"""What simulators make of a robot."""

FILES = ("stability", "spawn", "readers")
"""Files with rules, in reading order."""
