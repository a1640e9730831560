"""Measurements of ``urdftool verify`` and ``urdftool export urdf`` on real robots."""
