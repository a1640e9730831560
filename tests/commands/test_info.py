import json

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT

ROBOTS = FIXTURES / "robots"
MIRA = ROBOTS / "mira_description" / "urdf" / "mira.urdf"
SCHEMA = json.loads((ROOT / "docs" / "schemas" / "info.json").read_text())


def facts(urdftool, *words):
    result = urdftool("info", *words, "--format", "json")
    assert result.code == 0
    found = json.loads(result.out)
    jsonschema.validate(found, SCHEMA)
    return found


def test_one_table(urdftool, monkeypatch):
    monkeypatch.chdir(ROBOTS)
    result = urdftool("info", "laser_bot/urdf/laser_bot.urdf.xacro")
    assert (result.code, result.err) == (0, "")
    assert result.out == (
        "robot               laser_bot\n"
        "links               5: 4 with mass or shape, 1 mere frame\n"
        "joints              4: 2 fixed, 2 continuous\n"
        "degrees of freedom  2\n"
        "tree                from base_footprint, 2 joints deep\n"
        "mass                6.4 kg\n"
        "size at zero pose   0.6 × 0.44 × 0.23 m along the root's x, y, z; "
        "lowest point at z = 0 m\n"
        "meshes              none\n"
        "packages            laser_bot  laser_bot\n"
        "plugins             diff_drive (libgazebo_ros_diff_drive.so)\n"
        "                    laser_controller (libgazebo_ros_laser.so) on sensor_laser\n"
        "sensors             laser (ray) on sensor_laser\n"
    )


def test_meshes_are_read(urdftool):
    found = facts(urdftool, MIRA)
    assert found["triangles"]["visuals"] == sum(
        mesh["triangles"] * mesh["visuals"] for mesh in found["meshes"]
    )
    assert all(mesh["triangles"] for mesh in found["meshes"])
    assert list(found["packages"]) == ["mira_description"]


def test_a_mesh_is_where_its_link_and_origin_put_it(urdftool, write, tmp_path):
    cube = tmp_path / "cube.stl"
    cube.write_bytes((FIXTURES / "meshes" / "cube.stl").read_bytes())
    path = write(
        "r.urdf",
        '<robot name="r"><link name="a"/><link name="b"><visual><origin xyz="1 0 0"/><geometry>'
        f'<mesh filename="file://{cube}" scale="2 1 1"/></geometry></visual></link>'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<origin xyz="0 0 10" rpy="0 0 1.5707963267948966"/></joint></robot>',
    )
    plain = facts(
        urdftool,
        write(
            "p.urdf",
            '<robot name="p"><link name="b"><visual><geometry>'
            f'<mesh filename="file://{cube}"/></geometry></visual></link></robot>',
        ),
    )["bounds"]
    (x0, y0, z0), (x1, y1, z1) = plain["low"], plain["high"]
    found = facts(urdftool, path)["bounds"]
    assert found["low"] == pytest.approx([-y1, 2 * x0 + 1, z0 + 10])
    assert found["high"] == pytest.approx([-y0, 2 * x1 + 1, z1 + 10])


def test_a_mesh_that_is_not_there_is_named_with_the_reason(urdftool, write):
    path = write(
        "r.urdf",
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="package://no/x.stl"/>'
        '</geometry></visual><collision><geometry><mesh filename="gone.stl"/></geometry>'
        "</collision></link></robot>",
    )
    result = urdftool("info", path)
    assert result.code == 0
    assert "not read: package://no/x.stl: package 'no' is not found" in result.out
    assert "not read: gone.stl: there is no such mesh file" in result.out
    assert "no         not found" not in result.out
    assert facts(urdftool, path)["packages"] == {"no": None}


@pytest.mark.parametrize(
    ("kind", "freedom"),
    [("revolute", 1), ("continuous", 1), ("prismatic", 1), ("planar", 3), ("floating", 6)],
)
def test_degrees_of_freedom(urdftool, write, kind, freedom):
    joint = '<joint name="{}" type="{}"><parent link="a"/><child link="{}"/>{}</joint>'
    path = write(
        "r.urdf",
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>'
        + joint.format("j", kind, "b", "")
        + joint.format("k", "fixed", "c", "")
        + joint.format("m", "revolute", "d", '<mimic joint="j"/>')
        + "</robot>",
    )
    found = facts(urdftool, path)
    assert (found["freedom"], found["mimics"]) == (freedom, 1)


@pytest.mark.parametrize(
    "inside",
    [
        "",
        '<link name="a"/><link name="b"/>',
        '<link name="a"/><joint name="j" type="fixed"><parent link="a"/><child link="a"/></joint>',
        "<link/><joint/>",
    ],
)
def test_broken_robots_are_told_of_too(urdftool, write, inside):
    path = write("r.urdf", f"<robot>{inside}</robot>")
    assert urdftool("info", path).code == 0
    facts(urdftool, path)


def test_a_file_of_macros_is_said_to_be_one(urdftool, write):
    path = write(
        "m.xacro",
        '<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:macro name="m"/></robot>',
    )
    done = urdftool("info", path)
    assert done.code == 0
    assert done.err.startswith(f"{path}:1:1: ")
    assert "has no link" in done.err
    assert urdftool("-q", "info", path).err == ""


def test_to_a_file_and_not_over_the_input(urdftool, write, tmp_path):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    assert urdftool("info", path, "-o", "info.txt").code == 0
    assert (tmp_path / "info.txt").read_text().startswith("robot ")
    assert urdftool("info", path, "-o", path).code == 2


def test_many_sensors_of_a_type_are_one_line(urdftool, write):
    joints = [f"j{n}" for n in range(9)]
    links = "".join(
        f'<gazebo reference="a"><sensor name="{name}" type="contact"/></gazebo>' for name in joints
    )
    path = write(
        "r.urdf",
        f'<robot name="r"><link name="a"/>{links}'
        '<gazebo reference="a"><sensor name="one" type="imu"/></gazebo></robot>',
    )
    text = urdftool("info", path).out
    assert "9 contact on a" in text
    assert "one (imu) on a" in text
    assert "j3 (contact)" not in text
