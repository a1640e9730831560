"""A page in the browser that shows a robot and moves its joints.

This package imports nothing by itself; its modules are:

- ``page``: contents and events of the page; ``panels``: its texts, tables and controls;
- ``joints``, ``sliders``: the joint sliders, their bounds and units;
- ``body``: the robot in the scene; ``looks``: its surfaces as meshes, ``glb`` for textured ones;
  ``compute_inertia_box``: inertia boxes;
- ``surroundings``: light, ground and viewpoint;
- ``numbers``: properties of links and joints; ``marks``: the links of findings;
- ``watch``: changes of files;
- ``server``: a local server that only its own page can use.
"""
