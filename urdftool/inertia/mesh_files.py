"""Reading and integration of a robot's meshes, each once, in parallel if that is faster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path

from ..errors import UrdftoolError
from ..parallel import Loss, count_cores, map_tasks
from ..source.description import Description, GltfUp
from ..storage import DiskCache, cache_folder
from .bodies import MeshBody, get_cached_mesh_body

WORTH_IT = 4_000_000
"""Total size of meshes [bytes] above which additional processes save time."""

Progress = Callable[[int, int, str], None]
ReadMeshes = Callable[[Sequence[str]], "dict[str, MeshBody | UrdftoolError]"]


def read_meshes(
    description: Description,
    names: Iterable[str],
    *,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> dict[str, MeshBody | UrdftoolError]:
    """Integrate each mesh at unit density.

    Args:
        description: The description of the robot, which resolves URIs.
        names: Mesh URIs as written.
        jobs: Number of processes; None for one per core if the meshes are large enough.
        progress: Called after each mesh, with the number done, the total and the file name.

    Returns:
        The body of each mesh by its written URI, or the error.
    """
    found: dict[str, MeshBody | UrdftoolError] = {}
    paths: dict[str, Path] = {}
    for name in dict.fromkeys(names):
        try:
            if not name:
                raise UrdftoolError("the mesh has no file name")
            paths[name] = description.resolve(name)
        except UrdftoolError as error:
            found[name] = error
    unique = list(dict.fromkeys(paths.values()))
    bodies: dict[Path, MeshBody | UrdftoolError] = {}
    for path, body in _list_bodies(unique, jobs, description.gltf_up):
        bodies[path] = body
        if progress is not None:
            progress(len(bodies), len(unique), path.name)
    return found | {name: bodies[path] for name, path in paths.items()}


def _list_bodies(
    paths: list[Path], jobs: int | None, gltf_up: GltfUp
) -> Iterator[tuple[Path, MeshBody | UrdftoolError]]:
    workers = jobs or _choose_jobs(paths)
    if workers > 1:  # largest first, so that all processes finish at about the same time
        paths = sorted(paths, key=_get_size, reverse=True)
    read = partial(_make_body, gltf_up=gltf_up)
    for index, body in map_tasks(read, paths, workers=workers, on_lost=_make_worker_error):
        yield paths[index], body


def _make_worker_error(path: Path, _: Loss) -> UrdftoolError:
    return UrdftoolError(
        "the process that read the mesh was killed twice (probably out of memory)", path=path
    )


def _make_body(path: Path, gltf_up: GltfUp) -> MeshBody | UrdftoolError:
    try:
        return get_cached_mesh_body(path, DiskCache(cache_folder("meshes")), gltf_up=gltf_up)
    except UrdftoolError as error:
        # the chain of causes cannot be sent between processes
        return UrdftoolError(error.message, path=error.path)
    except (MemoryError, RecursionError) as error:
        return UrdftoolError(
            f"the mesh is too large to be read ({type(error).__name__})", path=path
        )


def _choose_jobs(paths: list[Path]) -> int:
    if len(paths) < 2 or sum(map(_get_size, paths)) < WORTH_IT:
        return 1
    return count_cores()


def _get_size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


class Meshes:
    """Cache of mesh bodies, read on demand."""

    def __init__(self, read: ReadMeshes) -> None:
        """Create an empty cache."""
        self.read = read
        self.known: dict[str, MeshBody | UrdftoolError] = {}

    def load(self, names: Iterator[str] | Sequence[str]) -> dict[str, MeshBody | UrdftoolError]:
        """Read missing meshes, and return all that have been read."""
        new = [name for name in dict.fromkeys(names) if name not in self.known]
        if new:
            self.known |= self.read(new)
        return self.known
