"""glTF meshes: with Y up, as their standard has it, or with the axes of the file."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import trimesh
from lxml import etree

from tests.conftest import FIXTURES
from urdftool.api.lint import check
from urdftool.collision.cache import compute_key
from urdftool.collision.compute import Task
from urdftool.formats.mjcf.cache import convert_all
from urdftool.model.gltf_axes import describe_gltf_axes
from urdftool.model.load import load

SHAPE = (
    '<visual><geometry><mesh filename="{}"/></geometry></visual>'
    '<collision><origin xyz="0 0 9"/><geometry><box size="1 1 1"/></geometry></collision>'
)

SIZE = (0.1, 0.2, 0.6)
"""Of the part that stands in the tests [m]: along X, Y and Z, so 0.6 m high."""

LINK = """<link name="a">
<inertial><mass value="1"/><inertia ixx="0.03" iyy="0.03" izz="0.004" ixy="0" ixz="0" iyz="0"/>
</inertial>
<visual><origin xyz="0 0 1" rpy="0.1 0.2 0.3"/>
<geometry><mesh filename="{0}" scale="1 2 3"/></geometry></visual>
<collision><geometry><mesh filename="{0}"/></geometry></collision></link>"""


def robot(tmp_path, *meshes):
    for mesh in meshes:
        shutil.copy(FIXTURES / "meshes" / f"cube.{mesh.rpartition('.')[2]}", tmp_path / mesh)
    file = tmp_path / "robot.urdf"
    shapes = "".join(SHAPE.format(mesh) for mesh in meshes)
    file.write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')
    return file


@pytest.fixture
def parts(write, tmp_path):
    """One part that stands, written with Z up and with Y up, each in a robot."""
    upright = trimesh.creation.box(SIZE)
    for up, turn in (("z", 0.0), ("y", -np.pi / 2)):
        file = upright.copy()
        file.apply_transform(trimesh.transformations.rotation_matrix(turn, (1, 0, 0)))
        (tmp_path / f"{up}.glb").write_bytes(trimesh.Scene([file]).export(file_type="glb"))
        write(f"{up}.urdf", f'<robot name="r">{LINK.format(up + ".glb")}</robot>')


def extents(urdftool, name, *words):
    done = urdftool("info", name, "--format", "json", *words)
    bounds = json.loads(done.out)["bounds"]
    return [*bounds["low"], *bounds["high"]]


def test_either_convention_gives_the_same_robot_when_it_is_said(urdftool, parts):
    right = extents(urdftool, "y.urdf")
    assert extents(urdftool, "z.urdf", "--gltf-up", "z") == pytest.approx(right, abs=1e-6)
    wrong = extents(urdftool, "z.urdf")
    assert wrong != pytest.approx(right, abs=1e-3)
    assert extents(urdftool, "y.urdf", "--gltf-up", "y") == right


def test_the_configuration_says_it_and_the_line_says_it_louder(urdftool, write, parts):
    right, wrong = extents(urdftool, "y.urdf"), extents(urdftool, "z.urdf")
    write("z/urdftool.toml", 'gltf-up = "z"\n')
    shutil.copy("z.glb", "z/z.glb")
    shutil.copy("z.urdf", "z/z.urdf")
    assert extents(urdftool, "z/z.urdf") == pytest.approx(right, abs=1e-6)
    assert extents(urdftool, "z/z.urdf", "--gltf-up", "y") == pytest.approx(wrong, abs=1e-6)
    done = urdftool("inertia", "mesh", "z/z.glb", "--mass", 1, "--format", "json")
    assert json.loads(done.out)["inertia"]["izz"] == pytest.approx((0.1**2 + 0.2**2) / 12)


@pytest.mark.parametrize("value", ['"x"', "1", "true", "[]"])
def test_another_axis_in_the_configuration_is_refused(urdftool, write, parts, value):
    write("urdftool.toml", f"gltf-up = {value}\n")
    done = urdftool("info", "y.urdf")
    assert done.code == 2
    assert 'gltf-up must be "y" or "z"' in done.err


def test_mass_and_collisions_follow_the_file(urdftool, parts):
    for name, words in (("y.urdf", ()), ("z.urdf", ("--gltf-up", "z"))):
        done = urdftool("inertia", "robot", name, "--all", "--format", "json", *words)
        (link,) = json.loads(done.out)["links"]
        x, y, _ = SIZE
        assert link["implied"]["inertia"]["izz"] == pytest.approx((x * x + y * y) / 12, rel=1e-6)
        done = urdftool("collision", name, "-o", "-", "--method", "primitive", *words)
        made = etree.fromstring(done.out.encode())
        box = [float(n) for n in made.find(".//collision//box").get("size").split()]
        assert sorted(box) == pytest.approx(sorted((0.1, 0.4, 1.8)), abs=1e-6)


def test_results_that_are_kept_know_the_axis(urdftool, parts, tmp_path):
    for name in ("y", "z"):
        keys = {compute_key(Task(tmp_path / f"{name}.glb", gltf_up=up)) for up in ("y", "z")}
        assert len(keys) == 2
    lying, upright = (convert_all([(tmp_path / "z.glb", True, up)])[0] for up in ("y", "z"))
    again = convert_all([(tmp_path / "z.glb", True, "y")])[0]
    assert again.pieces[0].data == lying.pieces[0].data != upright.pieces[0].data


def test_lint_sees_the_robot_as_it_is_said_to_be(urdftool, write, parts):
    text = '<robot name="r"><link name="a"><visual><geometry><mesh filename="z.glb"/></geometry>'
    text += '</visual><collision><origin xyz="0 0 0.28"/><geometry><box size="0.1 0.2 0.3"/>'
    write("r.urdf", text + "</geometry></collision></link></robot>")
    for words, count in (((), 1), (("--gltf-up", "z"), 0), (("--gltf-up", "y"), 1), ((), 1)):
        done = urdftool("lint", "r.urdf", "--select", "collision-off-visual", *words)
        assert done.out.count("[collision-off-visual]") == count, done.out
    assert len(check("r.urdf", select=["collision-off-visual"])) == 1
    assert not check("r.urdf", select=["collision-off-visual"], gltf_up="z")
    assert not check(load("r.urdf", gltf_up="z"), select=["collision-off-visual"])


def world_box(mesh, pose, scale):
    """The box around a mesh at a pose of SDF, by numbers of our own."""
    x, y, z, roll, pitch, yaw = pose
    turn = trimesh.transformations.euler_matrix(roll, pitch, yaw, "sxyz")[:3, :3]
    points = mesh.vertices * scale @ turn.T + (x, y, z)
    return np.array([points.min(axis=0), points.max(axis=0)])


@pytest.mark.parametrize("target", ["gz", "gazebo-classic"])
def test_gazebo_keeps_the_axes_so_the_pose_turns_what_is_turned(urdftool, parts, target):
    boxes = {}
    for name, words in (("y", ()), ("z", ("--gltf-up", "z"))):
        done = urdftool("export", "sdf", f"{name}.urdf", "-o", name, "--target", target, *words)
        assert done.code == 0
        assert ("note: 'y.glb' is glTF and read with Y up" in done.err) is (name == "y")
        assert ("a format that Gazebo Classic does not read" in done.err) is (target != "gz")
        visual = etree.parse(f"{name}/model.sdf").find(".//visual")
        pose = [float(number) for number in visual.findtext("pose").split()]
        scale = [float(number) for number in visual.findtext(".//scale").split()]
        mesh = trimesh.load_mesh(f"{name}/meshes/{name}.glb")
        boxes[name] = world_box(mesh, pose, scale)
        checked = urdftool(
            *("export", "sdf", f"{name}.urdf", "-o", f"{name}v", "--target", target, "--verify"),
            *words,
        )
        assert "differ" not in checked.out
    np.testing.assert_allclose(boxes["y"], boxes["z"], atol=1e-6)


def test_verification_sees_a_mesh_that_is_not_turned(urdftool, parts, monkeypatch):
    from urdftool.formats.sdf import links

    monkeypatch.setattr(links, "undo_axis_conversion", lambda t, link, part: part)
    done = urdftool("export", "sdf", "y.urdf", "-o", "out", "--verify")
    assert done.code == 1
    assert "visuals" in done.out
    assert "differ" in done.out


def test_mujoco_gets_what_is_up_turned(urdftool, parts):
    pytest.importorskip("mujoco")
    for name, words in (("y", ()), ("z", ("--gltf-up", "z"))):
        done = urdftool("export", "mjcf", f"{name}.urdf", "-o", name, "--verify", *words)
        assert done.code == 0, done.err
        for file in Path(name, "assets").glob("*.obj"):
            np.testing.assert_allclose(trimesh.load_mesh(file).extents, SIZE, atol=1e-6)


def test_the_picture_says_how_it_is_drawn(urdftool, tmp_path):
    file = robot(tmp_path, "one.glb")
    assert describe_gltf_axes(load(file)).startswith("'one.glb' is glTF and read with Y up")
    assert "--gltf-up z" in describe_gltf_axes(load(file))
    assert describe_gltf_axes(load(file, gltf_up="z")) == ""
    done = urdftool("view", file, "--picture", tmp_path / "p.png", "--size", "64x48")
    assert done.code == 0
    assert "note: 'one.glb' is glTF" in done.err
    assert describe_gltf_axes(load(robot(tmp_path, "one.glb", "two.glb"))).startswith(
        "2 meshes are glTF"
    )


def test_other_meshes_have_no_two_ways_up(urdftool, tmp_path):
    file = robot(tmp_path, "one.stl")
    assert describe_gltf_axes(load(file)) == ""


def test_a_collision_that_is_off_may_be_a_matter_of_axes(tmp_path):
    for mesh, told in (("one.glb", True), ("one.stl", False)):
        (found,) = check(robot(tmp_path, mesh), select=["collision-off-visual"])
        assert ("export it with Y up, or use --gltf-up z" in found.message) is told
