"""Convex decomposition by CoACD, in a child process with a time limit.

CoACD's time grows fast with the number of triangles, and its pieces have as many as the cuts
produce. Therefore the mesh is decimated first, and each piece becomes a hull of few vertices. For
input that is not one closed body CoACD would create a surface of tens of thousands of triangles;
this module creates that surface first (``remesh``) and decimates it as well.
"""

from __future__ import annotations

import signal
from time import monotonic
from typing import Any

import numpy as np

from ..errors import MeshError, UrdftoolError
from ..geometry.mesh import Faces, Points
from ..geometry.topology import find_edges, label_bodies
from ..isolated import IsolatedProcess, ProcessDied, ProcessTimeout
from .convex import compute_capped_hull
from .decimate import decimate
from .measure import ReferenceSurface
from .notes import COACD_FAILED, COACD_KILLED
from .piece import Piece, make_mesh_piece
from .remesh import compute_remesh, intersect
from .surface import Prepared, prepare

TRIANGLES = 2000
"""Largest number of triangles of a mesh that is cut. Chosen, no source."""

PART_TRIANGLES = 600
"""Largest number of triangles of a piece that is cut again. Chosen, no source."""

_TOO_LONG = "CoACD took longer on the mesh than its time limit"

_ORDERLY = (1, 0, 14)
"""Version of CoACD before which threads share random numbers, or order pieces by their end."""

_SLOWEST = 4.0  # wall-clock time limit per processor time limit, for a busy machine


class DecompositionError(UrdftoolError):
    """CoACD ended without a result; ``code`` is that of a note on it."""

    code = COACD_FAILED


class KilledError(DecompositionError):
    """The process of CoACD was killed from outside."""

    code = COACD_KILLED


class Budget:
    """Processor time limit of all CoACD runs on one mesh."""

    def __init__(self, seconds: float) -> None:
        """Set the limit [s]."""
        self.seconds = seconds
        self.used = 0.0

    @property
    def left(self) -> float:
        """Return the remaining time [s].

        Raises:
            DecompositionError: No time remains.
        """
        if self.used >= self.seconds:
            raise DecompositionError(_TOO_LONG, data={"cause": "time limit"})
        return self.seconds - self.used

    def subtract(self, seconds: float) -> None:
        """Subtract used time [s]."""
        self.used += seconds


def make_solid(target: ReferenceSurface) -> Prepared:
    """Create a closed surface of few triangles close to a mesh, which CoACD accepts unchanged."""
    surface = target.surface
    vertices, faces = surface.vertices, surface.faces
    if not _is_one_body(surface):
        vertices, faces = compute_remesh(target.layer)
    return prepare(*decimate(vertices, faces, TRIANGLES)) or surface


def decompose(
    solid: Prepared,
    threshold: float,
    *,
    max_hulls: int = -1,
    max_vertices: int,
    budget: Budget,
    cores: int = 1,
) -> list[Piece]:
    """Decompose a solid into convex pieces.

    Args:
        solid: From :func:`make_solid`.
        threshold: Concavity at which CoACD stops, relative to half the longest side.
        max_hulls: Largest number of pieces; -1 for no limit.
        max_vertices: Largest number of vertices of a piece.
        budget: Remaining processor time for the mesh; the used time is subtracted.
        cores: Number of cores that CoACD may use.

    Raises:
        DecompositionError: CoACD crashed, took too long, or returned no piece.
        MissingDependency: coacd is not installed.
    """
    options = {
        "threshold": float(np.clip(threshold, 0.01, 1.0)),
        "max_convex_hull": max_hulls,
        "mcts_iterations": 20,
        "mcts_nodes": 10,
        "mcts_max_depth": 1,
        "resolution": 500,
        "merge": max_hulls != -1,  # merge.py joins into fewer pieces
        "preprocess_mode": "off",
        "seed": 0,
        "time_limit": budget.left,
    }
    before = _measure_children_time()
    try:
        parts = run_child(solid.vertices, solid.faces, options, choose_threads(cores))
    finally:
        budget.subtract(_measure_children_time() - before)
    return _compute_hulls(parts, max_vertices)


