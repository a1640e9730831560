"""Robots for trimesh and yourdfpy, and the comparison of a bundle with its source."""

import numpy as np
import pytest

import urdftool as package
from tests.bundle import files
from tests.conftest import FIXTURES

ARM = FIXTURES / "robots" / "my_robot" / "urdf" / "arm.urdf.xacro"


def test_a_scene_has_the_links_and_their_geometry():
    robot = package.load(ARM)
    scene = robot.to_scene({"shoulder_joint": 0.5})
    assert {link.name for link in robot.links} <= set(scene.graph.nodes)
    turned = scene.graph.get("bicep_link", "world")[0]
    assert np.allclose(turned[:3, :3] @ turned[:3, :3].T, np.eye(3))
    assert not np.allclose(turned, robot.to_scene().graph.get("bicep_link", "world")[0])
    assert len(scene.geometry) == 5
    assert scene.geometry["bicep_link/0.0"].visual.face_colors[0].tolist() != [178, 178, 178, 255]


def test_a_scene_of_primitives_and_collisions(write):
    shapes = ("<sphere radius='0.5'/>", "<cylinder radius='1' length='4'/>", "<box size='1 2 3'/>")
    links = "".join(
        f"<link name='l{i}'><collision><origin xyz='0 0 {i}'/><geometry>{shape}</geometry>"
        f"</collision></link>"
        for i, shape in enumerate(shapes)
    )
    joints = "".join(
        f"<joint name='j{i}' type='fixed'><parent link='l0'/><child link='l{i}'/></joint>"
        for i in (1, 2)
    )
    robot = package.load(write("r.urdf", f"<robot name='r'>{links}{joints}</robot>"))
    assert robot.to_scene().is_empty
    bounds = robot.to_scene(collision=True).bounds
    assert np.allclose(bounds, [[-1, -1, -1], [1, 1, 3.5]], atol=1e-3)


def test_a_missing_mesh_is_an_error(write):
    robot = package.load(write("r.urdf", files.robot(("gone.stl", "gone.stl"))))
    with pytest.raises(package.UrdftoolError):
        robot.to_scene()


@pytest.mark.library("yourdfpy")
def test_yourdfpy_gets_the_meshes_of_packages():
    robot = package.load(ARM)
    urdf = robot.to_yourdfpy(load_collision_meshes=True, build_collision_scene_graph=True)
    assert [link.name for link in urdf.robot.links] == [link.name for link in robot.links]
    assert np.allclose(urdf.scene.bounds, robot.to_scene().bounds, atol=1e-6)


@pytest.mark.library("yourdfpy")
@pytest.mark.parametrize("uri", ["relative", "package", "file"])
def test_a_bundle_is_the_same_robot_in_yourdfpy(urdftool, tmp_path, uri):
    result = urdftool("bundle", ARM, "-o", tmp_path / "arm", "--uri", uri, "--check")
    assert (result.code, result.out) == (0, "")


@pytest.mark.library("yourdfpy")
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<child link="bicep_link"/>', '<child link="bicep_link"/><axis xyz="1 0 0"/>', "the pose"),
        ('type="revolute"', 'type="fixed"', "other joints"),
        ("<geometry>", '<origin xyz="0 0 1"/><geometry>', "the bounds of the visual geometry"),
    ],
)
def test_a_changed_robot_is_found(tmp_path, urdftool, old, new, message):
    from urdftool.bundle.yourdfpy_reader import compare_with_source

    robot = package.load(ARM)
    assert urdftool("bundle", ARM, "-o", tmp_path / "arm").code == 0
    path = tmp_path / "arm" / "my_robot_arm.urdf"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    found = compare_with_source(robot, path, path.name)
    assert {defect.code for defect in found} == {"differs-from-source"}
    assert any(message in str(defect) for defect in found)
