"""What fills a cup is told apart from what sticks out, or is cut short."""

import json
import re

import jsonschema
import numpy as np
import pytest

from tests.collision.shapes import l_profile, noisy, stl
from tests.conftest import ROOT
from urdftool.collision.convex import hull
from urdftool.collision.hollow import filled_hollow
from urdftool.collision.measure import Target, measure
from urdftool.collision.piece import mesh_piece
from urdftool.collision.surface import prepare
from urdftool.collision.tessellate import primitive

RADIUS, DEPTH, SIDES = 0.1, 0.2, 48
CELL = 0.01  # of the longest side, which is shorter than the diagonal


def ring(radius, z):
    turn = np.arange(SIDES) / SIDES * 2 * np.pi
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(SIDES, z)], axis=1)


def lathe(*profile):
    """The surface of some circles one after another, each a radius and a height; 0 is a point."""
    points = np.concatenate([ring(*circle) for circle in profile])
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    faces = []
    for n in range(len(profile) - 1):
        a, b = n * SIDES, (n + 1) * SIDES
        faces += [np.stack([a + i, a + j, b + j], 1), np.stack([a + i, b + j, b + i], 1)]
    return points, np.concatenate(faces)


SHEET = lathe((1e-9, 0), (RADIUS, 0), (RADIUS, DEPTH))
THICK = lathe(
    (1e-9, 0), (RADIUS, 0), (RADIUS, DEPTH), (0.09, DEPTH), (0.09, 0.01), (1e-9, 0.01)
)  # fmt: skip


def filled(mesh, pieces, limit=0.01):
    target = Target(prepare(*mesh))
    return measure(target, pieces).error, filled_hollow(target, pieces, limit)


def hull_of(mesh):
    return mesh_piece(*hull(mesh[0]))


@pytest.mark.parametrize(("mesh", "inner"), [(SHEET, DEPTH), (THICK, DEPTH - 0.01)])
def test_what_fills_a_cup_is_all_of_its_error(mesh, inner):
    error, hollow = filled(mesh, [hull_of(mesh)])
    size = float(np.linalg.norm((2 * RADIUS, 2 * RADIUS, DEPTH)))
    assert error == pytest.approx(RADIUS / size, rel=0.15)  # from the middle of the mouth
    assert hollow.depth == pytest.approx(inner, rel=0.03)
    assert hollow.error < CELL


def test_both_ends_of_a_pipe_are_mouths():
    pipe = lathe((RADIUS, 0), (RADIUS, 0.6))
    _, hollow = filled(pipe, [hull_of(pipe)])
    assert hollow.depth == pytest.approx(0.3, rel=0.03)
    assert hollow.error < CELL


def test_what_sticks_out_of_a_cup_is_told_beside():
    off = 0.03
    foot = primitive("cylinder", (RADIUS, 0.02), np.eye(3), (0, 0, 0.01 - off))
    error, hollow = filled(SHEET, [hull_of(SHEET), foot])
    assert hollow.error * Target(prepare(*SHEET)).size == pytest.approx(off, rel=0.1)
    assert hollow.error < error / 2


def test_where_more_is_wrong_than_the_hollow_it_is_no_reason():
    lid = primitive("cylinder", (RADIUS, 0.02), np.eye(3), (0, 0, -0.1))
    error, hollow = filled(SHEET, [hull_of(SHEET), lid])
    assert error > 0.25
    assert hollow is None


@pytest.mark.parametrize(
    ("mesh", "piece"),
    [
        (l_profile(), None),  # a corner that is cut short
        (noisy("cylinder", (0.05, 0.2)), primitive("box", (0.1, 0.1, 0.2), np.eye(3), (0, 0, 0))),
        (noisy("box", (0.2, 0.2, 0.2)), primitive("sphere", (0.17,), np.eye(3), (0, 0, 0))),
        (lathe((1e-9, 0), (0.1, 0), (0.12, 0.03)), None),  # a plate: its mouth is as large
    ],
)
def test_a_corner_and_a_bulge_are_no_hollow(mesh, piece):
    error, hollow = filled(mesh, [piece or hull_of(mesh)])
    assert error > 0.02
    assert hollow is None


@pytest.mark.slow
def test_it_is_said_and_told_as_json(urdftool, write):
    mesh = write("cup.stl", stl(*SHEET))
    words = ("collision", "mesh", mesh, "--method", "hull", "--no-cache")
    done = urdftool(*words)
    assert "beside hollow" in done.out.splitlines()[0]
    (line,) = done.err.splitlines()
    assert "fills a hollow that is open to the outside (up to 200 mm deep)" in line
    assert line.endswith(
        "take --method simplify if it has to stay open, else allow a larger --max-error"
    )
    done = urdftool(*words, "--format", "json")
    found = json.loads(done.out)
    jsonschema.validate(found, json.loads((ROOT / "docs/schemas/collision.json").read_text()))
    hollow = found["results"][0]["parts"][0]["hollow"]
    assert hollow["depth"] == pytest.approx(DEPTH, rel=0.03)
    done = urdftool(*words, "--max-error", "0.9", "--format", "json")
    assert json.loads(done.out)["results"][0]["parts"][0]["hollow"] is None


@pytest.mark.slow
def test_auto_takes_the_plain_hull_where_pieces_fill_the_same(urdftool, write):
    mesh = write("cup.stl", stl(*SHEET))
    done = urdftool("collision", "mesh", mesh, "--max-hulls", "2", "--no-cache", "--format", "json")
    (part,) = json.loads(done.out)["results"][0]["parts"]
    assert (part["method"], len(part["pieces"])) in {("primitive", 1), ("hull", 1)}
    assert part["hollow"]["error"] <= 0.01


@pytest.mark.slow
@pytest.mark.parametrize(
    "shape", ['<cylinder radius="0.1" length="0.2"/>', '<mesh filename="cup.stl"/>']
)
def test_check_says_it_as_well(urdftool, write, shape):
    write("cup.stl", stl(*SHEET))
    lines = (
        '<visual><geometry><mesh filename="cup.stl"/></geometry></visual>',
        f'<collision><origin xyz="0 0 {"0.1" if "cyl" in shape else "0"}"/>',
        f"<geometry>{shape}</geometry></collision>",
    )
    path = write("r.urdf", f'<robot name="r"><link name="a">{"".join(lines)}</link></robot>')
    done = urdftool("collision", path, "--check", "--format", "json")
    found = json.loads(done.out)
    schema = json.loads((ROOT / "docs/schemas/collision-check.json").read_text())
    jsonschema.validate(found, schema)
    (link,) = found["results"][0]["links"]
    filled, other = ("hollow", "hull_hollow") if "cyl" in shape else ("hull_hollow", "hollow")
    assert link[filled]["depth"] == pytest.approx(DEPTH, rel=0.03)
    assert link[other] is None
    done = urdftool("collision", path, "--check")
    assert "fills a hollow that is open to the outside" in done.err
    assert done.code == int("cyl" in shape)


def test_a_hollow_of_metres_is_told_in_plain_digits(urdftool):
    done = urdftool("collision", "mesh", ROOT / "fixtures/meshes/open_box.stl", "--method", "hull",
                    "--no-cache")  # fmt: skip
    assert re.search(r"\(up to (99\d|100\d) mm deep\)", done.err)
