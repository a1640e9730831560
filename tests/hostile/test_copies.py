"""An export carries meshes and images away, and nothing else of the disk."""

import os
import shutil

import pytest

from tests.conftest import FIXTURES

SECRET = b"top secret\n"
ROBOT = """<robot name="r"><link name="a">
<inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<visual><geometry><mesh filename="{mesh}"/></geometry>
<material name="m"><texture filename="{texture}"/></material></visual></link></robot>"""


@pytest.fixture
def folder(tmp_path):
    """A robot's folder beside one with a secret, which links and meshes in it name."""
    home = tmp_path / "home"
    home.mkdir()
    for name in ("key", "key.stl", "key.png"):
        (home / name).write_bytes(SECRET)
    folder = tmp_path / "robot"
    shutil.copytree(FIXTURES / "meshes", folder / "meshes")
    (folder / "meshes" / "link.stl").symlink_to(home / "key")
    (folder / "meshes" / "link.png").symlink_to(home / "key")
    (folder / "beside.txt").write_bytes(SECRET)
    dae = (FIXTURES / "meshes" / "cube.dae").read_text("utf-8")
    images = "".join(
        f'<image id="i{n}"><init_from>{name}</init_from></image>'
        for n, name in enumerate(("../beside.txt", "../../home/key", "link.png"))
    )
    ended = f"<library_images>{images}</library_images></COLLADA>"
    (folder / "meshes" / "evil.dae").write_text(dae.replace("</COLLADA>", ended))
    obj = (FIXTURES / "meshes" / "cube.obj").read_text("utf-8")
    libraries = "mtllib ../beside.txt\nmtllib ../model.sdf\nmtllib ../../home/key\n"
    (folder / "meshes" / "evil.obj").write_text(libraries + obj)
    (folder / "model.sdf").write_bytes(SECRET)
    return folder


MESHES = ["HOME/key", "file://HOME/key", "HOME/key.stl", "meshes/link.stl", "meshes/evil.dae"]
MESHES += ["meshes/evil.obj", "../home/key", "package://../../home/key", "package://home/key"]
TEXTURES = ["meshes/quadrants.png", "HOME/key", "HOME/key.png", "meshes/link.png", "../home/key"]


@pytest.mark.parametrize("language", ["sdf", "mjcf"])
@pytest.mark.parametrize("mesh", MESHES)
def test_only_meshes_are_copied(urdftool, folder, tmp_path, language, mesh):
    check(urdftool, folder, tmp_path, language, mesh, TEXTURES[0])


@pytest.mark.parametrize("language", ["sdf", "mjcf"])
@pytest.mark.parametrize("texture", TEXTURES)
def test_only_images_are_copied(urdftool, folder, tmp_path, language, texture):
    check(urdftool, folder, tmp_path, language, "meshes/cube.stl", texture)


def check(urdftool, folder, tmp_path, language, mesh, texture):
    home = str(tmp_path / "home")
    path = folder / "r.urdf"
    names = {"mesh": mesh.replace("HOME", home), "texture": texture.replace("HOME", home)}
    path.write_text(ROBOT.format(**names))
    out = tmp_path / "out"
    done = urdftool("export", language, path, "-o", out, "--force")
    assert done.code in (0, 1, 2), done.err
    assert SECRET not in [p.read_bytes() for p in out.rglob("*") if p.is_file()]
    assert not [p for p in out.rglob("*") if p.is_symlink()]
    assert sorted(os.listdir(tmp_path)) == sorted(["home", "robot", *(["out"] * out.exists())])
