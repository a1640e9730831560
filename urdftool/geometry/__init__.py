"""Geometry of meshes and primitives: reading files, topology, hulls, penetration depth.

This package imports nothing by itself; its modules are:

- ``load``: ``load_mesh`` for every format, with ``stl``, ``obj``, ``ply``, ``collada``, ``gltf``;
- ``mesh``: ``Mesh`` and its ``Part``, what it returns;
- ``stl_header``: kind and claimed size of an STL file, without numpy;
- ``convex_points``: the outermost points of a mesh, read without its faces;
- ``topology``: edges, closedness, winding, bodies; ``surface``: what lint reports of them;
- ``hull``, ``tessellate``: convex hulls, and triangles of primitives;
- ``penetration``: how deep two convex shapes overlap, without numpy.
"""
