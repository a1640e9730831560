"""Export to MJCF, the model format of MuJoCo, in the style of a hand-written model.

Modules in processing order: ``structure`` (kinematic tree), ``inertials`` and ``meshes``
(conversions), ``body`` with ``joint`` and ``geom`` (``<worldbody>``), one module for each other
section of the file, ``write`` (whole model), ``scene`` and ``verify``.
"""
