"""Collision geometry: simplified from meshes, measured against them, and written into robots.

This package imports nothing by itself; its modules are:

- ``settings``, ``piece``: options, and the pieces of the result;
- ``surface``, ``convex``, ``primitives``, ``decimate``, ``decompose``, ``cut``, ``merge``,
  ``remesh``: preparation of a mesh, and the methods that simplify it;
- ``distance``, ``exterior``, ``measure``: distances between two surfaces, of what can be touched;
- ``choose``, ``compute``: the cheapest result within the error, for one mesh;
- ``cache``, ``parallel``, ``cluster``: many meshes, in parallel, each once;
- ``links``, ``robot``, ``rewrite``, ``in_place``, ``mesh_files``: a robot's links, its source, and
  the mesh files;
- ``check``, ``picture``: quality of existing collisions, and pictures.
"""
