"""Simplification on a Dask cluster, for thousands of meshes.

The workers require urdftool with its extra ``collision``, but no access to the files, which are
sent.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import UrdftoolError
from ..source.access import list_companions
from .compute import Task, list_mesh_files, try_compute

Sent = tuple[Task, list[dict[str, bytes]]]
"""A task, and for each of its meshes the contents of its files by name."""


def simplify_sent(sent: Sent) -> bytes | UrdftoolError:
    """Simplify a mesh on a worker, from its file contents; errors refer to the original path."""
    import tempfile
    from dataclasses import replace

    task, contents = sent
    places = list_mesh_files(task)
    with tempfile.TemporaryDirectory(prefix="urdftool-") as folder:
        paths = [Path(folder, str(index), path.name) for index, path in enumerate(places)]
        for path, files in zip(paths, contents, strict=True):
            path.parent.mkdir()
            for name, data in files.items():
                (path.parent / name).write_bytes(data)
        others = (
            replace(other, path=path) for other, path in zip(task.others, paths[1:], strict=True)
        )
        outcome = try_compute(replace(task, path=paths[0], others=tuple(others)))
    if isinstance(outcome, UrdftoolError) and outcome.path is not None:
        known = dict(zip(map(str, paths), places, strict=True))
        return type(outcome)(outcome.message, path=known.get(str(outcome.path), task.path))
    return outcome


def read_task(task: Task) -> Sent:
    """Read the mesh files, and the buffers in their folders if they are glTF."""
    return task, [_read_files(path) for path in list_mesh_files(task)]


def _read_files(mesh: Path) -> dict[str, bytes]:
    paths = [mesh]
    if mesh.suffix.lower() == ".gltf":
        paths += list_companions(mesh, "*.bin")
    return {file.name: file.read_bytes() for file in paths if file.is_file()}
