"""URDF and xacro, the source format.

The reader is in ``source`` and ``model``, which keep byte positions for code that edits
descriptions.
"""
