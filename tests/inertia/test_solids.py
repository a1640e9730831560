"""Closed forms against exact fractions, and against integration where they are derived."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.inertia import solids
from urdftool.inertia.inertia_error import InertiaError
from urdftool.inertia.requirements import is_consistent

lengths = st.floats(1e-4, 1e3)


def exact(value):
    return Fraction(value)


def diagonal(properties):
    assert not np.any(properties.inertia - np.diag(np.diag(properties.inertia)))
    return np.diag(properties.inertia)


def test_the_cylinder_of_the_manual():
    body = solids.cylinder(0.06, 0.09, mass=0.18)
    np.testing.assert_allclose(diagonal(body), [0.0002835, 0.0002835, 0.000324], rtol=1e-12)


def test_the_flat_box():
    body = solids.box((1, 1, 0.5), mass=1024)
    expected = [1024 * 1.25 / 12, 1024 * 1.25 / 12, 1024 * 2 / 12]
    np.testing.assert_allclose(diagonal(body), expected, rtol=1e-12)
    assert [round(value, 3) for value in diagonal(body)] == [106.667, 106.667, 170.667]


@given(lengths, lengths, lengths, st.floats(1e-3, 1e3))
def test_box_and_ellipsoid(x, y, z, mass):
    fx, fy, fz, fm = map(exact, (x, y, z, mass))
    squares = (fy**2 + fz**2, fx**2 + fz**2, fx**2 + fy**2)
    for body, divisor in ((solids.box, 12), (solids.ellipsoid, 5)):
        wanted = [float(fm * s / divisor) for s in squares]
        np.testing.assert_allclose(diagonal(body((x, y, z), mass=mass)), wanted, rtol=1e-12)
    assert solids.box((x, y, z), density=2.0).mass == pytest.approx(float(2 * fx * fy * fz), 1e-12)


@given(lengths, lengths)
def test_cylinder_sphere_cone_capsule(r, h):
    fr, fh = exact(r), exact(h)
    across = (3 * fr**2 + fh**2) / 12
    body = solids.cylinder(r, h, mass=1.0)
    np.testing.assert_allclose(
        diagonal(body), [float(across), float(across), float(fr**2 / 2)], rtol=1e-12
    )
    np.testing.assert_allclose(
        diagonal(solids.sphere(r, mass=1.0)), [float(2 * fr**2 / 5)] * 3, rtol=1e-12
    )
    cone = solids.cone(r, h, mass=1.0)
    across = Fraction(3, 80) * (4 * fr**2 + fh**2)
    np.testing.assert_allclose(
        diagonal(cone), [float(across), float(across), float(3 * fr**2 / 10)], rtol=1e-12
    )
    assert cone.com[2] == pytest.approx(-h / 4)
    # half spheres by the parallel axis: 83/320 m r² about a point 3r/8 from the flat face
    ends, middle = Fraction(4, 3) * fr / (Fraction(4, 3) * fr + fh), fh / (Fraction(4, 3) * fr + fh)
    arm = fh / 2 + 3 * fr / 8
    across = ends * (Fraction(83, 320) * fr**2 + arm**2) + middle * (3 * fr**2 + fh**2) / 12
    along = ends * 2 * fr**2 / 5 + middle * fr**2 / 2
    np.testing.assert_allclose(
        diagonal(solids.capsule(r, h, mass=1.0)),
        [float(across), float(across), float(along)],
        rtol=1e-12,
    )


@given(lengths, lengths, lengths, st.floats(1e-9, 0.5))
def test_hollow_box_is_the_outer_less_the_inner(x, y, z, share):
    wall = share * min(x, y, z)
    outer = [exact(edge) for edge in (x, y, z)]
    inner = [edge - 2 * exact(wall) for edge in outer]
    volume = math.prod(outer) - math.prod(inner)
    squares = [
        (math.prod(outer) * o**2 - math.prod(inner) * i**2) / 12
        for o, i in zip(outer, inner, strict=True)
    ]
    wanted = [float((sum(squares) - s) / volume) for s in squares]
    body = solids.hollow_box((x, y, z), wall, mass=1.0)
    np.testing.assert_allclose(diagonal(body), wanted, rtol=1e-12)
    assert solids.hollow_box((x, y, z), wall, density=1.0).mass == pytest.approx(
        float(volume), rel=1e-12
    )


@given(lengths, lengths, st.floats(1e-9, 0.5), st.booleans())
def test_hollow_cylinder_is_the_outer_less_the_inner(r, h, share, closed):
    wall = share * min(r, h)
    fr, fh, ft = exact(r), exact(h), exact(wall)
    inner_r, inner_h = fr - ft, fh - 2 * ft if closed else fh
    volume = fr**2 * fh - inner_r**2 * inner_h
    along = (fr**4 * fh - inner_r**4 * inner_h) / 2
    across = (
        fr**2 * fh * (3 * fr**2 + fh**2) - inner_r**2 * inner_h * (3 * inner_r**2 + inner_h**2)
    ) / 12
    body = solids.hollow_cylinder(r, h, wall, closed=closed, mass=1.0)
    wanted = [float(across / volume), float(across / volume), float(along / volume)]
    np.testing.assert_allclose(diagonal(body), wanted, rtol=1e-12)
    assert solids.hollow_cylinder(r, h, wall, closed=closed, density=1.0).mass == pytest.approx(
        math.pi * float(volume), rel=1e-12
    )


@given(lengths, st.floats(1e-9, 1.0))
def test_hollow_sphere_is_the_outer_less_the_inner(r, share):
    wall = share * r
    fr = exact(r)
    inner = fr - exact(wall)
    wanted = float(Fraction(2, 5) * (fr**5 - inner**5) / (fr**3 - inner**3))
    body = solids.hollow_sphere(r, wall, mass=1.0)
    np.testing.assert_allclose(diagonal(body), [wanted] * 3, rtol=1e-12)


@given(lengths, lengths, lengths)
def test_all_are_possible(a, b, c):
    bodies = [
        solids.box((a, b, c), mass=1),
        solids.cylinder(a, b, mass=1),
        solids.capsule(a, b, mass=1),
        solids.cone(a, b, mass=1),
        solids.hollow_cylinder(a, b, a / 3, mass=1),
    ]
    assert all(is_consistent(body) for body in bodies)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: solids.box((1, 0, 1), mass=1), "size of a box is 0 m"),
        (lambda: solids.box((1, 1), mass=1), "3 numbers"),
        (lambda: solids.sphere(-1, mass=1), "above zero"),
        (lambda: solids.sphere(float("nan"), mass=1), "nan"),
        (lambda: solids.sphere(1, mass=0), "mass of a sphere is 0"),
        (lambda: solids.sphere(1, density=float("inf")), "density"),
        (lambda: solids.sphere(1), "either a mass"),
        (lambda: solids.sphere(1, mass=1, density=1), "not both"),
        (lambda: solids.hollow_sphere(1, 2, mass=1), "at most the radius, 1 m"),
        (
            lambda: solids.hollow_box((1, 2, 3), 0.6, mass=1),
            "half the shortest edge, 0.5 m",
        ),
        (
            lambda: solids.hollow_cylinder(1, 0.1, 0.2, closed=True, mass=1),
            "half the length",
        ),
    ],
)
def test_bad_sizes(call, words):
    with pytest.raises(InertiaError, match=words):
        call()
    with pytest.raises(ValueError):
        call()
