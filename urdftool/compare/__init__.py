"""Semantic differences between two robots.

Modules are imported separately (this package imports nothing):

- ``differences``: ``compare``, the entry point, with the differences of joints and renames;
- ``change``: ``Change``, its result;
- ``links``, ``mechanisms``, ``extensions``: differences of these parts;
- ``tolerance``: equality of numbers, poses and tensors;
- ``revision``: descriptions at a git revision.
"""
