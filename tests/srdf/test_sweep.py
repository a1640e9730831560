"""Swept bodies contain the body at every position of the joint that is removed."""

import math

import numpy as np
import pytest

pytest.importorskip("fcl")

from tests.conftest import FIXTURES
from urdftool.api.load import load
from urdftool.srdf.chain import place
from urdftool.srdf.cover import Piece, make_cover, make_hull
from urdftool.srdf.divide import Divider, Outcome
from urdftool.srdf.separate import get_poses
from urdftool.srdf.sweep import list_simpler, sweep_cover
from urdftool.srdf.verdicts import Options, list_tasks

ROUNDING = 1e-9


def measure_outside(points, pieces):
    """Return how far points are outside of the nearest of convex pieces, shape (n,)."""
    least = np.full(len(points), np.inf)
    for piece in pieces:
        a, b, c = piece.points[piece.faces].swapaxes(0, 1)
        normals = np.cross(b - a, c - a)
        length = np.linalg.norm(normals, axis=1)
        normals, a = (part[length > 1e-15] for part in (normals, a))
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        inward = ((piece.points.mean(axis=0) - a) * normals).sum(axis=1) > 0
        normals[inward] *= -1
        heights = points @ normals.T - (a * normals).sum(axis=1)
        least = np.minimum(least, heights.max(axis=1) - piece.inflation)
    return least


def turn(axis, angle):
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def draw(random, piece, count=40):
    """Return random points of a piece, its corners among them."""
    weights = random.dirichlet(np.full(len(piece.points), 0.3), count)
    return np.concatenate([piece.points, weights @ piece.points])


@pytest.mark.parametrize("seed", range(8))
def test_a_swept_cover_holds_the_pieces_at_every_angle(seed):
    random = np.random.default_rng(seed)
    shapes = [
        (make_hull(random.normal(size=(12, 3)) * random.uniform(0.01, 0.3) + shift), owner)
        for owner, shift in ((0, 0.0), (0, random.normal(size=3)), (1, random.normal(size=3)))
    ]
    ball = Piece(random.normal(size=(1, 3)), np.zeros((0, 3), dtype=np.int64), 0.05)
    cover = make_cover([*shapes, (ball, 1)])
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    frame = turn(np.array([0.6, 0.0, 0.8]), random.uniform(0, 6)), random.normal(size=3)
    swept = sweep_cover(cover, axis, frame)
    assert sorted(set(swept.owner.tolist())) == [0, 1]
    for piece, owner in [*shapes, (ball, 1)]:
        drums = [drum for drum, of in zip(swept.pieces, swept.owner, strict=True) if of == owner]
        for angle in random.uniform(-math.pi, math.pi, 5):
            points = draw(random, piece) @ frame[0].T + frame[1]
            outside = measure_outside(points @ turn(axis, angle).T, drums)
            assert outside.max() <= ROUNDING - piece.inflation


TASKS = [
    task
    for path in (
        FIXTURES / "robots" / "demo_arm" / "urdf" / "arm_sound.urdf.xacro",
        FIXTURES / "robots" / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro",
    )
    for task in list_tasks(load(path), Options())
]


def test_a_shorter_chain_holds_the_bodies_of_the_whole_one():
    """Compare the points of A and B with the swept covers, in the frame of the swept one."""
    random = np.random.default_rng(0)
    removed = set()
    for task in TASKS:
        covers = task.a.cover, task.b.cover
        lower = np.array([one.lower for one in task.chain.coordinates])
        upper = np.array([one.upper for one in task.chain.coordinates])
        values = random.uniform(lower, upper, (4, len(lower)))
        whole = get_poses(place(task.chain, values))
        for chain, swept in list_simpler(task.chain, covers):
            names = [one.joint for one in task.chain.coordinates]
            columns = [names.index(one.joint) for one in chain.coordinates]
            removed.add(len(names) - len(columns))
            short = get_poses(place(chain, values[:, columns]))
            for row in range(len(values)):
                for side in (0, 1):
                    # the other body stays, so both are seen from its frame if it is not swept
                    (turn_a, at_a), (turn_b, at_b) = (
                        (rotation[row], at[row]) for rotation, at in (whole[side], whole[1 - side])
                    )
                    (turn_c, at_c), (turn_d, at_d) = (
                        (rotation[row], at[row]) for rotation, at in (short[side], short[1 - side])
                    )
                    if swept[side] is covers[side] or swept[1 - side] is not covers[1 - side]:
                        continue
                    for piece in covers[side].pieces:
                        seen = (piece.points @ turn_a.T + at_a - at_b) @ turn_b
                        inside = (seen @ turn_d.T + at_d - at_c) @ turn_c
                        assert measure_outside(inside, swept[side].pieces).max() <= ROUNDING
    assert removed == {1, 2}


def make_arm(gap, last="continuous", extra=""):
    """Return a robot whose ball comes as near to a post as a gap, at one position of two joints."""
    return f"""<robot name="r">
  <link name="post"><collision><origin xyz="{0.9 + gap} 0 0"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="upper"/>
  <link name="tip"><collision><origin xyz="0.2 0 0"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="post"/><child link="upper"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="last" type="{last}"><parent link="upper"/><child link="tip"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-0.1" upper="0.1" effort="1" velocity="1"/>{extra}</joint>
</robot>"""


def list_proofs(write, text):
    """Return for each shorter chain of the only pair whether it is a proof."""
    [task] = list_tasks(load(write("r.urdf", text)), Options())
    proofs = []
    for chain, covers in list_simpler(task.chain, (task.a.cover, task.b.cover)):
        divider = Divider(chain, covers, {task.pairs[0]: Outcome()})
        divider.divide(2000, 2000)
        proofs.append(divider.outcomes[task.pairs[0]].is_free)
    return proofs


@pytest.mark.parametrize(("gap", "proved"), [(0.02, True), (-0.001, False)])
def test_what_can_touch_is_not_proved(write, gap, proved):
    """The ball ends at 0.8 m, which only the last joint at 0 and the first at 0 reach."""
    proofs = list_proofs(write, make_arm(gap))
    assert len(proofs) == 2
    assert any(proofs) == proved


@pytest.mark.parametrize(
    ("last", "extra", "count"),
    [
        ("revolute", "", 2),
        ("prismatic", "", 1),
        ("revolute", '<mimic joint="turn" multiplier="2"/>', 0),
    ],
)
def test_a_joint_that_slides_or_follows_is_kept(write, last, extra, count):
    limited = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    text = make_arm(0.02, last, extra).replace("continuous", "revolute")
    text = text.replace('<axis xyz="0 0 1"/></joint>', limited)
    assert len(list_proofs(write, text)) == count
