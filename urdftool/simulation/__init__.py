"""Simulate a robot above a plane, left to itself, and judge whether it stands.

The package loads nothing by itself; its modules are imported one by one:

- ``settings``: how the robot is spawned, and for how long;
- ``rigid_bodies``, ``shapes``: the robot as plain data that any engine reads;
- ``mesh_cache``, ``hull_cache``: its meshes, for one run and for the next ones;
- ``prepare``: which robots are refused;
- ``engines``: the physics engines; ``engine_process``: one in a process of its own;
- ``control``, ``controllers``: what a file of controllers does to joints;
- ``recording``: what an engine measured; ``state``: one sample of that;
- ``prefetch``: what is computed while an engine works;
- ``checks``, ``model_checks``: what a recording, and the description, say about the robot;
- ``verdict``: all of these on one trial; ``engine_comparison``: two engines;
- ``fleet``: many robots at once; ``animation``, ``plot``: pictures of a run.
"""
