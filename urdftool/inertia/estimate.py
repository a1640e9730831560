"""Mass properties of any triangle mesh, with the method used and its reliability.

The first applicable method is used, from best to worst:

- ``exact``: every body is closed and consistently wound, so the polyhedral integrals apply.
  Inverted bodies are flipped; see ``nesting`` for nested bodies.
- ``repaired``: the same after duplicate faces are dropped, the winding is made consistent and small
  holes are closed by flat caps, if the caps are negligible or winding numbers confirm them.
- ``winding-number``: evenly spread points, classified by the generalized winding number, if holes
  are too large or bodies overlap considerably.
- ``convex-hull``: the hull of the points, if no point is inside. An upper bound, never reliable.

Bodies that share edges are one surface: where it winds around a part of space twice, its duplicate
faces are dropped, or the union is sampled. A surface that intersects itself without edges there is
integrated as it is wound, so doubly enclosed space counts twice. Detecting that would cost more
than everything else here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from ..diagnostic import Diagnostic, make_remark
from ..errors import MeshError
from ..geometry.hull import compute_convex_hull, extract_hull_surface
from ..geometry.mesh import Array, Faces, Points
from ..geometry.topology import Edges, find_collapsed, find_edges, label_bodies, weld
from ..mechanics.spatial_inertia import SpatialInertia
from .crossings import compute_crossing_numbers
from .inertia_error import InertiaError
from .nesting import Nesting, nest
from .polyhedron import Moments, compute_solid_moments
from .repair import Filling, drop_duplicates, fill_holes, orient
from .requirements import require_consistent
from .sampling import compute_sampled_moments, spread_points

ACCEPTED_ERROR = 0.02
"""Relative error of the volume up to which a result is reliable."""

ACCEPTED_OVERLAP = 0.03
"""Part of the volume that bodies may share before a sampled union replaces their exact sum. Chosen,
no source.
"""

AGREEMENT = 0.03
"""Largest difference of two independent results that confirm each other. Chosen, no source."""

LARGE_OPENING = 0.1
"""Part of the surface above which closing holes is a guess about the shape. Chosen, no source."""

_PROBED_POINTS = 4096
"""Points in the bounding box that show whether space is enclosed twice. Chosen, no source."""

_SHEET = 1e-6
"""Volume of a body, relative to its area to the power of 3/2, below which it is a sheet. Chosen, no
source.
"""


@dataclass(frozen=True, eq=False)
class Estimate:
    """Mass properties of a mesh, with their method and reliability."""

    properties: SpatialInertia
    """Mass properties in the frame of the mesh."""
    volume: float
    """Volume [m³] of the solid."""
    method: str
    """``"exact"``, ``"repaired"``, ``"winding-number"`` or ``"convex-hull"``."""
    reliable: bool
    """Whether the properties are within about 3 % of those of the intended solid."""
    error: float
    """Estimated relative error of volume, moments and products; 0 for an exact result."""
    hull_volume: float | None
    """Volume [m³] of the convex hull, for comparison; None for an exact result."""
    bodies: int
    """Number of separate surfaces of the mesh."""
    notes: tuple[Diagnostic, ...]
    """Remarks on defects and repairs."""


@dataclass(frozen=True, eq=False)
class _Solid:
    """Moments with the method, its error and notes."""

    moments: Moments
    method: str
    error: float
    reliable: bool
    notes: tuple[Diagnostic, ...]


def estimate_mass_properties(
    vertices: Points,
    faces: Faces,
    *,
    mass: float | None = None,
    density: float | None = None,
) -> Estimate:
    """Compute the mass properties of the solid that a mesh represents, closed or not.

    Args:
        vertices: Points [m], shape (n, 3); equal points are merged.
        faces: Indices into ``vertices``, shape (m, 3).
        mass: Total mass [kg]; give this or ``density``.
        density: Density of the solid [kg/m³].

    Raises:
        MeshError: The mesh encloses no volume, for example a flat plate.
        InertiaError: Mass or density is not above zero, or the result is physically inconsistent.
    """
    _check_amount(mass, density)
    points, merged, edges = weld(vertices, faces)
    kept = merged[~find_collapsed(merged)]
    if len(kept) < 4:
        raise MeshError(
            f"the mesh has {len(kept)} triangles with an area; a solid requires at least four"
        )
    # normalized to size 1, so that thresholds are independent of units
    middle, size = _choose_frame(points)
    points = (points - middle) / size
    labels = label_bodies(len(kept), edges)
    bodies = int(labels.max()) + 1
    solid = _integrate_exact(points, kept, edges, labels) or _estimate_open(points, kept)
    hull = None if solid.method == "exact" else compute_hull_moments(points).measure * size**3
    moments = Moments(
        solid.moments.measure * size**3,
        middle + size * solid.moments.centroid,
        solid.moments.second * size**5,
    )
    if mass is not None:
        properties = moments.with_mass(mass)
    else:
        assert density is not None
        properties = moments.with_density(density)
    require_consistent(properties, "the mesh")
    return Estimate(
        properties,
        float(moments.measure),
        solid.method,
        bool(solid.reliable),
        float(solid.error),
        hull,
        bodies,
        solid.notes,
    )


def _check_amount(mass: float | None, density: float | None) -> None:
    if (mass is None) == (density is None):
        raise InertiaError("a mesh requires either a mass [kg] or a density [kg/m³], not both")
    for name, given in (("mass", mass), ("density", density)):
        if given is not None and not (math.isfinite(given) and given > 0):
            raise InertiaError(f"the {name} of a mesh is {given:g}; must be above zero")


def _choose_frame(points: Points) -> tuple[Array, float]:
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    if not size > 0:
        raise MeshError(
            "all points of the mesh coincide; a solid requires an extent along X, Y and Z"
        )
    return 0.5 * (low + high), size


def _integrate_exact(
    points: Points, faces: Faces, edges: Edges, labels: npt.NDArray[np.int64] | None = None
) -> _Solid | None:
    """Integrate bodies that are all closed and consistently wound; None for others."""
    if not edges.cycle:
        return None
    if labels is None:
        labels = label_bodies(len(faces), edges)
    volumes, areas = _compute_measures(points, faces, labels)
    sheets = np.abs(volumes) < _SHEET * areas**1.5
    if sheets.all() or areas[sheets].sum() > 0.01 * areas.sum():
        return None
    notes = []
    if sheets.any():
        count = int(np.count_nonzero(sheets))
        message = f"Sheets without volume, ignored: {count}."
        notes.append(make_remark("sheets-ignored", message, count=count))
    solid = np.flatnonzero(~sheets)
    if len(solid) == 1:
        moments = compute_solid_moments(points, faces[labels == solid[0]])
        if moments.measure < 0:
            message = "The mesh is inside out; its faces were reversed."
            notes.append(make_remark("inside-out", message))
            moments = replace(moments, measure=-moments.measure, second=-moments.second)
        return _finish(points, faces[labels == solid[0]], edges, moments, notes)
    order = np.argsort(labels, kind="stable")
    runs = np.split(order, np.cumsum(np.bincount(labels))[:-1])
    corners = [points[faces[runs[body]]] for body in solid]
    nesting = nest(corners, volumes[solid])
    notes += _collect_nesting_notes(nesting)
    # −1 for inverted solids and for cavities that are not inverted
    turn = nesting.share * np.where(volumes[solid] < 0, -1, 1)
    chosen = [
        faces[runs[body]] if sign > 0 else faces[runs[body]][:, ::-1]
        for body, sign in zip(solid, turn, strict=True)
        if sign
    ]
    kept = np.concatenate(chosen)
    moments = compute_solid_moments(points, kept)
    if not nesting.overlaps:
        return _finish(points, kept, edges, moments, notes)
    return _remove_overlap(points[faces], moments, notes)


def _finish(
    points: Points, faces: Faces, edges: Edges, moments: Moments, notes: list[Diagnostic]
) -> _Solid:
    """Return exact moments, unless faces that share edges wind around some space twice."""
    shared = bool((edges.forward > 1).any())
    if not shared or not _is_covered_twice(points[faces]):
        return _Solid(moments, "exact", 0.0, True, tuple(notes))
    unique = drop_duplicates(faces)
    again = find_edges(unique) if len(unique) < len(faces) else None
    if again is None or not again.cycle:
        return _remove_overlap(points[faces], moments, notes)
    notes = [*notes, _make_duplicates_remark(len(faces) - len(unique))]
    return _finish(points, unique, again, compute_solid_moments(points, unique), notes)


def _is_covered_twice(corners: Array) -> bool:
    """Tell whether a closed surface winds around one of some points more than once."""
    ends = corners.reshape(-1, 3)
    points = spread_points(_PROBED_POINTS, ends.min(axis=0), ends.max(axis=0))
    return bool((np.abs(compute_crossing_numbers(points, corners)) > 1.5).any())


def _make_duplicates_remark(count: int) -> Diagnostic:
    message = f"Duplicate faces, ignored: {count}."
    return make_remark("duplicate-faces", message, count=count)


def _compute_measures(
    points: Points, faces: Faces, labels: npt.NDArray[np.int64]
) -> tuple[Array, Array]:
    """Compute signed volume and area of each body."""
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    triple = np.einsum("ij,ij->i", corners[:, 0], normals)
    areas = np.linalg.norm(normals, axis=1) / 2
    volume: Array = np.bincount(labels, weights=triple).astype(np.float64) / 6
    area: Array = np.bincount(labels, weights=areas).astype(np.float64)
    return volume, area


def _collect_nesting_notes(nesting: Nesting) -> list[Diagnostic]:
    notes = []
    if nesting.turned:
        message = f"Bodies that are inside out, reversed: {nesting.turned}."
        notes.append(make_remark("bodies-inside-out", message, count=nesting.turned))
    if nesting.cavities:
        message = f"Bodies that are cavities, subtracted: {nesting.cavities}."
        notes.append(make_remark("cavities", message, count=nesting.cavities))
    if nesting.swallowed:
        message = f"Bodies inside another solid, ignored: {nesting.swallowed}."
        notes.append(make_remark("nested-bodies", message, count=nesting.swallowed))
    return notes


def _remove_overlap(corners: Array, summed: Moments, notes: list[Diagnostic]) -> _Solid:
    """Sample the union of overlapping bodies, or return their sum if it hardly differs."""
    halves = compute_sampled_moments(corners)
    if halves is None:
        remark = make_remark("bodies-overlap", "Bodies overlap by an unknown amount.")
        return _Solid(summed, "exact", 1.0, False, (*notes, remark))
    union, noise = _average(*halves)
    share = summed.measure / union.measure - 1
    if abs(share) <= ACCEPTED_OVERLAP:
        message = (
            f"Bodies overlap; the {abs(share):.1%} of the volume that they share is counted twice."
        )
        notes.append(make_remark("bodies-overlap", message, share=share, counted=2))
        return _Solid(summed, "exact", max(abs(share), noise), True, tuple(notes))
    message = (
        f"Bodies overlap; shared volume is counted once, which subtracts {share:.1%} "
        "off the sum of their volumes."
    )
    notes.append(make_remark("bodies-overlap", message, share=share, counted=1))
    return _Solid(union, "winding-number", noise, noise <= ACCEPTED_ERROR, tuple(notes))


def _average(first: Moments, second: Moments) -> tuple[Moments, float]:
    """Average two independent results, and return their relative difference.

    The difference is the largest of those of the volume, of the second moments and products, and
    of the centroid relative to the radius of gyration.
    """
    volume = 0.5 * (first.measure + second.measure)
    moment = 0.5 * (first.second + second.second)
    radius = math.sqrt(max(float(np.trace(moment)) / volume, 1e-300))
    differences = [
        abs(first.measure - second.measure) / volume,
        float(np.abs(first.second - second.second).max() / np.diag(moment).max()),
        float(np.linalg.norm(first.centroid - second.centroid)) / radius,
    ]
    mean = Moments(volume, 0.5 * (first.centroid + second.centroid), moment)
    return mean, max(differences)


def _estimate_open(points: Points, faces: Faces) -> _Solid:
    """Estimate a mesh that is not closed: by repair, samples or its convex hull."""
    notes: list[Diagnostic] = []
    unique = drop_duplicates(faces)
    if len(unique) < len(faces):
        notes.append(_make_duplicates_remark(len(faces) - len(unique)))
    wound, turned = orient(points, unique)
    if turned:
        message = f"Faces reversed to agree with their neighbors: {turned}."
        notes.append(make_remark("faces-reversed", message, count=int(turned)))
    filling = fill_holes(points, wound)
    filled = _integrate_exact(filling.vertices, filling.faces, find_edges(filling.faces))
    opening = (
        filling.area / _compute_measures(points, wound, np.zeros(len(wound), dtype=np.int64))[1][0]
    )
    if filling.holes:
        message = f"Holes closed: {filling.holes}, {opening:.1%} of the surface."
        data = {"count": filling.holes, "share": float(opening)}
        notes.append(make_remark("holes-closed", message, **data))
    if filled is not None:
        error = max(filled.error, filling.volume_error / filled.moments.measure)
        if error <= ACCEPTED_ERROR:
            method = "repaired" if filled.method == "exact" else filled.method
            return _Solid(filled.moments, method, error, filled.reliable, (*notes, *filled.notes))
    caps = filling.vertices[filling.faces[len(wound) :]]
    found = _sample_solid(points[wound], caps, filled, filling, opening, notes)
    return found or _estimate_by_hull(points, notes)


def _sample_solid(
    corners: Array,
    caps: Array,
    filled: _Solid | None,
    filling: Filling,
    opening: float,
    notes: list[Diagnostic],
) -> _Solid | None:
    halves = compute_sampled_moments(corners, caps=caps)
    if halves is None:
        return None
    moments, noise = _average(*halves)
    error = noise
    if filled is not None:
        difference = _average(filled.moments, moments)[1]
        message = f"Flat caps and winding numbers differ by {difference:.1%}."
        notes.append(make_remark("methods-differ", message, difference=difference))
        missed = filling.volume_error / filled.moments.measure
        if max(difference, missed) <= AGREEMENT and opening <= LARGE_OPENING:
            # caps have no sampling noise, and sampling does not depend on caps
            return _Solid(filled.moments, "repaired", difference, True, tuple(notes))
        error = max(noise, difference)
    else:
        error = max(noise, filling.volume_error / moments.measure)
    if opening > LARGE_OPENING:
        message = "Much of the surface is missing; the closed mesh is a rough estimate."
        notes.append(make_remark("large-opening", message, share=float(opening)))
    reliable = error <= ACCEPTED_ERROR and opening <= LARGE_OPENING
    return _Solid(moments, "winding-number", error, reliable, tuple(notes))


def _estimate_by_hull(points: Points, notes: list[Diagnostic]) -> _Solid:
    message = "The surface encloses no volume; its convex hull is used."
    notes.append(make_remark("no-volume", message))
    return _Solid(compute_hull_moments(points), "convex-hull", 1.0, False, tuple(notes))


MAX_QHULL = 20_000
"""Number of points from which Manifold computes the hull: the time of Qhull grows with the square
of the corners of a flat side, for 30,000 to minutes."""


def compute_hull_moments(points: Points) -> Moments:
    """Compute the moments of the convex hull of points [m], shape (n, 3).

    Raises:
        MeshError: The points lie in a plane.
    """
    from scipy.spatial import ConvexHull, QhullError

    if len(points) > MAX_QHULL:
        simpler = compute_convex_hull(points)
        if simpler is not None:
            return compute_solid_moments(*extract_hull_surface(simpler))
    try:
        hull = ConvexHull(points)
    except QhullError as error:
        raise MeshError(
            "the mesh is flat and encloses no volume; for a plate or sheet use a shell"
        ) from error
    faces = hull.simplices.astype(np.int64)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return compute_solid_moments(points, faces)