def _measure_children_time() -> float:
    """Return the processor time of ended child processes [s], or wall-clock time on Windows."""
    try:
        import resource
    except ImportError:  # Windows
        return monotonic()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def divide(
    solid: Prepared,
    piece: Piece,
    distance: float,
    *,
    max_vertices: int,
    budget: Budget,
    cores: int = 1,
) -> list[Piece]:
    """Decompose a piece that is too far from the solid into smaller ones.

    Args:
        solid: The solid that was cut.
        piece: A piece of it.
        distance: Acceptable distance of the new pieces [m].
        max_vertices: Largest number of vertices of a piece.
        budget: Remaining processor time for the mesh; the used time is subtracted.
        cores: Number of cores that CoACD may use.

    Returns:
        The pieces; empty if the piece and the solid do not intersect.

    Raises:
        DecompositionError: CoACD crashed, took too long, or returned no piece.
    """
    part = intersect(solid.corners, piece.vertices, piece.faces)
    if part is None:
        return []
    made = prepare(*decimate(*part, PART_TRIANGLES))
    if made is None:
        return []
    longest = float(np.ptp(made.vertices, axis=0).max())
    return decompose(
        made, 2 * distance / longest, max_vertices=max_vertices, budget=budget, cores=cores
    )


def _is_one_body(surface: Prepared) -> bool:
    if not surface.closed:
        return False
    edges = find_edges(surface.faces)
    twice = bool((edges.forward == 1).all() and (edges.backward == 1).all())
    return twice and int(label_bodies(len(surface.faces), edges).max()) == 0


def _compute_hulls(parts: list[Points], max_vertices: int) -> list[Piece]:
    pieces = []
    for points in parts:
        try:
            vertices, faces = compute_capped_hull(points, max_vertices)
        except MeshError:  # a sliver of a cut
            continue
        pieces.append(make_mesh_piece(vertices, faces))
    if not pieces:
        message = "CoACD gave no piece with a volume"
        raise DecompositionError(message, data={"cause": "no piece"})
    # deterministic order, independent of the search
    pieces.sort(key=lambda piece: (-len(piece.faces), *piece.vertices.mean(axis=0).round(9)))
    return pieces


def choose_threads(cores: int) -> int:
    """Return the number of threads for which this version of CoACD is deterministic."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        numbers = tuple(int(part) for part in version("coacd").split(".")[:3])
    except (PackageNotFoundError, ValueError):
        return 1
    return cores if numbers >= _ORDERLY else 1


def run_child(
    vertices: Points, faces: Faces, options: dict[str, Any], threads: int = 1
) -> list[Points]:
    """Run CoACD in an isolated process; return the points of each piece.

    Raises:
        DecompositionError: It crashed or took too long.
        MissingDependency: coacd is not installed.
    """
    options = dict(options)
    limit = options.pop("time_limit")
    begin = _measure_children_time()
    try:
        with IsolatedProcess("numpy", environment={"OMP_NUM_THREADS": str(threads)}) as process:
            found: list[Points] = process.call(
                f"{__package__}.coacd_child", "decompose", vertices, faces, options,
                time_limit=limit * _SLOWEST + 10, processor_limit=limit + 1,
            )  # fmt: skip
    except ProcessTimeout:
        raise DecompositionError(_TOO_LONG, data={"cause": "time limit"}) from None
    except ProcessDied as error:
        in_time = _measure_children_time() - begin < limit
        raise _explain_death(error, in_time=in_time) from None
    return found


def _explain_death(error: ProcessDied, *, in_time: bool) -> DecompositionError:
    code = error.exit_code
    if code == -getattr(signal, "SIGKILL", 9) and in_time:
        return KilledError("CoACD was killed, probably out of memory")
    if code < 0 and -code in (getattr(signal, "SIGXCPU", 0), getattr(signal, "SIGKILL", 9)):
        return DecompositionError(_TOO_LONG, data={"cause": "time limit"})
    last = error.output[-1].strip() if error.output else ""
    if any("Assertion" in line for line in error.output):
        last = "an assertion of its own failed"
    details = f": {last[:120]}" if last else ""
    message = f"CoACD died ({error.message}{details})"
    return DecompositionError(message, data={"cause": "died"})
