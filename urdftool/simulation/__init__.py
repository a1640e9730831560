"""Simulate a robot that settles on a plane, and judge whether it stands.

The package loads nothing by itself; its modules are imported one by one:

- ``settings``: how the robot is spawned, and for how long;
- ``rigid_bodies``, ``shapes``: the robot as plain data that any engine reads;
- ``mesh_cache``, ``hull_cache``: its meshes, for one run and for the next ones;
- ``prepare``: refuses robots that engines cannot simulate;
- ``engines``: the physics engines; ``engine_process``: one in a process of its own;
- ``control``, ``controllers``: how a controller file holds the joints;
- ``recording``: the measurements of an engine; ``state``: one sample of them;
- ``prefetch``: computation of results while an engine runs;
- ``checks``, ``model_checks``: checks of a recording, and of the description;
- ``verdict``: all checks of one trial; ``engine_comparison``: comparison of two engines;
- ``fleet``: many robots in parallel; ``animation``, ``plot``: pictures of a run.
"""
