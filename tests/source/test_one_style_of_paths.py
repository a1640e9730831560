"""Paths of included files have the style of the path of the description."""

import os

import pytest

MANIFEST = "<package><name>p</name></package>"
ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="$(find p)/urdf/part.xacro"/><link name="a"/></robot>"""
PART = """<robot><link name="b"><inertial><mass value="-1"/></inertial></link>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / ".git").mkdir()
    (tmp_path / "p" / "urdf").mkdir(parents=True)
    (tmp_path / "q").mkdir()
    (tmp_path / "p" / "package.xml").write_text(MANIFEST)
    (tmp_path / "p" / "urdf" / "r.urdf.xacro").write_text(ROBOT)
    (tmp_path / "p" / "urdf" / "part.xacro").write_text(PART)
    return tmp_path


@pytest.mark.parametrize(
    ("start", "given"),
    [("", "p/urdf"), ("q", "../p/urdf"), ("p/urdf", "."), ("q", "{}/p/urdf"), ("", "{}/p/urdf")],
)
def test_an_included_file(urdftool, folder, monkeypatch, start, given):
    monkeypatch.chdir(folder / start)
    given = given.format(folder)
    for words in ([os.path.join(given, "r.urdf.xacro")], [given]):
        out = urdftool("lint", *words, "--format", "concise", "--select", "negative-mass").out
        assert out.startswith(f"{os.path.normpath(os.path.join(given, 'part.xacro'))}:1:")
