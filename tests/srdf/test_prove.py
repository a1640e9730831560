"""Proofs of pairs: against closed forms, random poses, another library, and themselves."""

import math

import numpy as np
import pytest

pytest.importorskip("fcl")

from tests.conftest import FIXTURES
from urdftool.api.load import load
from urdftool.geometry.load import load_named
from urdftool.geometry.tessellate import tessellate
from urdftool.model.kinematics import add_mimic_positions, link_poses
from urdftool.model.pose import make_pose
from urdftool.srdf.chain import find_chain, place
from urdftool.srdf.cover import make_hull, split_triangles
from urdftool.srdf.directed import MovingBoxes
from urdftool.srdf.motion import bound_motion
from urdftool.srdf.separate import Separator, get_poses
from urdftool.srdf.shapes import make_circumscribed
from urdftool.srdf.verdicts import Options, decide, list_tasks

ROBOTS = [
    FIXTURES / "robots" / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro",
    FIXTURES / "robots" / "demo_arm" / "urdf" / "arm_sound.urdf.xacro",
]


def sphere_arm(gap, low=-math.pi, high=math.pi, kind="revolute", extra=""):
    """Return a robot whose tip, a sphere of 0.1 m, turns on a circle of 0.5 m about the base.

    A post of radius 0.1 m stands at ``0.5 + 0.2 + gap`` from the axis, so that the shapes come as
    near as ``gap`` at the angle 0.
    """
    post = 0.7 + gap
    return f"""<robot name="r">
  <link name="post"><collision><origin xyz="{post} 0 0"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="bare"/>
  <link name="tip"><collision><origin xyz="0.5 0 0"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="out" type="prismatic"><parent link="post"/><child link="bare"/>
    <axis xyz="0 0 1"/><limit lower="-0.1" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="turn" type="{kind}"><parent link="bare"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="{low}" upper="{high}" effort="1" velocity="1"/>{extra}</joint>
</robot>"""


@pytest.mark.parametrize(
    ("gap", "low", "high", "expected"),
    [
        (0.01, -math.pi, math.pi, "never"),
        (0.001, -math.pi, math.pi, "never"),
        (-0.001, -math.pi, math.pi, "can-touch"),
        (-0.001, 0.5, 3.0, "never"),  # outside of the limits
        (-0.001, -20.0, 20.0, "can-touch"),
        (-0.05, 3.0, 1.0, "can-touch"),  # crossed limits are one turn
    ],
)
def test_spheres_on_a_circle(write, gap, low, high, expected):
    robot = load(write("r.urdf", sphere_arm(gap, low, high)))
    verdict = decide(robot, Options(jobs=1)).find("post", "tip")
    assert verdict.kind == expected
    if expected == "can-touch":
        angle, lift = verdict.positions["turn"], verdict.positions["out"]
        x, y = 0.5 * math.cos(angle) - 0.7 - gap, 0.5 * math.sin(angle)
        assert math.hypot(x, y, lift) <= 0.2 + 1e-6


def test_a_gap_below_the_margin_is_open(write):
    robot = load(write("r.urdf", sphere_arm(0.00002)))
    verdict = decide(robot, Options(jobs=1, boxes=3000)).find("post", "tip")
    assert verdict.kind == "open"
    assert 0 < verdict.distance < 0.01


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_a_joint_with_several_positions_is_open(write, kind):
    text = sphere_arm(0.01, kind=kind)
    verdict = decide(load(write("r.urdf", text)), Options(jobs=1)).find("post", "tip")
    assert (verdict.kind, verdict.reason) == ("open", f"joint 'turn' is {kind}")


def test_a_slide_without_limits_is_open(write):
    text = sphere_arm(0.01).replace('<limit lower="-0.1" upper="0.1" effort="1" velocity="1"/>', "")
    verdict = decide(load(write("r.urdf", text)), Options(jobs=1)).find("post", "tip")
    assert verdict.kind == "open"
    assert "'out' has no limits" in verdict.reason


