"""Does it stand? A robot spawned above a plane, left to itself, and judged.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``settings``: how it is spawned and for how long;
- ``bodies``, ``shapes``: the robot as rigid bodies, plain data that any engine can be fed with;
- ``remembered``, ``kept``: its meshes, read once for a run and for the next ones;
- ``prepare``, ``urdf``: what is refused, and the folder an engine reads;
- ``child``: an engine in a process of its own; ``bullet`` is one, ``mj`` another;
- ``control``, ``controllers``: what a file of controllers does to joints;
- ``recording``: what an engine measured, whichever it was; ``moment``: one sample of that;
- ``meanwhile``: what is found out while an engine is waited for;
- ``verdict`` and the ``judge_…`` beside it: what the recording says of the robot;
- ``agreement``: two engines on one robot; ``fleet``: many robots at once;
- ``film``, ``plot``: a run to look at.
"""
