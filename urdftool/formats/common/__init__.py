"""The parts that the writers of all formats use. Nothing here imports a format.

``lumping`` groups the links that fixed joints join; ``naming`` makes names unique; ``assets``,
``asset_filter`` and ``missing_files`` find mesh and image files; ``inertia_repair`` and ``extent``
replace physically inconsistent tensors; ``actuator_config`` reads settings;
``force_fallbacks`` drops invalid parts for ``--force``; ``losses`` and ``loss_report`` collect and
print losses; ``directory`` writes files to disk, ``numbers`` writes numbers.
"""