def test_a_link_with_two_parents_is_open(write):
    second = '<joint name="two" type="fixed"><parent link="post"/><child link="bare"/></joint>'
    text = sphere_arm(0.01).replace("</robot>", second + "</robot>")
    verdict = decide(load(write("r.urdf", text)), Options(jobs=1)).find("post", "tip")
    assert (verdict.kind, verdict.reason) == ("open", "link 'bare' is the child of several joints")


def test_a_missing_mesh_leaves_its_pairs_enabled(urdftool, write):
    text = sphere_arm(0.01).replace('<sphere radius="0.1"/>', '<mesh filename="no.stl"/>', 1)
    write("r.urdf", text)
    result = urdftool("srdf", "r.urdf", "-j", "1")
    assert result.code == 0
    assert "disable_collisions" not in result.out
    assert "link 'post' is not compared: " in result.err


def test_without_collision_geometry_visuals_are_offered(urdftool, write):
    write("r.urdf", sphere_arm(0.01).replace("collision>", "visual>"))
    result = urdftool("srdf", "r.urdf")
    assert result.code == 2
    assert "--visual" in result.err
    result = urdftool("srdf", "r.urdf", "--visual", "-j", "1")
    assert result.code == 0
    assert 'link1="post" link2="tip" reason="Never"' in result.out


@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.name)
def test_motion_bounds_hold_at_random_poses(path):
    """Points of two links in the frame of the best split: their distance changes by less."""
    robot = load(path)
    names = [name for name, link in robot.link.items() if link.collisions]
    random = np.random.default_rng(5)
    for a, b in zip(names, names[2:], strict=False):
        chain = find_chain(robot, a, b)
        if chain.obstacle or not chain.coordinates:
            continue
        lower = np.array([c.lower for c in chain.coordinates])
        upper = np.array([c.upper for c in chain.coordinates])
        for share in (0.02, 0.3, 1.0):
            center = random.uniform(lower, upper, (20, len(lower)))
            half = np.broadcast_to(share * (upper - lower) / 2, center.shape)
            point_a, point_b = random.normal(scale=0.2, size=(2, 1, 3))
            placed = place(chain, center)
            spots = [
                placed.rotations[side] @ point[0] + placed.translations[side]
                for side, point in enumerate((point_a, point_b))
            ]
            zero = np.zeros(1), np.zeros(1)
            centers = spots[0][:, None], spots[1][:, None]
            move_a, move_b = bound_motion(chain, placed, half, centers, zero).bounds
            start = np.linalg.norm(spots[1] - spots[0], axis=1)
            for _ in range(30):
                moved = place(chain, center + half * random.uniform(-1, 1, center.shape))
                ends = [
                    moved.rotations[side] @ point[0] + moved.translations[side]
                    for side, point in enumerate((point_a, point_b))
                ]
                change = abs(np.linalg.norm(ends[1] - ends[0], axis=1) - start)
                assert (change <= (move_a + move_b)[:, 0] + 1e-9).all()


def test_forward_kinematics_is_that_of_the_model(write):
    robot = load(ROBOTS[0])
    names = list(robot.tree.order)
    random = np.random.default_rng(6)
    for a, b in zip(names, names[::-1], strict=True):
        chain = find_chain(robot, a, b)
        if chain.obstacle:
            continue
        values = [random.uniform(c.lower, c.upper) for c in chain.coordinates]
        given = {c.joint: value for c, value in zip(chain.coordinates, values, strict=True)}
        poses = link_poses(robot, add_mimic_positions(robot, given))
        placed = place(chain, np.array([values]))
        relative = poses[a].invert() @ poses[b]
        turn = placed.rotations[0][0].T
        assert np.allclose(turn @ placed.rotations[1][0], relative.rotation, atol=1e-12)
        shift = turn @ (placed.translations[1][0] - placed.translations[0][0])
        assert np.allclose(shift, relative.translation, atol=1e-12)


