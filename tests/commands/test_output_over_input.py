"""A report that is to be written over a file of the robot."""

import pytest

from tests.conftest import FIXTURES

ROBOT = (
    '<robot name="r"><link name="a"><visual><geometry><mesh filename="m.stl"/></geometry></visual>'
    "</link></robot>"
)


@pytest.mark.parametrize(
    "words",
    [
        *(f"lint r.urdf {option} m.stl" for option in ("--output-file", "--junit")),
        "lint r.urdf --baseline b.json --output-file b.json",
        *(f"{command} r.urdf r.urdf -o m.stl" for command in ("verify", "diff")),
        *(f"{command} r.urdf -o m.stl" for command in ("info", "inertia robot")),
    ],
)
def test_no_report_replaces_a_file_that_was_read(tmp_path, urdftool, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "r.urdf").write_text(ROBOT)
    mesh = (FIXTURES / "meshes" / "sphere.stl").read_bytes()
    (tmp_path / "m.stl").write_bytes(mesh)
    assert urdftool("lint", "r.urdf", "--write-baseline", "b.json", "--exit-zero").code == 0
    baseline = (tmp_path / "b.json").read_bytes()
    result = urdftool(*words.split())
    assert result.code == 2
    assert "is an input" in result.err
    assert (tmp_path / "m.stl").read_bytes() == mesh
    assert (tmp_path / "b.json").read_bytes() == baseline
