"""Mesh files: URIs, formats, scale and surfaces."""

FILES = ("files", "uris", "file_names", "formats", "scale", "file_references", "surface")
"""Files with rules, in reading order."""
