"""Mass properties of shapes, meshes and links.

This package imports nothing by itself; its modules are:

- ``solids``: box, cylinder, sphere, capsule, ellipsoid, cone and hollow shapes in closed form;
- ``polyhedron``: exact integrals over a closed triangle mesh, and over a shell;
- ``estimate``: any triangle mesh, with the method and its reliability;
- ``requirements``: conditions that mass properties must fulfill before they are written.

Results are of the type ``mechanics.spatial_inertia.SpatialInertia``.
Lengths are in meters, masses in kilograms, inertia in kg·m².
"""
