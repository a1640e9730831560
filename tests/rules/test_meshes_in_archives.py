"""Meshes that are only in a zip file next to the description."""

import zipfile

import pytest

from urdftool.api.lint import check

LINK = (
    '<link name="{0}"><visual><geometry><mesh filename="meshes/{0}.stl"/></geometry></visual>'
    "</link>"
)
ROBOT = '<robot name="r"><link name="base"/>{}</robot>'
JOINT = '<joint name="{0}" type="fixed"><parent link="base"/><child link="{0}"/></joint>'


@pytest.mark.parametrize(
    ("entries", "levels"),
    [
        (["meshes/a.stl", "meshes/b.stl"], ["info"]),
        (["a.stl", "b.stl"], ["info"]),  # into a folder of its name
        (["meshes/a.stl"], ["info", "error"]),
        (["other/a.stl", "other/b.stl"], ["error"]),
        (None, ["error"]),
    ],
)
def test_meshes_in_a_zip_file(tmp_path, entries, levels):
    parts = "".join(LINK.format(name) + JOINT.format(name) for name in "ab")
    (tmp_path / "robot.urdf").write_text(ROBOT.format(parts))
    if entries is None:
        (tmp_path / "meshes.zip").write_bytes(b"PK, but no zip file")
    else:
        with zipfile.ZipFile(tmp_path / "meshes.zip", "w") as archive:
            for entry in entries:
                archive.writestr(entry, "solid a")
    found = check(tmp_path / "robot.urdf", select=["mesh-not-found"], grouped=True)
    assert [one.severity.label for one in found] == levels
    if levels == ["info"]:
        assert "2 mesh files are only in" in found[0].message
        assert found[0].effects["pybullet, drake"] == "reject the robot"
