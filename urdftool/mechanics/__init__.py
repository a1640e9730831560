"""Mechanics of rigid bodies in plain Python: spatial inertia, consistency, repair, typing errors.

- ``tensor``: symmetric 3 × 3 tensors, principal moments and axes, physical consistency;
- ``spatial_inertia``: mass, center of mass and inertia tensor of a body; move, combine, scale;
- ``repair``: the nearest physically consistent tensor, a sphere's, a box's;
- ``mass_bounds``: whether a mass fits into the box around its shapes;
- ``typo_detection``: the one typing error that explains a wrong tensor.

Only what returns arrays or principal axes imports numpy, when it is called.
"""
