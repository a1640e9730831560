"""What is seen."""

FILES = ("materials", "looks")
"""Files with rules, in reading order."""
