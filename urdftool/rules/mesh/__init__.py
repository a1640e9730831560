"""Mesh files and how they are named."""

FILES = ("files", "uris", "formats", "scale", "parts", "surface")
"""Files with rules, in reading order."""
