"""Covers by spheres: every exterior point is inside one, and none protrudes by more than asked."""

import json
from pathlib import Path

import numpy as np
import pytest
import yaml

import urdftool
from tests.collision.independent import sampled
from tests.collision.shapes import finer, l_profile, noisy
from urdftool.collision.choose import choose
from urdftool.collision.settings import COVERING, Settings
from urdftool.collision.surface import prepare


def shapes():
    outer, faces = noisy("box", (0.3, 0.2, 0.1))
    inner, more = noisy("sphere", (0.03,))
    yield prepare(*finer(*l_profile())), None
    yield prepare(outer, faces), None
    yield prepare(np.concatenate([outer, inner]), np.concatenate([faces, more + len(outer)])), faces


@pytest.mark.parametrize(
    ("number", "excess", "most"),
    [
        (0, 0.1, None),
        pytest.param(0, 0.01, 8, marks=pytest.mark.slow),
        *(pytest.param(n, 0.05, None, marks=pytest.mark.slow) for n in range(3)),
    ],
)
def test_all_of_the_exterior_is_covered(number, excess, most):
    surface, exterior = list(shapes())[number]
    choice = choose(surface, Settings(method="spheres", max_error=excess, max_hulls=most))
    assert {piece.kind for piece in choice.pieces} == {"sphere"}
    faces = surface.faces if exterior is None else exterior
    points, ends = sampled(surface.vertices[faces], 100_000, 5)
    points = np.concatenate([points, ends])
    off = [np.linalg.norm(points - piece.center, axis=1) - piece.size[0] for piece in choice.pieces]
    assert np.min(off, axis=0).max() <= 0
    if most is None:
        assert choice.measures.collision_to_visual <= (excess + 0.002) * surface.size
    else:
        assert len(choice.pieces) <= most


def measure_outside(choice, points):
    """The largest distance of points outside of all spheres; negative inside."""
    off = [np.linalg.norm(points - piece.center, axis=1) - piece.size[0] for piece in choice.pieces]
    return float(np.min(off, axis=0).max())


@pytest.mark.slow
@pytest.mark.parametrize("count", [3, 8])
def test_a_number_of_spheres_covers_or_shares_the_error(count):
    outer, faces = noisy("box", (0.4, 0.1, 0.1))
    surface = prepare(outer, faces)
    points, ends = sampled(outer[faces], 50_000, 5)
    points = np.concatenate([points, ends])
    cover, shared, greedy = (
        choose(surface, Settings(method="spheres", **chosen))
        for chosen in ({"count": count, "cover": True}, {"count": count}, {"max_hulls": count})
    )
    assert len(cover.pieces) <= count
    assert len(shared.pieces) <= count
    assert measure_outside(cover, points) <= 0
    size, excess = surface.size, cover.measures.collision_to_visual
    assert excess <= greedy.measures.collision_to_visual * 1.02
    outside = measure_outside(shared, points)
    assert 0 < outside <= excess / 2 + 0.002 * size
    assert shared.measures.collision_to_visual == pytest.approx(excess / 2, abs=0.004 * size)
    assert shared.notes[-1].data["outside"] == pytest.approx(1000 * outside, rel=0.1)


@pytest.mark.parametrize(
    ("options", "count"),
    [
        ({}, None),
        ({"cover": True}, COVERING),
        ({"cover": True, "count": 3}, 3),
        ({"cover": True, "max_hulls": 4}, None),
    ],
)
def test_a_cover_without_a_number_has_that_of_planners(options, count):
    assert Settings(method="spheres", **options).spheres == count


def test_one_sphere_around_a_cube():
    """One sphere around a cube has its circumscribed radius."""
    outer, faces = noisy("box", (0.1, 0.1, 0.1))
    (sphere,) = choose(
        prepare(outer, faces), Settings(method="spheres", count=1, cover=True)
    ).pieces
    radius = 0.05 * np.sqrt(3)
    assert sphere.size[0] == pytest.approx(radius, rel=0.05)
    assert sphere.center == pytest.approx(outer.mean(axis=0), abs=0.03 * radius)


