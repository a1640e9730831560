"""Triangles: reading mesh files, and what can be said of the surface they make.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``load``: ``load_mesh``, the way in for every format;
- ``mesh``: ``Mesh`` and its ``Part``, what it returns;
- ``facts``: what an STL file's header and bytes say, without any library;
- ``solid``: closed, consistently wound, inside out, how many bodies, in which unit.
"""
