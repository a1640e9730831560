"""Selection of a method; ``auto`` takes the cheapest geometry whose error is small enough.

Cost is that of contact computation: primitives are cheaper than hulls, few hulls than many, few
vertices than many. ``auto`` never takes a concave mesh: PyBullet and MuJoCo use its hull for moving
bodies, which is already measured. Where no geometry is within the error, the one with the smallest
error is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..diagnostic import Diagnostic
from ..errors import MeshError
from ..geometry.mesh import Points
from ..geometry.topology import find_edges, find_used_vertices, label_bodies
from .convex import compute_capped_hull, thicken
from .cut import Cutter
from .cuts import PlaneCutter
from .decimate import decimate
from .decompose import DecompositionError
from .distance import spread
from .exterior import BALL
from .measure import Measures, ReferenceSurface, compute_hull_error, measure
from .notes import (
    CLOSED_GAP,
    FLAT_MESH,
    HULL_INSTEAD,
    HULL_OF_ENGINES,
    MORE_PIECES,
    SPHERES,
    make_note,
)
from .piece import PRIMITIVES, Piece, make_mesh_piece
from .primitives import fit_primitives, measure_primitive_distance
from .settings import Settings
from .sphere_fit import fit_spheres
from .spheres import cover_with_spheres
from .surface import Prepared, label_flat_sides

PLATE = 0.002
"""Thickness given to a flat mesh, relative to its size. Chosen, no source."""

# chosen, no source, where a line gives none
_BODY_SAMPLES = 2000  # of a body, to which primitives are fitted
_MEASURED = 3  # number of best fitting primitives that are measured
_SHARE = 0.1  # part of the error that dropping hull vertices may use
_COARSER = 3.0  # ratio of CoACD's second threshold to the first; chosen, no source
_SIMPLER = 0.05  # part of the mean distance that a costlier primitive must save
_ALIKE = 0.02  # part of the error that it must save in addition
_HULL_WITHIN = 1.3  # ratio of the hull's estimated error to the limit up to which it is measured
_HELPS = 0.95  # part of the error that more pieces must give to be worth a note
_PRIMITIVE_WITHIN = 2.2  # a primitive within the limit has a hull within twice the limit


@dataclass(frozen=True)
class Choice:
    """Pieces with their method and quality."""

    method: str
    pieces: list[Piece]
    measures: Measures
    notes: tuple[Diagnostic, ...] = ()


def choose(surface: Prepared, settings: Settings, cores: int = 1) -> Choice:
    """Compute the collision geometry of one mesh, independently of the number of cores.

    Raises:
        MeshError: All points of the mesh lie on a line.
        MissingDependency: A library that the method requires is not installed.
    """
    target = ReferenceSurface(surface, cores, settings.effort.cell)
    if _is_flat(surface):
        return _make_plate(surface, target)
    notes: list[Diagnostic] = []
    if settings.method == "auto":
        best = _choose_automatically(target, settings, notes)
    else:
        found = _METHODS[settings.method](target, settings, notes)
        best = min(found, key=lambda choice: (choice.measures.error, choice.measures.mean))
    return replace(best, notes=tuple(notes))


def _choose_automatically(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Choice:
    """Return the cheapest choice within the error, or that with the smallest error."""
    cutter = PlaneCutter(target, settings.max_vertices, settings.effort)
    limit = settings.max_error * target.size
    whole = cutter.whole
    hull = 0.0 if whole is None else whole.cost
    tried: list[Choice] = []
    steps: list[tuple[float, Iterator[Choice]]] = [
        (_PRIMITIVE_WITHIN, _try_primitives(target, settings, notes)),
        (_HULL_WITHIN, _try_hulls(target, settings, notes)),
        (np.inf, _try_bodies(target, settings, notes, cutter)),
        (np.inf, _try_sheets(target, settings, notes)),
        (np.inf, _try_plane_cuts(target, settings, notes, cutter)),
    ]
    for number, (within, choices) in enumerate(steps):
        if hull > within * limit:
            continue
        fits = []
        for choice in choices:
            tried.append(choice)
            if choice.measures.error <= settings.max_error:
                fits.append(choice)
                if number:  # primitives are compared, as their costs differ little
                    break
        if fits:
            return min(fits, key=lambda choice: _compute_expense(choice, limit))
    if not tried:
        tried += _try_hulls(target, settings, notes)
    best = min(tried, key=lambda choice: (choice.measures.error, len(choice.pieces)))
    useful = _HELPS * best.measures.error
    notes[:] = [
        note
        for note in notes
        if (note.code != MORE_PIECES or note.data["error"] < useful)
        and (note.code != CLOSED_GAP or best.method == "cuts")
    ]
    return best


def _compute_expense(choice: Choice, allowed: float) -> float:
    """Return the mean distance [m] plus a penalty for primitives that are costly in contact."""
    kind = choice.pieces[0].kind
    rank = PRIMITIVES.index(kind) if kind in PRIMITIVES else 0
    return choice.measures.mean * (1 + _SIMPLER * rank) + _ALIKE * allowed * rank


def _is_flat(surface: Prepared) -> bool:
    """Tell whether all points are coplanar to within rounding."""
    centered = surface.vertices - surface.vertices.mean(axis=0)
    _, axes = np.linalg.eigh(centered.T @ centered)
    return float(np.ptp(centered @ axes[:, 0])) <= 1e-6 * surface.size


def _make_plate(surface: Prepared, target: ReferenceSurface) -> Choice:
    thickness = PLATE * surface.size
    vertices, faces = compute_capped_hull(thicken(surface.vertices, thickness), 64)
    pieces = [make_mesh_piece(vertices, faces)]
    text = f"The mesh is flat; its collision is its outline, {thickness * 1000:.3g} mm thick."
    return Choice("hull", pieces, measure(target, pieces), (make_note(FLAT_MESH, text),))


def _try_primitives(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Iterator[Choice]:
    """Yield the primitives with the smallest largest distance from the visual."""
    even = target.uniform_samples
    fits = fit_primitives(even)
    fits.sort(key=lambda piece: float(np.abs(measure_primitive_distance(piece, even)).max()))
    for piece in fits[:_MEASURED]:
        yield Choice("primitive", [piece], measure(target, [piece]))


def _try_hulls(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Iterator[Choice]:
    """Yield one hull: with as few vertices as the error allows, then with as many as permitted."""
    points = target.exterior_samples
    tolerances = [0.0]
    if settings.method == "auto":
        tolerances = [_SHARE * settings.max_error * target.size, 0.0]
    for tolerance in tolerances:
        vertices, faces = compute_capped_hull(points, settings.max_vertices, tolerance)
        pieces = [make_mesh_piece(vertices, faces)]
        choice = Choice("hull", pieces, measure(target, pieces))
        yield choice
        if choice.measures.error > 3 * settings.max_error:
            return


def _try_bodies(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic], cutter: PlaneCutter
) -> Iterator[Choice]:
    """Yield one hull per exterior body, if there are several but not too many.

    Bodies of several meshes are tried as primitives first, which each mesh alone could be.
    """
    bodies = _list_bodies(target, settings, cutter)
    if len(bodies) < 2:
        return
    hulls = mixed = [hull for _, hull in bodies]
    if target.surface.meshes > 1:
        limit = settings.max_error * target.size
        mixed = [_fit_primitive(corners, limit) or hull for corners, hull in bodies]
    primitives = [piece for piece in mixed if piece.is_primitive]
    if primitives:
        method = "primitive" if len(primitives) == len(mixed) else "hull"
        yield Choice(method, mixed, measure(target, mixed))
    yield Choice("hull", hulls, measure(target, hulls))


def _fit_primitive(corners: Points, limit: float) -> Piece | None:
    """Return the primitive closest to a body, given by its triangles; None beyond a limit [m]."""
    points = spread(corners, _BODY_SAMPLES).points
    found = [
        (float(np.abs(measure_primitive_distance(piece, points)).max()), number, piece)
        for number, piece in enumerate(fit_primitives(points))
    ]
    off, _, piece = min(found, key=lambda one: one[:2])
    return piece if off <= limit else None


def _list_bodies(
    target: ReferenceSurface, settings: Settings, cutter: PlaneCutter
) -> list[tuple[Points, Piece]]:
    """Return triangles [m] and hull of each exterior body; none if there are too many or too poor.

    A body may be a decal or too small to matter, and has no hull then.
    """
    surface = target.surface
    labels = label_bodies(len(surface.faces), find_edges(surface.faces))
    count = int(labels.max()) + 1
    if count < 2:
        return []
    seen = target.exterior.is_touchable(surface.vertices)
    limit = settings.max_error * target.size
    bodies: list[tuple[Points, Piece]] = []
    for label in range(count):
        used = find_used_vertices(surface.faces[labels == label], len(surface.vertices))
        if not seen[used].any():
            continue
        points = surface.vertices[used]
        if float(np.linalg.norm(np.ptp(points, axis=0))) < _SHARE * limit:
            continue
        if len(bodies) == settings.most:
            return []
        part = cutter.partition.make_whole(points, np.zeros((0, 3), np.int64))
        if part is None:  # a decal, or an isolated face
            continue
        if part.cost > _HULL_WITHIN * limit:
            return []
        vertices, faces = compute_capped_hull(points, settings.max_vertices, _SHARE * limit)
        bodies.append((surface.corners[labels == label], make_mesh_piece(vertices, faces)))
    return bodies


def _try_sheets(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Iterator[Choice]:
    """Yield one plate per flat side of an open mesh, if there are not too many."""
    surface = target.surface
    if surface.closed:
        return
    labels = label_flat_sides(surface)
    if int(labels.max()) + 1 > settings.most:
        return
    try:
        pieces = []
        for label in range(int(labels.max()) + 1):
            points = surface.vertices[np.unique(surface.faces[labels == label])]
            plate = thicken(points, PLATE * surface.size)
            pieces.append(make_mesh_piece(*compute_capped_hull(plate, settings.max_vertices)))
    except MeshError:  # a sliver
        return
    yield Choice("hull", pieces, measure(target, pieces))


def _try_plane_cuts(
    target: ReferenceSurface,
    settings: Settings,
    notes: list[Diagnostic],
    cutter: PlaneCutter | None = None,
) -> Iterator[Choice]:
    """Yield pieces of plane cuts: the fewest within the error, or those with the smallest error."""
    cutter = cutter or PlaneCutter(target, settings.max_vertices, settings.effort)
    found = cutter.decompose(settings.max_error, settings.most)
    if found is None:
        if settings.method != "auto":
            yield from _try_hulls(target, settings, notes)
        return
    error = found.measures.error
    if error > settings.max_error and cutter.has_closed_gap(found, settings.max_error):
        depth = 1000 * found.measures.buried
        text = f"The pieces close a gap, {depth:.3g} mm deep; more pieces do not open it."
        gap = {"depth": found.measures.buried, "width": 2 * BALL * target.size}
        notes.append(make_note(CLOSED_GAP, text, gap))
    elif error > settings.max_error:
        more = 2 * settings.most
        forecast = cutter.forecast_error(found, more, settings.max_error)
        text = f"{more} pieces would give an error of about {forecast:.1%}."
        notes.append(make_note(MORE_PIECES, text, {"pieces": more, "error": forecast}))
    yield Choice("cuts", found.pieces, found.measures)


def _try_coacd(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Iterator[Choice]:
    """Yield CoACD's result at its threshold; a coarser one if it fails, and one hull if both do."""
    cutter = Cutter(target, settings, most=settings.max_hulls)
    for threshold in (settings.threshold, settings.threshold * _COARSER):
        allowed = threshold * target.longest / 2
        try:
            made = cutter.cut(allowed, allowed)
        except DecompositionError as error:
            notes.append(
                make_note(error.code, f"{error.message}, at a threshold of {threshold:g}.")
            )
            continue
        notes += cutter.notes
        yield Choice("coacd", *made)
        return
    notes.append(make_note(HULL_INSTEAD, "One convex hull was taken instead."))
    yield from _try_hulls(target, settings, notes)