def test_the_spheres_of_a_link_are_divided_by_size(write):
    from tests.commands.test_collision import stl
    from urdftool.collision.links import CollisionOptions, plan

    write("large.stl", stl(*noisy("box", (0.3, 0.1, 0.1))))
    write("small.stl", stl(*noisy("box", (0.06, 0.04, 0.04))))
    shapes = "".join(
        f'<visual><geometry><mesh filename="{name}.stl"/></geometry></visual>'
        for name in ("small", "large")
    )
    path = write("r.urdf", f'<robot name="r"><link name="a">{shapes}</link></robot>')
    for count, shares in ((5, [1, 4]), (7, [2, 5]), (1, [1, 1])):
        settings = Settings(method="spheres", count=count)
        ((made,), _) = plan(urdftool.load(path), CollisionOptions(settings))
        assert [use.task.settings.count for use in made.uses] == shares


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--count", "4"), "--count requires --method spheres"),
        (("--cover",), "--cover requires --method spheres"),
        (("--method", "spheres", "--count", "4", "--max-hulls", "4"), "exclude each other"),
        (("--method", "spheres", "--count", "0"), "x>=1"),
    ],
)
def test_numbers_of_spheres_that_are_not_possible(command, write, options, message):
    done = command("collision", write("r.urdf", MESH), "-o", "out.urdf", *options)
    assert done.code == 2
    assert message in done.err


@pytest.fixture
def command(urdftool):
    return urdftool


@pytest.mark.slow
def test_more_excess_takes_fewer_spheres():
    surface = prepare(*finer(*l_profile()))
    counts = [
        len(choose(surface, Settings(method="spheres", max_error=e)).pieces) for e in (0.03, 0.1)
    ]
    assert counts[0] > 2 * counts[1]


MESH = """<robot name="r"><link name="arm"><visual><origin xyz="1 0 0" rpy="0 0 1.5707963"/>
<geometry><mesh filename="box.stl"/></geometry></visual></link></robot>"""


@pytest.mark.slow
def test_planners_get_spheres_in_the_frame_of_the_link(urdftool, write):
    from tests.commands.test_collision import stl

    write("box.stl", stl(*noisy("box", (0.3, 0.1, 0.1))))
    robot = write("r.urdf", MESH)
    tables = []
    for name in ("spheres.yml", "spheres.json"):
        done = urdftool(
            "collision", robot, "-o", "out.urdf", "--method", "spheres", "--max-hulls", "5",
            "--spheres-file", name, "--no-cache",
        )  # fmt: skip
        assert done.code == 0, done.err
        tables.append((Path(robot).parent / name).read_text())
    curobo = yaml.safe_load(tables[0])["collision_spheres"]["arm"]
    pyroki = json.loads(tables[1])["arm"]
    assert [sphere["center"] for sphere in curobo] == pyroki["centers"]
    assert [sphere["radius"] for sphere in curobo] == pyroki["radii"]
    assert 2 <= len(curobo) <= 5
    text = (Path(robot).parent / "out.urdf").read_text()
    assert text.count("<sphere radius=") == len(curobo)
    centers = np.array(pyroki["centers"])
    assert np.ptp(centers[:, 1]) > 0.1  # the box is along y now
    assert centers[:, 0] == pytest.approx(1, abs=0.03)


def test_a_file_of_spheres_requires_the_method(urdftool, write):
    robot = write("r.urdf", MESH)
    done = urdftool("collision", robot, "-o", "out.urdf", "--spheres-file", "s.yml")
    assert (done.code, "requires --method spheres" in done.err) == (2, True)
    done = urdftool(
        "collision", robot, "-o", "o.urdf", "--method", "spheres", "--spheres-file", "s.txt"
    )
    assert (done.code, "does not end in" in done.err) == (2, True)
