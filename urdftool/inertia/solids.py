"""Mass properties of simple solids in closed form, and of their hollow versions.

Every function takes either ``mass`` [kg] or ``density`` [kg/m³] and returns ``SpatialInertia`` in
the frame that URDF and SDF give the shape: origin at its center, axis of revolution along z. Only a
cone's center of mass is not at that origin. Every function raises ``InertiaError`` if a size is not
a finite number above zero, if not exactly one of mass and density is given, or if that is not above
zero.

The formulas are from textbooks (Goldstein, "Classical Mechanics"; Meriam and Kraige, "Dynamics",
table D/4). Differences of nearly equal powers, as for thin walls, are factored first, so that
results are exact to rounding for walls of any thickness.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import make_diagonal_tensor
from ..model.elements import ZERO, Vector
from .inertia_error import InertiaError


def box(
    size: Sequence[float], *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Compute a solid box of edges ``size`` [m] along x, y, z: ixx = m (y² + z²) / 12."""
    x, y, z = _get_sizes("box", size=size)
    m = _compute_mass("box", x * y * z, mass, density)
    return _make_body(
        m, m * (y * y + z * z) / 12, m * (x * x + z * z) / 12, m * (x * x + y * y) / 12
    )


def cylinder(
    radius: float, length: float, *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Compute a solid cylinder of ``radius`` and ``length`` [m] along z: izz = m r² / 2."""
    r, h = _get_sizes("cylinder", radius=radius, length=length)
    m = _compute_mass("cylinder", math.pi * r * r * h, mass, density)
    across = m * (3 * r * r + h * h) / 12
    return _make_body(m, across, across, m * r * r / 2)


def sphere(
    radius: float, *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Compute a solid sphere of ``radius`` [m]: i = 2 m r² / 5."""
    (r,) = _get_sizes("sphere", radius=radius)
    m = _compute_mass("sphere", 4 / 3 * math.pi * r**3, mass, density)
    moment = 2 * m * r * r / 5
    return _make_body(m, moment, moment, moment)


def capsule(
    radius: float, length: float, *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Compute a solid capsule along z: a cylinder between half spheres of ``radius`` [m].

    ``length`` [m] is that of the cylinder, as in URDF 1.1, SDF and MuJoCo; the total length is
    length + 2 r. A half sphere has ixx = 83 m r² / 320 about its center of mass, 3r/8 from the flat
    face. Shifted to both ends this gives m (2r²/5 + h²/4 + 3hr/8) for the pair.
    """
    r, h = _get_sizes("capsule", radius=radius, length=length)
    # volumes of the cylinder and the pair of half spheres, divided by π r²
    shares = (h, 4 * r / 3)
    m = _compute_mass("capsule", math.pi * r * r * sum(shares), mass, density)
    m_cylinder, m_ends = (m * share / sum(shares) for share in shares)
    across = m_cylinder * (3 * r * r + h * h) / 12
    across += m_ends * (2 * r * r / 5 + h * h / 4 + 3 * h * r / 8)
    return _make_body(m, across, across, m_cylinder * r * r / 2 + m_ends * 2 * r * r / 5)


def ellipsoid(
    radii: Sequence[float], *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Compute a solid ellipsoid of half axes ``radii`` [m] along x, y, z: ixx = m (b² + c²) / 5."""
    a, b, c = _get_sizes("ellipsoid", radii=radii)
    m = _compute_mass("ellipsoid", 4 / 3 * math.pi * a * b * c, mass, density)
    return _make_body(m, m * (b * b + c * c) / 5, m * (a * a + c * c) / 5, m * (a * a + b * b) / 5)


def cone(
    radius: float, length: float, *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Compute a solid cone along z, tip at +length/2, base of ``radius`` [m] at −length/2.

    This is SDF's frame: the origin is half way up. The center of mass is at z = −length/4, a
    quarter of the length above the base. About it, ixx = 3 m (4 r² + h²) / 80 and izz = 3 m r² /
    10.
    """
    r, h = _get_sizes("cone", radius=radius, length=length)
    m = _compute_mass("cone", math.pi * r * r * h / 3, mass, density)
    across = 3 * m * (4 * r * r + h * h) / 80
    return _make_body(m, across, across, 3 * m * r * r / 10, com=(0.0, 0.0, -h / 4))


def hollow_box(
    size: Sequence[float],
    thickness: float,
    *,
    mass: float | None = None,
    density: float | None = None,
) -> SpatialInertia:
    """Compute a closed box of outer edges ``size`` [m] with walls of ``thickness`` [m].

    The outer box minus the inner one: ∫x² dV = (a³bc − a'³b'c') / 12, with a' = a − 2t.

    Raises:
        InertiaError: Also if the wall is thicker than half the shortest edge.
    """
    outer = _get_sizes("hollow box", size=size)
    t = _compute_wall("hollow box", thickness, min(outer) / 2, "half the shortest edge")
    inner = tuple(edge - 2 * t for edge in outer)
    volume = _compute_product_difference(outer, inner, t)
    # ∫x² dV and so on, each with the edge of its own axis cubed
    squares = [
        _compute_cubed_difference(
            (outer[i], *_get_others(outer, i)), (inner[i], *_get_others(inner, i)), t
        )
        / 12
        for i in range(3)
    ]
    m = _compute_mass("hollow box", volume, mass, density)
    x, y, z = (m * square / volume for square in squares)
    return _make_body(m, y + z, x + z, x + y)


def hollow_cylinder(
    radius: float,
    length: float,
    thickness: float,
    *,
    closed: bool = False,
    mass: float | None = None,
    density: float | None = None,
) -> SpatialInertia:
    """Compute a tube of outer ``radius``, ``length`` and wall ``thickness`` [m] along z.

    It is open at both ends, or ``closed`` by end plates of the same thickness within the length.
    The open one has izz = m (r² + s²) / 2 with s = r − t.

    Raises:
        InertiaError: Also if the wall is thicker than the radius, or if closed, half the length.
    """
    r, h = _get_sizes("hollow cylinder", radius=radius, length=length)
    limit = min(r, h / 2) if closed else r
    t = _compute_wall(
        "hollow cylinder", thickness, limit, "the radius" if limit == r else "half the length"
    )
    s = r - t
    tube = h - 2 * t if closed else h
    plates = 2 * t if closed else 0.0
    # volumes divided by π
    v_tube, v_plates = t * (r + s) * tube, r * r * plates
    m = _compute_mass("hollow cylinder", math.pi * (v_tube + v_plates), mass, density)
    m_tube, m_plates = (m * volume / (v_tube + v_plates) for volume in (v_tube, v_plates))
    along = m_tube * (r * r + s * s) / 2 + m_plates * r * r / 2
    across = m_tube * (3 * (r * r + s * s) + tube * tube) / 12
    if closed:
        across += m_plates * ((3 * r * r + t * t) / 12 + ((h - t) / 2) ** 2)
    return _make_body(m, across, across, along)


def hollow_sphere(
    radius: float,
    thickness: float,
    *,
    mass: float | None = None,
    density: float | None = None,
) -> SpatialInertia:
    """Compute a hollow sphere of outer ``radius`` [m] with a wall of ``thickness`` [m].

    i = 2/5 m (r⁵ − s⁵) / (r³ − s³) with s = r − t, both divided by r − s.

    Raises:
        InertiaError: Also if the wall is thicker than the radius.
    """
    (r,) = _get_sizes("hollow sphere", radius=radius)
    t = _compute_wall("hollow sphere", thickness, r, "the radius")
    s = r - t
    cubes = r * r + r * s + s * s
    m = _compute_mass("hollow sphere", 4 / 3 * math.pi * t * cubes, mass, density)
    moment = 2 / 5 * m * (r**4 + r**3 * s + r * r * s * s + r * s**3 + s**4) / cubes
    return _make_body(m, moment, moment, moment)


def _get_others(edges: Sequence[float], axis: int) -> tuple[float, float]:
    return edges[(axis + 1) % 3], edges[(axis + 2) % 3]


def _compute_product_difference(outer: Sequence[float], inner: Sequence[float], t: float) -> float:
    """Compute abc − a'b'c' as a sum of positive terms, for edges that differ by 2t each."""
    _, b, c = outer
    ai, bi, _ = inner
    return 2 * t * (b * c + ai * c + ai * bi)


def _compute_cubed_difference(outer: Sequence[float], inner: Sequence[float], t: float) -> float:
    """Compute a³bc − a'³b'c' as a sum of positive terms, for edges that differ by 2t each."""
    a, b, c = outer
    ai, bi, _ = inner
    return 2 * t * ((a * a + a * ai + ai * ai) * b * c + ai**3 * (c + bi))


def _make_body(
    mass: float, ixx: float, iyy: float, izz: float, com: Vector = ZERO
) -> SpatialInertia:
    return SpatialInertia(mass, com, make_diagonal_tensor(ixx, iyy, izz))


def _get_sizes(shape: str, **named: float | Sequence[float]) -> tuple[float, ...]:
    """Return the sizes as floats.

    Raises:
        InertiaError: One is not a finite number above zero, or ``size`` or ``radii`` is not three
            numbers.
    """
    sizes: list[float] = []
    for name, given in named.items():
        values = [float(v) for v in given] if isinstance(given, Iterable) else [given]
        if name in ("size", "radii") and len(values) != 3:
            raise InertiaError(
                f"a {shape} has a {name} of 3 numbers [m], along X, Y and Z; got {len(values)}"
            )
        for value in values:
            if not (math.isfinite(value) and value > 0):
                raise InertiaError(
                    f"the {name} of a {shape} is {value:g} m; must be a finite length above zero"
                )
        sizes.extend(float(value) for value in values)
    return tuple(sizes)


def _compute_wall(shape: str, thickness: float, limit: float, limit_name: str) -> float:
    (t,) = _get_sizes(shape, thickness=thickness)
    if t > limit:
        raise InertiaError(
            f"the wall of a {shape} is {t:g} m thick; at most {limit_name}, {limit:g} m, fits"
        )
    return t


def _compute_mass(shape: str, volume: float, mass: float | None, density: float | None) -> float:
    if (mass is None) == (density is None):
        raise InertiaError(f"a {shape} requires either a mass [kg] or a density [kg/m³], not both")
    name, given = ("mass", mass) if mass is not None else ("density", density)
    assert given is not None
    if not (math.isfinite(given) and given > 0):
        raise InertiaError(f"the {name} of a {shape} is {given:g}; must be above zero")
    return float(given) if mass is not None else float(given) * volume