@pytest.mark.parametrize("kind", ["cylinder", "cone", "ellipsoid", "box"])
def test_covers_contain_primitives(kind):
    size = (0.1, 0.2, 0.3) if kind in ("box", "ellipsoid") else (0.1, 0.3)
    surface, _ = tessellate(kind, size, 60 if kind == "ellipsoid" else 720)
    piece = make_hull(make_circumscribed(kind, size))
    assert measure_outside(piece, surface) <= 1e-7


def measure_outside(piece, points):
    """Return how far points lie outside of the planes of a piece [m]."""
    a, b, c = piece.points[piece.faces].swapaxes(0, 1)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return (points @ normals.T - (normals * a).sum(axis=1)).max() - piece.inflation


def test_pieces_contain_their_triangles():
    random = np.random.default_rng(1)
    corners = random.normal(size=(400, 1, 3)) + random.normal(scale=0.05, size=(400, 3, 3))
    groups = split_triangles(corners, 24)
    assert len(groups) == 24
    assert sum(map(len, groups)) == 1200
    for points in groups:
        assert measure_outside(make_hull(points), points) <= 1e-9


@pytest.mark.parametrize("flat", [np.zeros((1, 3)), np.eye(3)[:2], np.eye(3)])
def test_flat_pieces_are_thickened(flat):
    assert measure_outside(make_hull(flat), flat) <= 1e-9


def test_same_bytes_with_one_and_two_processes(urdftool):
    texts = [urdftool("srdf", ROBOTS[1], "-j", jobs, "--format", "json").out for jobs in (1, 2)]
    assert texts[0]
    assert texts[0] == texts[1]


@pytest.mark.slow
def test_time_turns_decided_into_open(write):
    robot = load(ROBOTS[0])
    full, short = decide(robot, Options(jobs=1)), decide(robot, Options(jobs=1, time_limit=0.0))
    for one, other in zip(full.pairs, short.pairs, strict=True):
        assert one.links == other.links
        assert other.kind in (one.kind, "open")
    assert short.count()["open"] > full.count()["open"]


def make_coal_shapes(coal, robot, name):
    """Return the shapes of a link for coal, with their poses."""
    found = []
    for collision in robot.link[name].collisions:
        pose = make_pose(collision.origin)
        geometry = collision.geometry
        kind = type(geometry).__name__
        if kind == "Mesh":
            mesh = load_named(robot.source, geometry.filename, geometry.scale)
            shape = coal.BVHModelOBBRSS()
            shape.beginModel(len(mesh.faces), len(mesh.vertices))
            shape.addVertices(mesh.vertices)
            shape.addTriangles(mesh.faces)
            shape.endModel()
        else:
            size = {
                "Box": lambda g: g.size,
                "Sphere": lambda g: (g.radius,),
                "Cylinder": lambda g: (g.radius, g.length),
            }[kind](geometry)
            shape = getattr(coal, kind)(*size)
        found.append((shape, pose))
    return found


def measure_by_coal(coal, robot, pair, positions):
    """Return the distance of two links by coal [m], and the kinematics of the model."""
    poses = link_poses(robot, add_mimic_positions(robot, positions))
    placed = [
        [(shape, poses[name] @ pose) for shape, pose in make_coal_shapes(coal, robot, name)]
        for name in pair
    ]
    distances = []
    for one, at in placed[0]:
        for other, to in placed[1]:
            frames = [
                coal.Transform3s(np.array(pose.rotation), np.array(pose.translation))
                for pose in (at, to)
            ]
            request, result = coal.DistanceRequest(), coal.DistanceResult()
            distances.append(coal.distance(one, frames[0], other, frames[1], request, result))
    return min(distances)


