"""Mesh files and how they are named."""
