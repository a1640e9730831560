"""Summary of a robot: ``count`` for its elements, ``measure`` for its geometry.

Modules are imported separately (this package imports nothing):

- ``counts``: links, joints by type, degrees of freedom, mass, plugins, sensors, packages;
- ``size``: the bounding box of all geometry at the zero pose, and the meshes with their
  triangles.
"""
