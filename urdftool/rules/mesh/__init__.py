"""Mesh files and how they are named."""

FILES = ("files", "uris", "file_names", "formats", "scale", "parts", "surface")
"""Files with rules, in reading order."""
