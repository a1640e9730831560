"""Measurements of ``urdftool server``: definitions, time and memory of checks."""
