"""Mass properties: how heavy a body is, where its centre of mass lies and how it resists turning.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``tensor``: ``MassProperties``; shift, rotate, combine, principal moments, what is possible;
- ``solids``: box, cylinder, sphere, capsule, ellipsoid, cone and hollow shapes in closed form;
- ``polyhedron``: exact integrals over a closed triangle mesh, and over a shell;
- ``estimate``: any triangle mesh, with the method and its reliability said;
- ``bound``: what no distribution of mass inside a box can exceed;
- ``proposal``: the one simple slip that explains an impossible tensor.

Lengths are in metres, masses in kilograms, inertia in kg·m².
"""
