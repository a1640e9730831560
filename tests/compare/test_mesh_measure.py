"""Measures of meshes at poses, and of their union."""

import numpy as np
import pytest
import trimesh

from urdftool.compare.compare import compare_robots
from urdftool.compare.mesh_measure import MeshMeasures, measure_distance
from urdftool.mechanics.reference import turn
from urdftool.model.load import load

TETRAHEDRON = """v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nv 9 9 9
f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"""


@pytest.fixture
def robot(write):
    write("a.obj", TETRAHEDRON)
    parts = [f"f {face}" for face in ("1 3 2\nf 1 2 4", "1 4 3\nf 2 3 4")]
    for number, faces in enumerate(parts):
        write(f"part{number}.obj", TETRAHEDRON.partition("f ")[0] + faces + "\n")
    visuals = "".join(
        f'<visual><geometry><mesh filename="{name}.obj"/></geometry></visual>'
        for name in ("a", "part0", "part1")
    )
    return load(write("a.urdf", f'<robot name="r"><link name="l">{visuals}</link></robot>'))


def make_pose():
    pose = np.eye(4)
    pose[:3, :3] = turn(np.array([0.0, 0.6, 0.8]), 0.7)
    pose[:3, 3] = 1, 2, 3
    return pose


def test_a_mesh_at_a_pose(robot):
    """The moments are those of 200,000 random points; a vertex without a triangle is ignored."""
    whole, pose = robot.links[0].visuals[0].geometry, make_pose()
    measure = MeshMeasures().measure(robot, [(whole, pose)])
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]]) @ pose[:3, :3].T + pose[:3, 3]
    np.testing.assert_allclose(measure.low, corners.min(axis=0))
    np.testing.assert_allclose(measure.high, corners.max(axis=0))
    faces = corners[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]
    areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)
    assert measure.area == pytest.approx(areas.sum() / 2)
    generator = np.random.default_rng(1)
    chosen = faces[generator.choice(4, 200_000, p=areas / areas.sum())]
    weights = generator.dirichlet((1, 1, 1), 200_000)
    points = np.einsum("nij,ni->nj", chosen, weights)
    np.testing.assert_allclose(measure.center, points.mean(axis=0), atol=0.01)
    np.testing.assert_allclose(measure.second, np.cov(points.T), atol=0.01)


def test_parts_of_a_mesh_measure_as_the_whole(robot):
    shapes, pose = [visual.geometry for visual in robot.links[0].visuals], make_pose()
    measures = MeshMeasures()
    whole = measures.measure(robot, [(shapes[0], pose)])
    parts = measures.measure(robot, [(shape, pose) for shape in shapes[1:]])
    assert measure_distance(whole, parts, 1e-9) < 1e-12
    one = measures.measure(robot, [(shapes[1], pose)])
    assert measure_distance(whole, one, 1e-9) > 0.1


def _write_pinwheel(path, hand=1.0):
    """Write a square plate with a hook at each corner, as a fan that turns left or right."""
    arm = trimesh.creation.box((0.1, 0.4, 0.1))
    arm.apply_translation((0.3, 0.15 * hand, 0))
    parts = [trimesh.creation.box((0.6, 0.6, 0.1))]
    for quarter in range(4):
        parts.append(arm.copy())
        parts[-1].apply_transform(
            trimesh.transformations.rotation_matrix(quarter * np.pi / 2, (0, 0, 1))
        )
    trimesh.util.concatenate(parts).export(path)


SHAPE = '<link name="a"><{kind}><origin rpy="{rpy}"/><geometry>{shape}</geometry></{kind}></link>'


@pytest.mark.parametrize(
    ("one", "two", "is_equal"),
    [
        (("<box size='.4 .4 .1'/>", "0 0 0"), ("<box size='.4 .4 .1'/>", "0 0 0.785398"), False),
        (("<box size='.4 .4 .1'/>", "0 0 0"), ("<box size='.4 .4 .1'/>", f"0 0 {np.pi / 2}"), True),
        (("<box size='.4 .4 .4'/>", "0 0 0"), ("<box size='.4 .4 .4'/>", "0.3 0.2 0.1"), False),
        (("<box size='.2 .3 .4'/>", f"{np.pi / 2} 0 0"), ("<box size='.2 .4 .3'/>", "0 0 0"), True),
        (
            ("<cylinder radius='.1' length='.1'/>", "0 0 0"),
            ("<cylinder radius='.1' length='.1'/>", "0.3 0 0"),
            False,
        ),
        (
            ("<cylinder radius='.1' length='.1'/>", "0 0 0"),
            ("<cylinder radius='.1' length='.1'/>", f"{np.pi} 0 1"),
            True,
        ),
        (
            ("<mesh filename='left.stl'/>", "0 0 0"),
            ("<mesh filename='right.stl'/>", "0 0 0"),
            False,
        ),
        (
            ("<mesh filename='left.stl'/>", "0 0 0"),
            ("<mesh filename='left.stl' scale='-1 1 1'/>", "0 0 0"),
            False,
        ),
        (
            ("<mesh filename='right.stl'/>", f"0 0 {np.pi / 2}"),
            ("<mesh filename='left.stl' scale='-1 1 1'/>", "0 0 0"),
            True,
        ),
        (("<mesh filename='left.stl'/>", "0 0 0"), ("<mesh filename='fine.stl'/>", "0 0 0"), True),
    ],
)
def test_only_symmetries_of_a_shape_are_equal(tmp_path, one, two, is_equal):
    _write_pinwheel(tmp_path / "left.stl")
    _write_pinwheel(tmp_path / "right.stl", -1.0)
    trimesh.load(tmp_path / "left.stl").subdivide().export(tmp_path / "fine.stl")
    robots = []
    for name, (shape, rpy) in (("one", one), ("two", two)):
        path = tmp_path / f"{name}.urdf"
        links = SHAPE.format(kind="collision", rpy=rpy, shape=shape)
        path.write_text(f'<robot name="r">{links}</robot>')
        robots.append(load(path))
    comparison = compare_robots(*robots)
    assert ("collisions" not in {one.row for one in comparison.differences}) is is_equal
