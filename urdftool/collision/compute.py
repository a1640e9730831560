"""Simplification of one mesh file: task, result and their serialization."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any

from ..diagnostic import Diagnostic
from ..errors import MeshError, UrdftoolError
from ..model.pose import Pose
from ..source.description import GltfUp
from .notes import COACD_KILLED, pack_note, unpack_note
from .piece import Piece, parse_piece
from .settings import Settings

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class PlacedMesh:
    """Another mesh of a link."""

    path: Path
    scale: Vector
    pose: Pose


@dataclass(frozen=True)
class Task:
    """A mesh, or the meshes of a link, to simplify; the same task always has the same result.

    Attributes:
        path: The mesh file.
        scale: Factors, as URDF's ``<mesh scale>``.
        settings: Method and limits.
        gltf_up: Up axis of a glTF file.
        others: Meshes that are simplified together with it.
    """

    path: Path
    scale: Vector = (1.0, 1.0, 1.0)
    settings: Settings = field(default_factory=Settings)
    gltf_up: GltfUp = "y"
    others: tuple[PlacedMesh, ...] = ()


def list_mesh_files(task: Task) -> list[Path]:
    """Return the mesh files of a task."""
    return [task.path, *(other.path for other in task.others)]


MEASURES = (
    *("error", "reach", "excess", "size", "hausdorff", "mean", "visual_to_collision"),
    *("collision_to_visual", "buried", "uncovered", "volume", "volume_ratio", "outside"),
    *("enclosed", "pieces", "triangles", "vertices"),
)
"""Names in :meth:`Measures.as_dict`, whose module is not imported to read a result."""


@dataclass(frozen=True, eq=False)
class Result:
    """Collision geometry of a mesh, or of the meshes of a link.

    Attributes:
        method: The method that was used.
        pieces: Pieces in the frame of the mesh, or of the first one.
        measures: Quality, as :meth:`Measures.as_dict`.
        before: ``triangles`` and ``vertices`` of the meshes.
        diagnostics: Repairs of the mesh (info), and failures and substitutes (warning).
        seconds: Computation time [s].
        cached: Whether it comes from the cache.
    """

    method: str
    pieces: list[Piece]
    measures: dict[str, Any]
    before: dict[str, int]
    diagnostics: tuple[Diagnostic, ...]
    seconds: float
    cached: bool = False

    @property
    def notes(self) -> tuple[str, ...]:
        """Return the messages of the diagnostics: complete sentences."""
        return tuple(found.message for found in self.diagnostics)

    @property
    def error(self) -> float:
        """Return the larger one of reach and excess, relative to the size."""
        return float(self.measures["error"])

    @property
    def lasting(self) -> bool:
        """Tell whether the result is reproducible, as no process was killed from outside."""
        return not any(note.code == COACD_KILLED for note in self.diagnostics)

    def as_bytes(self) -> bytes:
        """Serialize the result for :func:`parse_result`."""
        table = {
            "method": self.method,
            "pieces": [piece.as_dict() for piece in self.pieces],
            "measures": self.measures,
            "before": self.before,
            "notes": [pack_note(note) for note in self.diagnostics],
            "seconds": self.seconds,
        }
        return json.dumps(table, separators=(",", ":")).encode()


def parse_result(data: bytes, *, cached: bool = False) -> Result:
    """Deserialize the output of :meth:`Result.as_bytes`.

    Raises:
        ValueError: The data is damaged.
    """
    try:
        table = json.loads(data)
        return Result(
            str(table["method"]),
            [parse_piece(piece) for piece in table["pieces"]],
            _read_numbers(table["measures"], MEASURES),
            _read_numbers(table["before"], ("triangles", "vertices")),
            tuple(unpack_note(note) for note in table["notes"]),
            float(table["seconds"]),
            cached,
        )
    except (LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        raise ValueError(f"a result that cannot be read: {error}") from error


def _read_numbers(table: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
    """Return the numbers of these names, of which there must be no others.

    Raises:
        ValueError: A name or a number is missing.
    """
    if set(table) != set(names) or any(type(table[name]) not in (int, float) for name in names):
        raise ValueError("a result that cannot be read: other measures")
    return dict(table)


def compute(task: Task, cores: int = 1) -> Result:
    """Simplify a mesh, or the meshes of a link, independently of the number of cores.

    Raises:
        UrdftoolError: The mesh cannot be read or simplified.
    """
    from .choose import choose
    from .surface import merge_surfaces, read_surface

    begin = perf_counter()
    surface = read_surface(task.path, task.scale, task.gltf_up)
    if task.others:
        others = [(read_surface(o.path, o.scale, task.gltf_up), o.pose) for o in task.others]
        surface = merge_surfaces(surface, others)
    try:
        choice = choose(surface, task.settings, cores)
    except MeshError as error:
        raise MeshError(error.message, path=task.path) from error
    return Result(
        choice.method,
        choice.pieces,
        choice.measures.as_dict(),
        {"triangles": surface.triangles, "vertices": surface.points},
        (*surface.notes, *choice.notes),
        perf_counter() - begin,
    )


def try_compute(task: Task, cores: int = 1) -> bytes | UrdftoolError:
    """Run :func:`compute`, and return errors as values, so that they can cross processes."""
    try:
        return compute(task, cores).as_bytes()
    except UrdftoolError as error:
        return type(error)(error.message, path=error.path)
    except (MemoryError, RecursionError) as error:
        return MeshError(
            f"the mesh is too large to be simplified ({type(error).__name__})", path=task.path
        )


def format_scale(scale: Sequence[float]) -> str:
    """Format a scale such as ``×0.001``; empty if all factors are 1."""
    if all(factor == 1 for factor in scale):
        return ""
    if len(set(scale)) == 1:
        return f"×{scale[0]:g}"
    return "×" + ",".join(f"{factor:g}" for factor in scale)
