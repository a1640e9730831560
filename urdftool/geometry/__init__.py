"""Geometry of meshes and primitives: reading files, topology, hulls, penetration depth.

This package imports nothing by itself; its modules are:

- ``load``: ``load_mesh`` for every format, with ``stl``, ``obj``, ``ply``, ``collada`` (and its
  ``collada_scene``, ``collada_materials``) and ``gltf`` (and its ``gltf_file``);
- ``mesh``: its result, ``Mesh`` with ``Part``;
- ``stl_header``: kind and claimed size of an STL file, without numpy;
- ``convex_points``: the extreme points of a mesh, read without its faces;
- ``topology``: edges, closedness, winding, bodies; ``surface``: their defects, for lint;
- ``hull``, ``tessellate``: convex hulls, and triangles of primitives;
- ``penetration``: penetration depth of convex shapes, without numpy.
"""
