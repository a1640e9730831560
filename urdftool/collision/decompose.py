"""Convex pieces by CoACD, kept at arm's length: a child process with a limit of time.

CoACD's time grows fast with the number of triangles, and its pieces have as many as the cuts left
them with. So the mesh is simplified first, and each piece is a hull of few vertices afterwards.
What is not one closed body, CoACD would give a surface of tens of thousands of triangles; here that
surface is made first (``remesh``), and simplified like any other.
"""

from __future__ import annotations

import signal
from time import monotonic
from typing import Any

import numpy as np

from ..errors import MeshError, UrdftoolError
from ..geometry.mesh import Faces, Points
from ..geometry.topology import body_labels, edges_of
from ..isolated import IsolatedProcess, ProcessDied, ProcessTimeout
from .convex import capped_hull
from .decimate import decimate
from .measure import Target
from .piece import Piece, mesh_piece
from .remesh import common, remesh
from .settings import KILLED
from .surface import Prepared, prepare

TRIANGLES = 2000
"""Triangles that a mesh has at most when it is cut."""

PART_TRIANGLES = 600
"""Triangles that a piece has at most when it is cut again."""

_TOO_LONG = "CoACD took longer on the mesh than its time limit"
# before, threads shared a row of quasirandom numbers, or pieces came in the order they ended in
_ORDERLY = (1, 0, 14)
_SLOWEST = 4.0  # share of a processor that a child may be left with before the watch ends it


class DecompositionError(UrdftoolError):
    """CoACD ended without a result."""


class Budget:
    """Processor time that all runs of CoACD on one mesh may take together."""

    def __init__(self, seconds: float) -> None:
        """Begin with all of it [s]."""
        self.seconds = seconds
        self.used = 0.0

    @property
    def left(self) -> float:
        """What is left of it [s].

        Raises:
            DecompositionError: Nothing is.
        """
        if self.used >= self.seconds:
            raise DecompositionError(_TOO_LONG)
        return self.seconds - self.used

    def spend(self, seconds: float) -> None:
        """Take some from it [s]."""
        self.used += seconds


def solid_of(target: Target) -> Prepared:
    """A closed surface of few triangles near to a mesh, which CoACD takes as it is."""
    surface = target.surface
    vertices, faces = surface.vertices, surface.faces
    if not _is_one_body(surface):
        vertices, faces = remesh(target.layer)
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
    """Convex pieces that together are near to a solid.

    Args:
        solid: From :func:`solid_of`.
        threshold: Concavity at which CoACD stops to cut, relative to half the longest side.
        max_hulls: Pieces it may make; -1 is any number.
        max_vertices: Vertices each may have.
        budget: Processor time that is left for the mesh; what it takes is taken from it.
        cores: How many CoACD may use.

    Raises:
        DecompositionError: It died, took too long, or gave nothing.
        MissingDependency: coacd is not installed.
    """
    options = {
        "threshold": float(np.clip(threshold, 0.01, 1.0)),
        "max_convex_hull": max_hulls,
        "mcts_iterations": 20,
        "mcts_nodes": 10,
        "mcts_max_depth": 1,
        "resolution": 500,
        "merge": max_hulls != -1,  # joined by what is measured, they are fewer
        "preprocess_mode": "off",
        "seed": 0,
        "time_limit": budget.left,
    }
    before = _children_time()
    try:
        parts = run_child(solid.vertices, solid.faces, options, threads_of(cores))
    finally:
        budget.spend(_children_time() - before)
    return _hulls(parts, max_vertices)


def _children_time() -> float:
    """Processor time of the children that have ended [s]; where it is not told, the clock."""
    try:
        import resource
    except ImportError:  # Windows
        return monotonic()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def divided(
    solid: Prepared,
    piece: Piece,
    distance: float,
    *,
    max_vertices: int,
    budget: Budget,
    cores: int = 1,
) -> list[Piece]:
    """Smaller pieces in the place of one that is too far from the solid.

    Args:
        solid: What was cut.
        piece: A piece of it.
        distance: How far from it the new pieces may be [m].
        max_vertices: Vertices each may have.
        budget: Processor time that is left for the mesh; what it takes is taken from it.
        cores: How many CoACD may use.

    Raises:
        DecompositionError: It died, took too long, or gave nothing.
    """
    part = common(solid.corners, piece.vertices, piece.faces)
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
    edges = edges_of(surface.faces)
    twice = bool((edges.forward == 1).all() and (edges.backward == 1).all())
    return twice and int(body_labels(len(surface.faces), edges).max()) == 0


def _hulls(parts: list[Points], max_vertices: int) -> list[Piece]:
    pieces = []
    for points in parts:
        try:
            vertices, faces = capped_hull(points, max_vertices)
        except MeshError:  # a sliver of a cut
            continue
        pieces.append(mesh_piece(vertices, faces))
    if not pieces:
        raise DecompositionError("CoACD gave no piece with a volume")
    # an order that does not hang on the search
    pieces.sort(key=lambda piece: (-len(piece.faces), *piece.vertices.mean(axis=0).round(9)))
    return pieces


def threads_of(cores: int) -> int:
    """How many threads CoACD may work with so that its pieces do not hang on their number."""
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
        DecompositionError: It died or took too long.
        MissingDependency: coacd is not installed.
    """
    options = dict(options)
    limit = options.pop("time_limit")
    begin = _children_time()
    try:
        with IsolatedProcess("numpy", environment={"OMP_NUM_THREADS": str(threads)}) as process:
            found: list[Points] = process.call(
                f"{__package__}.coacd_child", "decompose", vertices, faces, options,
                time_limit=limit * _SLOWEST + 10, processor_limit=limit + 1,
            )  # fmt: skip
    except ProcessTimeout:
        raise DecompositionError(_TOO_LONG) from None
    except ProcessDied as error:
        in_time = _children_time() - begin < limit
        raise _death(error, in_time=in_time) from None
    return found


def _death(error: ProcessDied, *, in_time: bool) -> DecompositionError:
    code = error.exit_code
    if code == -getattr(signal, "SIGKILL", 9) and in_time:
        return DecompositionError(KILLED)
    if code < 0 and -code in (getattr(signal, "SIGXCPU", 0), getattr(signal, "SIGKILL", 9)):
        return DecompositionError(_TOO_LONG)
    last = error.output[-1].strip() if error.output else ""
    if any("Assertion" in line for line in error.output):
        last = "an assertion of its own failed"
    details = f": {last[:120]}" if last else ""
    return DecompositionError(f"CoACD died ({error.message}{details})")
