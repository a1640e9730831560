"""The meshes of a robot, each read and integrated once, several at a time where that is faster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path

from ..errors import UrdftoolError
from ..parallel import Loss, cores, map_tasks
from ..source.description import Description, GltfUp
from .bodies import MeshBody, mesh_body

WORTH_IT = 4_000_000
"""Bytes of meshes from which on starting further processes takes less time than it saves."""

Progress = Callable[[int, int, str], None]
ReadMeshes = Callable[[Sequence[str]], "dict[str, MeshBody | UrdftoolError]"]


def read_meshes(
    description: Description,
    names: Iterable[str],
    *,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> dict[str, MeshBody | UrdftoolError]:
    """What each mesh encloses, or why that is not known, by its name as it is written.

    Args:
        description: The robot's, which knows where packages are.
        names: Mesh files as the robot names them.
        jobs: Processes to use; None is one per core where it is worth it.
        progress: Called with how many are done, of how many, and which comes next.
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
    for path, body in _bodies(unique, jobs, description.gltf_up):
        bodies[path] = body
        if progress is not None:
            progress(len(bodies), len(unique), path.name)
    return found | {name: bodies[path] for name, path in paths.items()}


def _bodies(
    paths: list[Path], jobs: int | None, gltf_up: GltfUp
) -> Iterator[tuple[Path, MeshBody | UrdftoolError]]:
    workers = jobs or _worthwhile(paths)
    if workers > 1:  # the slowest first, so that none is left alone at the end
        paths = sorted(paths, key=_size, reverse=True)
    read = partial(_body, gltf_up=gltf_up)
    for index, body in map_tasks(read, paths, workers=workers, on_lost=_lost):
        yield paths[index], body


def _lost(path: Path, _: Loss) -> UrdftoolError:
    return UrdftoolError(
        "the process that read the mesh was killed twice, perhaps because memory ran out", path=path
    )


def _body(path: Path, gltf_up: GltfUp) -> MeshBody | UrdftoolError:
    try:
        return mesh_body(path, gltf_up=gltf_up)
    except UrdftoolError as error:
        # without the chain of causes it goes from one process to another
        return UrdftoolError(error.message, path=error.path)
    except (MemoryError, RecursionError) as error:
        return UrdftoolError(
            f"the mesh is too large to be read ({type(error).__name__})", path=path
        )


def _worthwhile(paths: list[Path]) -> int:
    if len(paths) < 2 or sum(map(_size, paths)) < WORTH_IT:
        return 1
    return cores()


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


class Meshes:
    """Meshes that have been read, and more where they are wanted."""

    def __init__(self, read: ReadMeshes) -> None:
        """Start with none."""
        self.read = read
        self.known: dict[str, MeshBody | UrdftoolError] = {}

    def want(self, names: Iterator[str] | Sequence[str]) -> dict[str, MeshBody | UrdftoolError]:
        """All that have been read, with these among them."""
        new = [name for name in dict.fromkeys(names) if name not in self.known]
        if new:
            self.known |= self.read(new)
        return self.known
