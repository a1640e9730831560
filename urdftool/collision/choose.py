"""Selection of a method; ``auto`` takes the cheapest geometry whose error is small enough.

Cost is that of contact computation: primitives are cheaper than hulls, few hulls than many, few
vertices than many. ``auto`` never takes a concave mesh: PyBullet and MuJoCo use its hull for moving
bodies, which is already measured.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..diagnostic import Diagnostic, warning
from ..errors import MeshError
from ..geometry.topology import body_labels, edges_of
from .convex import capped_hull, thickened
from .cut import Cutter
from .decimate import decimate
from .decompose import DecompositionError
from .measure import Measures, Target, hull_error, measure
from .piece import PRIMITIVES, Piece, mesh_piece
from .primitives import fit_primitives, signed_distance
from .settings import FEW_HULLS, Settings
from .surface import Prepared, flat_labels

LADDER = (3.0, 1.0)
"""Distances for CoACD's cuts in ``auto``, in multiples of the error, coarse first: few pieces are
often sufficient, and each step takes several times as long."""

PLATE = 0.002
"""Thickness given to a flat mesh, relative to its size."""

_MEASURED = 3  # number of best fitting primitives that are measured
_SHARE = 0.3  # part of the error that dropping hull vertices may use
_COARSER = 3.0
_SIMPLER = 0.05  # part of the mean distance that a costlier primitive must save
_ALIKE = 0.02  # part of the error that it must save in addition


@dataclass(frozen=True)
class Choice:
    """Pieces with their method and quality.

    Attributes:
        method: ``"primitive"``, ``"hull"``, ``"coacd"`` or ``"simplify"``.
        pieces: Pieces in the mesh's frame.
        measures: Their quality.
        notes: Failed attempts and substitutes.
    """

    method: str
    pieces: list[Piece]
    measures: Measures
    notes: tuple[Diagnostic, ...] = ()


def choose(surface: Prepared, settings: Settings, cores: int = 1) -> Choice:
    """Compute the collision geometry of one mesh, independently of the number of cores.

    Args:
        surface: The mesh.
        settings: Method and limits.
        cores: Number of cores to use.

    Raises:
        MeshError: All points of the mesh lie on a line.
        MissingDependency: A library that the method requires is not installed.
    """
    target = Target(surface, cores)
    notes: list[Diagnostic] = []
    if _is_flat(surface):
        return _plate(surface, target)
    if settings.method != "auto":
        found = _METHODS[settings.method](target, settings, notes)
        best = min(found, key=lambda choice: (choice.measures.error, choice.measures.mean))
        return replace(best, notes=tuple(notes))
    tried: list[Choice] = []
    for step in (_primitives, _hulls, _bodies, _sheets, _ladder):
        fits = []
        for choice in step(target, settings, notes):
            tried.append(choice)
            if choice.measures.error <= settings.max_error:
                fits.append(choice)
                if step is not _primitives:
                    break
        if fits:
            wanted = settings.max_error * target.size
            best = min(fits, key=lambda choice: _dearness(choice, wanted))
            return replace(best, notes=tuple(notes))
    best = min(tried, key=lambda choice: choice.measures.error)
    return replace(best, notes=tuple(notes))


def _dearness(choice: Choice, wanted: float) -> float:
    """Return the mean distance [m] plus a penalty for primitives that are costly in contact."""
    kind = choice.pieces[0].kind
    rank = PRIMITIVES.index(kind) if kind in PRIMITIVES else 0
    return choice.measures.mean * (1 + _SIMPLER * rank) + _ALIKE * wanted * rank


def _is_flat(surface: Prepared) -> bool:
    """Tell whether all points are coplanar to within rounding."""
    centred = surface.vertices - surface.vertices.mean(axis=0)
    _, axes = np.linalg.eigh(centred.T @ centred)
    return float(np.ptp(centred @ axes[:, 0])) <= 1e-6 * surface.size


def _plate(surface: Prepared, target: Target) -> Choice:
    thickness = PLATE * surface.size
    vertices, faces = capped_hull(thickened(surface.vertices, thickness), 64)
    pieces = [mesh_piece(vertices, faces)]
    message = f"The mesh is flat; its collision is its outline, {thickness * 1000:.3g} mm thick."
    note = warning("flat-mesh", message, thickness=thickness)
    return Choice("hull", pieces, measure(target, pieces), (note,))


def _primitives(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield the primitives with the smallest largest distance from the visual."""
    even = target.even
    fits = fit_primitives(even)
    fits.sort(key=lambda piece: float(np.abs(signed_distance(piece, even)).max()))
    for piece in fits[:_MEASURED]:
        yield Choice("primitive", [piece], measure(target, [piece]))


