"""Visual geometry, materials and textures."""

FILES = ("materials", "appearance")
"""Files with rules, in reading order."""