def _try_simplification(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Iterator[Choice]:
    """Yield the mesh with fewer triangles."""
    surface = target.surface
    vertices, faces = decimate(surface.vertices, surface.faces, settings.max_triangles)
    pieces = [make_mesh_piece(vertices, faces, convex=False)]
    error = compute_hull_error(target, pieces[0])
    if error > settings.max_error:
        text = f"Physics engines use the convex hull of a moving mesh; its error is {error:.2%}."
        notes.append(make_note(HULL_OF_ENGINES, text, {"error": error}))
    yield Choice("simplify", pieces, measure(target, pieces))


def _try_spheres(
    target: ReferenceSurface, settings: Settings, notes: list[Diagnostic]
) -> Iterator[Choice]:
    """Yield a number of spheres, or few that cover all and protrude by at most the error."""
    if settings.spheres is not None:
        pieces = fit_spheres(target, settings.spheres, cover=settings.cover)
    else:
        pieces = cover_with_spheres(target, settings.max_error, settings.max_hulls)
    found = measure(target, pieces)
    outside, protrusion = (1000 * x for x in (found.uncovered, found.collision_to_visual))
    text = (
        f"The spheres leave out up to {outside:.3g} mm and protrude by up to {protrusion:.3g} mm."
    )
    notes.append(make_note(SPHERES, text, {"outside": outside, "protrusion": protrusion}))
    yield Choice("spheres", pieces, found)


_METHODS: dict[str, Callable[[ReferenceSurface, Settings, list[Diagnostic]], Iterator[Choice]]] = {
    "primitive": _try_primitives,
    "hull": _try_hulls,
    "cuts": _try_plane_cuts,
    "coacd": _try_coacd,
    "spheres": _try_spheres,
    "simplify": _try_simplification,
}
