"""The parts that every writer of a format uses.

``written`` and ``losses`` hold what a writer returns, ``loss_report`` prints it, ``directory``
writes it to disk. ``lumping`` groups links that fixed joints join, ``naming`` gives unique names,
``assets``, ``asset_filter`` and ``missing_files`` find mesh and image files, ``inertia_repair``
replaces physically inconsistent tensors, ``force_fallbacks`` drops invalid parts for ``--force``,
``gazebo_blocks`` reads ``<gazebo>`` elements. Nothing here imports a format.
"""
