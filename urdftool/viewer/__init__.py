"""A page in the browser that shows a robot and moves its joints.

This package imports nothing by itself; its modules are:

- ``page``: contents and events of the page; ``panels``: its texts, tables and controls;
- ``joints``, ``sliders``: the joint sliders, their bounds and units;
- ``robot_scene``: the robot in the scene; ``render_mesh``: its surfaces as meshes;
  ``inertia_box``: inertia boxes;
- ``environment``: light, ground and viewpoint;
- ``properties``: properties of links and joints; ``marks``: the links of findings;
- ``watch``: changes of files;
- ``server``: a local server that only its own page can use.
"""
