"""A robot in one table: ``count`` what is written, ``measure`` what its shapes come to.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``counts``: links, joints by type, degrees of freedom, mass, plugins, sensors, packages;
- ``zero_pose``: where each link is when every joint is at zero;
- ``size``: the box around all shapes at zero pose, and the meshes with their triangles.
"""
