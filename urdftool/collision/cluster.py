"""Simplification on a Dask cluster, for thousands of meshes.

The workers require urdftool with its extra ``collision``, but no access to the files, which are
sent.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ..errors import UrdftoolError
from ..extras import make_missing_error
from ..source.access import list_companions
from .compute import Task, try_compute


def run_on_cluster(
    tasks: Sequence[Task], address: str
) -> Iterator[tuple[int, bytes | UrdftoolError]]:
    """Yield the index and outcome of each task, in order of completion.

    Args:
        tasks: The tasks.
        address: Address of the Dask scheduler.

    Raises:
        MissingDependency: distributed is not installed.
        UrdftoolError: No scheduler answers at the address.
    """
    try:
        import distributed
    except ImportError as error:
        raise make_missing_error("distributed", "--dask") from error
    try:
        library: Any = distributed
        client: Any = library.Client(address, timeout=10)
    except (OSError, ValueError, TimeoutError) as error:
        raise UrdftoolError(
            f"no Dask scheduler answers at {address}; start one with `dask scheduler`"
        ) from error
    with client:
        futures = {
            client.submit(simplify_file, task, _read_files(task.path), pure=False): index
            for index, task in enumerate(tasks)
        }
        for future in library.as_completed(list(futures)):
            index = futures[future]
            try:
                outcome = future.result()
            # a worker may fail with any exception
            except Exception as error:
                outcome = UrdftoolError(
                    f"the cluster gave it up: {type(error).__name__}: {error}",
                    path=tasks[index].path,
                )
            future.release()
            yield index, outcome


def simplify_file(task: Task, files: dict[str, bytes]) -> bytes | UrdftoolError:
    """Simplify a mesh on a worker, from its file contents; errors refer to the original path."""
    import tempfile
    from dataclasses import replace

    with tempfile.TemporaryDirectory(prefix="urdftool-") as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        outcome = try_compute(replace(task, path=Path(folder) / task.path.name))
    if isinstance(outcome, UrdftoolError) and outcome.path is not None:
        return type(outcome)(outcome.message, path=task.path)
    return outcome


def _read_files(path: Path) -> dict[str, bytes]:
    """Read the mesh file, and the buffers in its folder if it is glTF."""
    paths = [path]
    if path.suffix.lower() == ".gltf":
        paths += list_companions(path, "*.bin")
    return {file.name: file.read_bytes() for file in paths if file.is_file()}
