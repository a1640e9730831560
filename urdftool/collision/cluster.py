"""Simplification on a Dask cluster, for thousands of meshes.

The workers require urdftool with its extra ``collision``, but no access to the files, which are
sent.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import UrdftoolError
from ..source.access import list_companions
from .compute import Task, try_compute

Sent = tuple[Task, dict[str, bytes]]
"""A task, and the contents of its files by name."""


def simplify_sent(sent: Sent) -> bytes | UrdftoolError:
    """Simplify a mesh on a worker, from its file contents; errors refer to the original path."""
    import tempfile
    from dataclasses import replace

    task, files = sent
    with tempfile.TemporaryDirectory(prefix="urdftool-") as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        outcome = try_compute(replace(task, path=Path(folder) / task.path.name))
    if isinstance(outcome, UrdftoolError) and outcome.path is not None:
        return type(outcome)(outcome.message, path=task.path)
    return outcome


def read_task(task: Task) -> Sent:
    """Read the mesh file, and the buffers in its folder if it is glTF."""
    paths = [task.path]
    if task.path.suffix.lower() == ".gltf":
        paths += list_companions(task.path, "*.bin")
    return task, {file.name: file.read_bytes() for file in paths if file.is_file()}
