"""Rules on XML elements, attributes and numbers."""

FILES = ("document", "vocabulary", "shape", "numbers", "magnitude", "reference", "version")
"""Files with rules, in reading order."""
