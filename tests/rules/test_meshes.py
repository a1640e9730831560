"""Meshes that are not there, and how many findings they make."""

import struct

import pytest

from urdftool.api.lint import check

LINK = '<link name="l{0}"><visual><geometry><mesh filename="{1}"/></geometry></visual></link>'
TRIANGLE = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 0.2, 0, 0, 0, 0.2, 0, 0)
STL = b"link".ljust(80) + struct.pack("<I", 2) + TRIANGLE * 2


def _found(folder, *uris, name="robot.urdf", head='<robot name="r">', **options):
    file = folder / name
    links = "\n".join(LINK.format(number, uri) for number, uri in enumerate(uris))
    file.write_text(f"{head}\n{links}\n</robot>\n")
    found = check(file, select=["mesh", "package-not-found"], **options)
    return [(finding.code, finding.location.line) for finding in found]


def test_file_that_is_wanted_twice_is_one_finding(tmp_path):
    assert _found(tmp_path, "a.stl", "a.stl", "b.stl") == [
        ("mesh-not-found", 2),
        ("mesh-not-found", 4),
    ]


def test_folder_that_is_not_there_is_one_finding(tmp_path):
    uris = [f"meshes/{letter}.stl" for letter in "abcde"]
    assert _found(tmp_path, *uris) == [("mesh-not-found", 2)]


def test_package_that_is_not_there_is_one_finding(tmp_path):
    uris = [f"package://arm_description/{letter}.stl" for letter in "abc"]
    assert _found(tmp_path, *uris) == [("package-not-found", 2)]


def test_package_may_be_named(tmp_path):
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "a.stl").write_bytes(STL)
    assert _found(tmp_path, "package://arm/a.stl", packages={"arm": tmp_path / "arm"}) == []


def test_place_searched_and_near_name_are_in_the_message(tmp_path):
    (tmp_path / "base_link.stl").write_bytes(STL)
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r">{LINK.format(0, "base_lnik.stl")}</robot>')
    (finding,) = check(file, select=["mesh-not-found"])
    assert str(tmp_path / "base_lnik.stl") in finding.message
    assert "did you mean 'base_link.stl'?" in finding.message


def test_what_xacro_makes_of_find_is_no_absolute_path(tmp_path):
    (tmp_path / "package.xml").write_text("<package><name>arm</name></package>")
    (tmp_path / "a.stl").write_bytes(STL)
    found = _found(
        tmp_path,
        "file://$(find arm)/a.stl",
        name="robot.urdf.xacro",
        head='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">',
    )
    assert found == []


def test_absolute_path_that_is_not_there_is_one_finding(tmp_path):
    assert _found(tmp_path, "/home/ada/a.stl") == [("absolute-path", 2)]


def test_a_mended_file_is_looked_at_again(tmp_path):
    mesh = tmp_path / "a.stl"
    mesh.write_bytes(STL[:-20])
    assert _found(tmp_path, "a.stl") == [("corrupt-mesh", 2)]
    mesh.write_bytes(STL)
    assert _found(tmp_path, "a.stl") == []


def test_expression_in_a_uri_is_not_looked_for(tmp_path):
    assert _found(tmp_path, "package://${name}/a.stl", "$(find arm)/a.stl") == []


def test_the_size_of_a_mesh_in_millimeters_is_measured_whole(tmp_path):
    """Two small parts of many triangles, far from a single one that no sample has."""
    near = [struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 40, 0, 0, 0, 40, 0, 0)] * 5000
    far = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 544, 0, 0, 0, 40, 0, 0)
    triangles = [*near[:1000], far, *near]
    data = b"arm".ljust(80) + struct.pack("<I", len(triangles)) + b"".join(triangles)
    (tmp_path / "arm.stl").write_bytes(data)
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r">{LINK.format(0, "arm.stl")}</robot>')
    (finding,) = check(file, select=["mesh-in-millimeters"])
    assert "is 544 m long" in finding.message


@pytest.mark.parametrize(
    ("name", "data", "defect"),
    [
        ("a.glb", b"garbage", "is not a GLB file"),
        ("a.glb", b"glTF\2\0\0\0\xff\0\0\0", "announces 255 bytes, but the file has 12"),
        ("a.gltf", b"garbage", "is not a glTF file"),
        ("a.ply", b"garbage", "is not a PLY file"),
        ("b.gltf", b'\xef\xbb\xbf {"asset": {"version": "2.0"}}', ""),
        ("b.ply", b"ply\nformat ascii 1.0\n", ""),
    ],
)
def test_the_first_bytes_are_those_of_the_format(tmp_path, name, data, defect):
    (tmp_path / name).write_bytes(data)
    shape = f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="a">{shape}</link></robot>')
    found = check(tmp_path / "r.urdf", select=["corrupt-mesh"])
    assert [defect in finding.message for finding in found] == [True] * bool(defect)
