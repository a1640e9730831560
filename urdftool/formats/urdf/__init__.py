"""URDF, and xacro that expands to it: the format that descriptions are written in.

It is read by ``source`` and ``model``, which keep the place of every byte; what edits a description
works on these.
"""
