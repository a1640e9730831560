"""``urdftool fmt``: files, folders, standard input, ``--check`` and ``--diff``."""

import os
import shutil

import pytest

from tests.conftest import FIXTURES

LOOSE = b'<robot name="r">\n<link name="a" />\n</robot>\n'
NEAT = b'<robot name="r">\n  <link name="a"/>\n</robot>\n'


@pytest.fixture
def loose(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_bytes(LOOSE)
    return path


def test_writes_only_what_changes(urdftool, tmp_path, loose):
    neat = tmp_path / "neat.urdf"
    neat.write_bytes(NEAT)
    os.utime(neat, (1, 1))
    result = urdftool("fmt", tmp_path)
    assert (result.code, result.out) == (0, "")
    assert "Formatted 1 of 2 files." in result.err
    assert loose.read_bytes() == NEAT
    assert neat.stat().st_mtime == 1


def test_check_names_the_first_line(urdftool, loose):
    result = urdftool("fmt", loose, "--check")
    assert (result.code, result.out) == (1, f"{loose}:2: would be formatted\n")
    assert loose.read_bytes() == LOOSE
    urdftool("fmt", loose)
    assert urdftool("fmt", loose, "--check").code == 0


def test_diff(urdftool, loose):
    result = urdftool("fmt", loose, "--diff")
    assert result.code == 1
    assert '-<link name="a" />\n+  <link name="a"/>\n' in result.out
    assert loose.read_bytes() == LOOSE


def test_folders_have_descriptions_of_all_formats(urdftool, tmp_path):
    for name in ("a.xacro", "b.sdf", "c.srdf", "d.world", "e.mjcf"):
        (tmp_path / name).write_text("<sdf >\n</sdf>\n")
    (tmp_path / "f.xml").write_text("<!-- model -->\n<mujoco >\n</mujoco>\n")
    (tmp_path / "package.xml").write_text("<package >\n</package>\n")
    result = urdftool("fmt", tmp_path, "--check")
    names = [line.partition(":")[0].rpartition("/")[2] for line in result.out.splitlines()]
    assert names == ["a.xacro", "b.sdf", "c.srdf", "d.world", "e.mjcf", "f.xml"]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"<robot><link></robot>", "r.urdf:1:16: </robot> closes an element"),
        (b"<robot", "r.urdf:1:"),
        (b'<!DOCTYPE r [<!ENTITY e "x">]><r/>', "entity 'e' is declared"),
        ("<robot/>".encode("utf-16"), "r.urdf: is UTF-16 or UTF-32; save it as UTF-8"),
        (b"", "r.urdf:"),
        (b"\x00\xff\xfe", "r.urdf:"),
    ],
)
def test_what_is_not_well_formed_is_not_touched(urdftool, loose, data, said):
    loose.write_bytes(data)
    result = urdftool("fmt", loose)
    assert result.code == 2
    assert said in result.err
    assert loose.read_bytes() == data


def test_a_defect_of_one_file_does_not_stop_the_others(urdftool, tmp_path, loose):
    (tmp_path / "broken.urdf").write_text("<robot>")
    result = urdftool("fmt", tmp_path)
    assert result.code == 2
    assert loose.read_bytes() == NEAT


def test_excluded_files_are_left_alone(urdftool, tmp_path, loose):
    (tmp_path / "urdftool.toml").write_text('[lint]\nexclude = ["r.*"]\n')
    (tmp_path / "s.urdf").write_bytes(LOOSE)
    urdftool("fmt", tmp_path)
    assert loose.read_bytes() == LOOSE
    assert (tmp_path / "s.urdf").read_bytes() == NEAT


def test_no_file(urdftool, tmp_path):
    result = urdftool("fmt", tmp_path)
    assert result.code == 2
    assert "no .urdf, .xacro" in result.err


def test_expansion_is_the_same(urdftool, tmp_path):
    """Comments are compared, too: xacro removes those before its tags by counting line ends."""
    place = tmp_path / "demo_arm"
    shutil.copytree(FIXTURES / "robots" / "demo_arm", place)
    robot = place / "urdf" / "arm.urdf.xacro"
    before = urdftool("expand", robot)
    assert urdftool("fmt", place).code == 0
    after = urdftool("expand", robot)
    assert (before.code, after.code) == (0, 0)
    assert after.out == before.out
