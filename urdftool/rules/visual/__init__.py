"""Visual geometry, materials and textures."""

FILES = ("materials", "looks")
"""Files with rules, in reading order."""
