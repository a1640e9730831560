"""Files of a robot, and which files these name."""

import pytest

import urdftool
from tests.assets import make_png
from urdftool.formats.common.assets import find_companions, find_file

PNG = make_png()


@pytest.fixture
def robot(write, tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "a.obj").write_text("mtllib a.mtl\nmtllib /etc/passwd\nmtllib no.mtl\n")
    (tmp_path / "meshes" / "a.mtl").write_text("newmtl m\nmap_Kd ../a.png\nmap_Ks secret.png\n")
    (tmp_path / "meshes" / "secret.png").write_text("no image")
    (tmp_path / "a.png").write_bytes(PNG)
    return urdftool.load(write("r.urdf", '<robot name="r"><link name="a"/></robot>'))


def test_a_file_is_found_from_the_description(robot, tmp_path):
    assert find_file(robot, "meshes/a.obj") == tmp_path / "meshes" / "a.obj"


@pytest.mark.parametrize("uri", ["", "meshes", "meshes/no.obj", "package://no/a.obj", "a\0b"])
def test_what_is_no_file_is_not_found(robot, uri):
    assert find_file(robot, uri) is None


def test_companions_are_what_a_file_names_and_what_is_of_its_kind(robot, tmp_path):
    folder = tmp_path / "meshes"
    assert list(find_companions(robot, folder / "a.obj")) == [(folder / "a.mtl", "a.mtl")]
    assert list(find_companions(robot, folder / "a.mtl")) == [(folder / "../a.png", "../a.png")]
    assert list(find_companions(robot, folder / "secret.png")) == []
