"""MJCF, the language of MuJoCo: a model as one would have written it by hand.

In the order of the work: ``structure`` (what hangs on what), ``inertials`` and ``meshes`` (what
needs arithmetic), ``body`` with ``joint`` and ``geom`` (the tree), then each section of the file in
a module of its name, ``write`` (all of it), ``scene`` and ``verify``.
"""