@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.name)
def test_coal_agrees(path):
    coal = pytest.importorskip("coal")
    robot = load(path)
    verdicts = decide(robot, Options(jobs=1))
    random = np.random.default_rng(8)
    assert verdicts.count()["can-touch"]
    for verdict in verdicts.pairs:
        pair = verdict.link1, verdict.link2
        if verdict.kind == "can-touch":
            assert measure_by_coal(coal, robot, pair, verdict.positions) <= 1e-4
        elif verdict.kind == "never":
            for _ in range(20):
                given = {n: random.uniform(*bounds) for n, bounds in verdicts.ranges.items()}
                assert measure_by_coal(coal, robot, pair, given) > 0


@pytest.mark.slow
def test_a_body_of_several_links_is_that_of_each(write):
    """Links fixed to each other are compared at once; each verdict is that of the link alone."""
    robot = load(ROBOTS[0])
    verdicts = decide(robot, Options(jobs=1))
    for verdict in verdicts.pairs[::3]:
        alone = Options(jobs=1, only=frozenset((verdict.links,)))
        assert decide(robot, alone).pairs[0].kind == verdict.kind


@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.name)
def test_free_pieces_are_apart_at_random_poses_of_their_box(path):
    """Pieces that a direction separates in a box are apart at all its joint positions."""
    import fcl

    robot, random, freed = load(path), np.random.default_rng(7), 0
    for task in list_tasks(robot, Options()):
        chain, covers = task.chain, (task.a.cover, task.b.cover)
        if not chain.coordinates:
            continue
        number = np.zeros((len(covers[0]), len(covers[1])), dtype=np.int64)
        separator = Separator(covers, number, 1e-4)
        lower = np.array([c.lower for c in chain.coordinates])
        upper = np.array([c.upper for c in chain.coordinates])
        center = random.uniform(lower, upper, (40, len(lower)))
        half = random.choice([0.01, 0.03, 0.1], (40, 1)) * (upper - lower)
        placed = place(chain, center)
        centers = separator.locate(get_poses(placed))
        motion = bound_motion(chain, placed, half, centers, (covers[0].radii, covers[1].radii))
        boxes = MovingBoxes(placed, motion, tuple(step.column for step in chain.steps))
        box = np.arange(40)
        pieces = tuple(random.integers(0, len(cover), 40) for cover in covers)
        unit = random.normal(size=(40, 3)) * 0.2 + centers[1][box, pieces[1]]
        unit -= centers[0][box, pieces[0]]
        unit /= np.linalg.norm(unit, axis=1)[:, None]
        gap = measure_gap(covers, placed, pieces, unit)
        free = separator.directed.find_free(boxes, box, pieces, unit, gap, 1e-4)
        crude = motion.bounds[0][box, pieces[0]] + motion.bounds[1][box, pieces[1]] + 1e-4
        freed += (free & (gap <= crude)).sum()
        for _ in range(20):
            moved = place(chain, center + half * random.choice([-1, 1, 0.3], center.shape))
            for row in np.nonzero(free)[0]:
                solids = [separator._get_solid(side, int(pieces[side][row])) for side in (0, 1)]
                objects = [
                    fcl.CollisionObject(solid, fcl.Transform(turn[row], shift[row]))
                    for solid, (turn, shift) in zip(solids, get_poses(moved), strict=True)
                ]
                distance = fcl.distance(*objects, fcl.DistanceRequest(), fcl.DistanceResult())
                assert distance > 0
    assert freed > 20  # pairs that only the bound of second order separates


def measure_gap(covers, placed, pieces, unit):
    """Return the distance of pieces along directions at the centers of their boxes [m]."""
    heights = []
    for cover, some, (turn, shift), choose in zip(
        covers, pieces, get_poses(placed), (max, min), strict=True
    ):
        heights.append(
            [
                choose((cover.pieces[index].points @ turn[row].T + shift[row]) @ unit[row])
                for row, index in enumerate(some)
            ]
        )
    grown = covers[0].inflation[pieces[0]] + covers[1].inflation[pieces[1]]
    return np.array(heights[1]) - np.array(heights[0]) - grown
