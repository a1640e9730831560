"""Semantic differences between two robots.

Modules are imported separately (this package imports nothing):

- ``differences``: ``compare``, the entry point;
- ``change``: ``Change``, its result;
- ``links``, ``joints``, ``extensions``: differences of these parts;
- ``renames``: detection of renamed links and joints;
- ``closeness``: equality of numbers, poses and tensors;
- ``revision``: descriptions at a git revision.
"""