def _hulls(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield one hull: with as few vertices as the error allows, then with as many as permitted."""
    points = target.surface.vertices
    tolerances = [0.0]
    if settings.method == "auto":
        tolerances = [_SHARE * settings.max_error * target.size, 0.0]
    for tolerance in tolerances:
        vertices, faces = capped_hull(points, settings.max_vertices, tolerance)
        pieces = [mesh_piece(vertices, faces)]
        choice = Choice("hull", pieces, measure(target, pieces))
        yield choice
        if choice.measures.error > 3 * settings.max_error:
            return


def _bodies(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield one hull per exterior body, if there are several but not too many."""
    surface = target.surface
    labels = body_labels(len(surface.faces), edges_of(surface.faces))
    count = int(labels.max()) + 1
    if count < 2:
        return
    seen = target.flood.touches(surface.vertices)
    tolerance = _SHARE * settings.max_error * target.size
    pieces: list[Piece] = []
    for label in range(count):
        used = np.unique(surface.faces[labels == label])
        if not seen[used].any():
            continue
        points = surface.vertices[used]
        if float(np.linalg.norm(np.ptp(points, axis=0))) < tolerance:
            continue
        if len(pieces) == (settings.max_hulls or FEW_HULLS):
            return
        try:
            vertices, faces = capped_hull(points, settings.max_vertices, tolerance)
        except MeshError:  # a decal, or an isolated face
            continue
        pieces.append(mesh_piece(vertices, faces))
    if len(pieces) > 1:
        yield Choice("hull", pieces, measure(target, pieces))


def _sheets(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield one plate per flat side of an open mesh, if there are not too many."""
    surface = target.surface
    if surface.closed:
        return
    labels = flat_labels(surface)
    if int(labels.max()) + 1 > (settings.max_hulls or FEW_HULLS):
        return
    try:
        pieces = []
        for label in range(int(labels.max()) + 1):
            points = surface.vertices[np.unique(surface.faces[labels == label])]
            plate = thickened(points, PLATE * surface.size)
            pieces.append(mesh_piece(*capped_hull(plate, settings.max_vertices)))
    except MeshError:  # a sliver
        return
    yield Choice("hull", pieces, measure(target, pieces))


def _ladder(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield CoACD results with finer and finer cuts, within the permitted number of pieces."""
    cutter = Cutter(target, settings, few=settings.max_hulls or FEW_HULLS)
    wanted = settings.max_error * target.size
    for factor in LADDER:
        try:
            made = cutter.cut(factor * wanted, wanted, last=factor == LADDER[-1])
        except DecompositionError as error:
            message = f"{error.message}, at {factor:g} times the error; it was left out."
            notes.append(warning("coacd-failed", message, factor=factor, **error.data))
            break
        finally:
            notes += cutter.notes
            cutter.notes.clear()
        if cutter.hopeless:  # finer cuts give even more pieces
            break
        if made is not None and len(made[0]) <= (settings.max_hulls or FEW_HULLS):
            yield Choice("coacd", *made)
            return
    coarse = cutter.coarser(wanted)
    if coarse is not None and len(coarse[0]) <= (settings.max_hulls or FEW_HULLS):
        yield Choice("coacd", *coarse)


def _coacd(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield CoACD's result at its threshold; a coarser one if it fails, and one hull if both do."""
    cutter = Cutter(target, settings, most=settings.max_hulls)
    for threshold in (settings.threshold, settings.threshold * _COARSER):
        wanted = threshold * target.longest / 2
        try:
            made = cutter.cut(wanted, wanted)
        except DecompositionError as error:
            message = f"{error.message}, at a threshold of {threshold:g}."
            notes.append(warning("coacd-failed", message, threshold=threshold, **error.data))
            continue
        assert made is not None
        notes += cutter.notes
        yield Choice("coacd", *made)
        return
    notes.append(warning("hull-instead", "One convex hull was taken instead."))
    yield from _hulls(target, settings, notes)


def _simplified(target: Target, settings: Settings, notes: list[Diagnostic]) -> Iterator[Choice]:
    """Yield the mesh with fewer triangles."""
    surface = target.surface
    vertices, faces = decimate(surface.vertices, surface.faces, settings.max_triangles)
    pieces = [mesh_piece(vertices, faces, convex=False)]
    felt = hull_error(target, pieces[0])
    if felt > settings.max_error:
        message = f"Engines that take the hull of a moving mesh touch it with {felt:.2%} error."
        notes.append(warning("hull-of-moving-mesh", message, error=felt))
    yield Choice("simplify", pieces, measure(target, pieces))


_METHODS: dict[str, Callable[[Target, Settings, list[Diagnostic]], Iterator[Choice]]] = {
    "primitive": _primitives,
    "hull": _hulls,
    "coacd": _coacd,
    "simplify": _simplified,
}
